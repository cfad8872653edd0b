// The sandpile of Bak, Tang and Wiesenfeld (docs/automata.md 1): sweeps over a lattice in tiles, and
// avalanches of single grains.
#pragma once

#include "automata/log_bins.hpp"
#include "automata/model.hpp"
#include "core/column.hpp"
#include "core/rng.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace sandlane::automata {

// Heights of one or two bytes between borders of zeros, and the same once more for the next sweep.
class PileLattice {
public:
    PileLattice(std::int32_t columns, std::int32_t rows, int bytes);

    [[nodiscard]] std::uint32_t get(std::int32_t x, std::int32_t y) const {
        const std::uint8_t* p = at(heights.data(), x, y);
        return bytes == 1 ? *p : static_cast<std::uint32_t>(p[0] | p[1] << 8);
    }
    void set(std::int32_t x, std::int32_t y, std::uint32_t height) {
        put(heights, x, y, height);
        put(other, x, y, height);
    }
    [[nodiscard]] std::uint64_t grains() const;

    std::int32_t columns, rows, bytes, strips;
    std::ptrdiff_t stride; // bytes
    Column<std::uint8_t> heights, other;

    [[nodiscard]] std::ptrdiff_t origin() const { return stride + simd::strip_bytes; } // of site (0, 0)

private:
    [[nodiscard]] const std::uint8_t* at(const std::uint8_t* data, std::int32_t x, std::int32_t y) const {
        return data + origin() + y * stride + std::ptrdiff_t{x} * bytes;
    }
    void put(Column<std::uint8_t>& to, std::int32_t x, std::int32_t y, std::uint32_t height) const;
};

// What one sweep, or a relaxation, did.
struct Sweeps {
    std::uint64_t topplings = 0;
    std::int64_t sweeps = 0; // in which a site toppled
};

// Sweeps of a lattice by kernels. A tile, 64 bytes of 8 rows, is visited if it or one around it changed in
// the last sweep: elsewhere both buffers hold the same stable heights.
class PileSweeper {
public:
    PileSweeper(const PileLattice& lattice, const Means& means, bool active_tiles);

    // Returns the topplings. odometer: those of each site are added to it, laid out as heights of two bytes.
    std::uint64_t sweep(PileLattice& lattice, bool unit, Column<std::uint8_t>* odometer = nullptr);
    // Two sweeps in one pass over the memory, their topplings: where every tile is visited anyway.
    std::array<std::uint64_t, 2> sweep_pair(PileLattice& lattice, bool unit,
                                            Column<std::uint8_t>* odometer = nullptr);
    // Whether it pays: the lattice does not fit a cache, and few tiles were quiet in the last sweep.
    [[nodiscard]] bool pairs_pay() const { return large_ && visited_ > 0.8; }
    void visit_all() { changed_.fill(1); }                    // after heights were set
    [[nodiscard]] double visited() const { return visited_; } // share of the tiles in the last sweep

private:
    struct Pair;
    void sweep_block(const Pair& pair, std::size_t block);
    // What a band notes in a sweep, empty; and its topplings.
    void begin_band(std::size_t band, Column<std::uint64_t>& topplings);
    [[nodiscard]] std::uint64_t sum_of_band(std::size_t band, const Column<std::uint64_t>& topplings) const;
    [[nodiscard]] double active_share() const;
    std::uint64_t sweep_tiles(PileLattice& lattice, bool unit, Column<std::uint8_t>* odometer);

    Means means_;
    bool active_tiles_, large_;
    std::size_t strips_, bands_;
    Column<std::uint64_t> inner_;              // mask of the last strip
    Column<std::uint8_t> changed_, next_;      // [bands][strips], between borders of zeros
    Column<std::uint64_t> topplings_;          // [bands][strips]
    Column<std::uint64_t> first_topplings_;    // of a pair
    Column<std::uint8_t> between_;             // [threads]: rows of a block between the two sweeps
    std::vector<std::uint64_t> sums_, visits_; // by band: topplings, tiles visited
    double visited_ = 1;
};

struct Avalanche {
    std::int64_t size = 0, area = 0, duration = 0, radius = 0; // spec 1.1.3
};

// Drops a grain on a site and relaxes by unit sweeps. The pile must be stable; heights are bytes.
class AvalancheRunner {
public:
    Avalanche drop(PileLattice& lattice, std::int32_t x, std::int32_t y);

private:
    std::vector<std::ptrdiff_t> unstable_, next_;
    Column<std::uint32_t> toppled_; // number of the last avalanche that a site took part in
    std::uint32_t number_ = 0;
};

// Whole numbers on a lattice, zero outside.
struct Potential {
    std::int32_t columns = 0, rows = 0;
    std::vector<std::int32_t> w; // row by row

    [[nodiscard]] std::int32_t at(std::int32_t x, std::int32_t y) const {
        const bool inside = x >= 0 && x < columns && y >= 0 && y < rows;
        return inside ? w[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                          static_cast<std::size_t>(x)]
                      : 0;
    }
};

class IdentitySearch; // identity.hpp

class SandpileModel final : public Model {
public:
    SandpileModel(const scene::Scene& scene, const Means& means);
    ~SandpileModel() override;

    void run(std::int64_t steps) override;
    [[nodiscard]] std::int64_t step() const override { return step_; }
    [[nodiscard]] bool finished() const override { return stable_ && pile_.drive == scene::PileDrive::none; }
    [[nodiscard]] std::size_t sites() const override {
        return static_cast<std::size_t>(lattice_.columns) * static_cast<std::size_t>(lattice_.rows);
    }
    [[nodiscard]] std::string serialise() const override;
    void restore(const std::string& state) override;
    [[nodiscard]] std::vector<Quantity> quantities() const override;
    [[nodiscard]] std::vector<analysis::LogColumn> log_columns() const override;
    [[nodiscard]] std::vector<double> log_row() const override;
    [[nodiscard]] std::vector<Field> fields() const override;
    [[nodiscard]] std::vector<Table> final_tables() const override;
    [[nodiscard]] Facts facts() const override;

    [[nodiscard]] const PileLattice& lattice() const { return lattice_; }
    [[nodiscard]] std::uint64_t topplings() const { return topplings_; }

private:
    void sweep(std::int64_t most);
    bool count_sweep(std::uint64_t topplings);
    [[nodiscard]] std::vector<std::pair<std::int32_t, std::int32_t>> levels() const;
    void search(std::int64_t most);
    void restore_search(ByteReader& bytes);
    void drop_grain();
    void relax();

    scene::Sandpile pile_;
    Means means_;
    PhiloxKey seed_;
    PileLattice lattice_;
    PileSweeper sweeper_;
    AvalancheRunner runner_;
    std::int64_t step_ = 0;
    std::uint64_t topplings_ = 0;
    bool stable_ = false;
    // Start "identity-doubled": levels done, the last identity, and the search for the next one.
    std::size_t level_ = 0;
    Potential potential_;
    std::unique_ptr<IdentitySearch> search_;
    int phase_ = 0;                   // identity: 1 when 6 - (6)^ relaxes
    std::vector<LogBins> statistics_; // of size, area, duration, radius
};

} // namespace sandlane::automata
