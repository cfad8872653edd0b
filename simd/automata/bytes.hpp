// Collisions of FHP-III by a table, a site to a byte, where a processor looks up 64 bytes among 128 in one
// instruction (AVX-512 VBMI) and transposes matrices of 8 x 8 bits in another (GFNI). The lattice stays bit
// planes; bytes live in registers only.
#pragma once

#include "simd/automata/collisions.hpp"
#include "simd/automata/tables.hpp"
#include "simd/automata/words.hpp"

namespace sandlane::simd {

// The words of a row that collide, and where to.
struct RowPlanes {
    std::uint64_t *from[gas_planes], *to[gas_planes];
    std::ptrdiff_t next_row; // from `from`: what is read ahead
};

template <class Arch> struct ByteCollisions {
    static constexpr bool exist = false; // for this instruction set
    static bool supported() { return false; }
};

#if defined(__AVX512BW__)

// Other instruction sets than that of the file: one function, never inlined into code for processors without.
#define SANDLANE_BYTES __attribute__((target("avx512vbmi,gfni")))

template <> struct ByteCollisions<xsimd::avx512bw> {
    using Arch = xsimd::avx512bw;
    static constexpr bool exist = true;

    static bool supported() {
        return __builtin_cpu_supports("avx512vbmi") != 0 && __builtin_cpu_supports("gfni") != 0;
    }

    // Words [range.first, range.last), a multiple of eight.
    SANDLANE_BYTES __attribute__((noinline)) static void collide(const WordSource& source, WordRange range,
                                                                 const RowPlanes& row) {
        static constexpr StateTable table = fhp3_table();
        const __m512i previous[2] = {_mm512_load_si512(table.to[0]), _mm512_load_si512(table.to[0] + 64)},
                      next[2] = {_mm512_load_si512(table.to[1]), _mm512_load_si512(table.to[1] + 64)};
        // Times the transpose of a matrix of bits, as GFNI counts its rows: in order, and backwards.
        const __m512i straight = _mm512_set1_epi64(static_cast<long long>(0x8040201008040201ULL)),
                      mirrored = _mm512_set1_epi64(0x0102040810204080LL);
        const auto chirality = [&](std::int32_t w) {
            return random_words<Arch>(lane_numbers<Arch>() + WordBatch<Arch>(static_cast<std::uint64_t>(w)),
                                      source, gas_stream::chirality * 64 + probability_bits - 1);
        };
        // One round ahead: random numbers and table are long chains of instructions that can overlap.
        WordBatch<Arch> xi = chirality(range.first);
        for (std::int32_t w = range.first; w < range.last; w += segment_words) {
            // A byte of each of eight planes; the last one is the chirality, and planes stand backwards.
            __m512i a[8], b[8];
            a[0] = xi;
            xi = chirality(w + segment_words);
            for (int i = 0; i < gas_planes; ++i) {
                a[7 - i] = _mm512_loadu_si512(row.from[i] + w);
                __builtin_prefetch(row.from[i] + w + row.next_row, 1);
            }
            interleave<4>(a, b);
            interleave<2>(b, a);
            interleave<1>(a, b);
            for (__m512i& bytes : b) {
                const __m512i states = _mm512_gf2p8affine_epi64_epi8(mirrored, bytes, 0);
                const __mmask64 forward = _mm512_movepi8_mask(states);
                const __m512i to =
                    _mm512_mask_mov_epi8(_mm512_permutex2var_epi8(previous[0], states, previous[1]), forward,
                                         _mm512_permutex2var_epi8(next[0], states, next[1]));
                bytes = _mm512_gf2p8affine_epi64_epi8(straight, to, 0);
            }
            interleave<4>(b, a);
            interleave<2>(a, b);
            interleave<1>(b, a);
            for (int k = 0; k < 4; ++k) {
                _mm512_storeu_si512(row.to[2 * k] + w, _mm512_unpacklo_epi8(a[k], a[k + 4]));
                if (k < 3) _mm512_storeu_si512(row.to[2 * k + 1] + w, _mm512_unpackhi_epi8(a[k], a[k + 4]));
            }
        }
    }

private:
    // Bytes of registers whose numbers differ in the bit `apart`, in turn. The number of a byte within 16
    // moves up by one bit; the highest one becomes that bit of the register's number, and takes its place
    // below. Three times that gather the bytes of eight planes, four bring them back.
    template <int apart>
    SANDLANE_BYTES static SANDLANE_INLINE void interleave(const __m512i* from, __m512i* to) {
        for (int k = 0; k < 4; ++k) {
            const int low = k / apart * 2 * apart + k % apart;
            to[low] = _mm512_unpacklo_epi8(from[low], from[low + apart]);
            to[low + apart] = _mm512_unpackhi_epi8(from[low], from[low + apart]);
        }
    }
};

#undef SANDLANE_BYTES

#endif

} // namespace sandlane::simd
