#include "automata/identity.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <cmath>

namespace sandlane::automata {

namespace {

constexpr std::int64_t most_burned = 256; // times beta in one round: heights stay below 2^10
constexpr int sweeps_between = 64;        // collections of topplings, at most 2^8 a sweep, in 16 bits

// Sites with a negative number take a grain from each neighbour until there are none.
void topple_backwards(Potential& p, std::vector<std::int32_t>& c) {
    const auto columns = static_cast<std::size_t>(p.columns);
    std::vector<std::size_t> negative;
    for (std::size_t n = 0; n < c.size(); ++n)
        if (c[n] < 0) negative.push_back(n);
    const auto take = [&](std::size_t n) {
        if (--c[n] == -1) negative.push_back(n);
    };
    while (!negative.empty()) {
        const std::size_t n = negative.back();
        negative.pop_back();
        while (c[n] < 0) {
            ++p.w[n];
            c[n] += 4;
            if (n % columns > 0) take(n - 1);
            if (n % columns + 1 < columns) take(n + 1);
            if (n >= columns) take(n - columns);
            if (n + columns < c.size()) take(n + columns);
        }
    }
}

// Weights of four neighbouring values at a place between the middle two (Catmull and Rom).
void cubic_weights(double t, double* weight) {
    weight[0] = 0.5 * (-t + 2 * t * t - t * t * t);
    weight[1] = 0.5 * (2 - 5 * t * t + 3 * t * t * t);
    weight[2] = 0.5 * (t + 4 * t * t - 3 * t * t * t);
    weight[3] = 0.5 * (-t * t + t * t * t);
}

struct Place {
    std::int32_t first;
    double weight[4];
};
// Site n of `fine` among the sites of `coarse`; sides lie one site outside.
Place place_in(std::int32_t n, std::int32_t fine, std::int32_t coarse) {
    const double at = (n + 1.0) * (coarse + 1.0) / (fine + 1.0) - 1;
    const double floor = std::floor(at);
    Place p{static_cast<std::int32_t>(floor) - 1, {}};
    cubic_weights(at - floor, p.weight);
    return p;
}

// Beyond the sides w goes on with the other sign, so that it vanishes there.
double continued(const Potential& p, std::int32_t x, std::int32_t y) {
    double sign = 1;
    if (x < -1 || x > p.columns) {
        x = x < -1 ? -2 - x : 2 * p.columns - x;
        sign = -sign;
    }
    if (y < -1 || y > p.rows) {
        y = y < -1 ? -2 - y : 2 * p.rows - y;
        sign = -sign;
    }
    return sign * p.at(x, y);
}

} // namespace

std::vector<std::int32_t> toppling_matrix(const Potential& p) {
    std::vector<std::int32_t> c;
    c.reserve(p.w.size());
    for (std::int32_t y = 0; y < p.rows; ++y)
        for (std::int32_t x = 0; x < p.columns; ++x)
            c.push_back(static_cast<std::int32_t>(std::int64_t{4} * p.at(x, y) - p.at(x - 1, y) -
                                                  p.at(x + 1, y) - p.at(x, y - 1) - p.at(x, y + 1)));
    return c;
}

Potential stretched(const Potential& coarse, std::int32_t columns, std::int32_t rows, int threads) {
    Potential fine{
        columns, rows,
        std::vector<std::int32_t>(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0)};
    if (coarse.w.empty()) return fine;
    const double stretch = (columns + 1.0) / (coarse.columns + 1.0) * ((rows + 1.0) / (coarse.rows + 1.0));
    std::vector<Place> across;
    across.reserve(static_cast<std::size_t>(columns));
    for (std::int32_t x = 0; x < columns; ++x) across.push_back(place_in(x, columns, coarse.columns));
    for_tiles(static_cast<std::size_t>(rows), threads, [&](std::size_t row) {
        const Place up = place_in(static_cast<std::int32_t>(row), rows, coarse.rows);
        std::vector<double> line(static_cast<std::size_t>(coarse.columns) + 6,
                                 0); // of the coarse lattice, from -3
        for (std::int32_t x = -3; x < coarse.columns + 3; ++x)
            for (int k = 0; k < 4; ++k)
                line[static_cast<std::size_t>(x + 3)] += up.weight[k] * continued(coarse, x, up.first + k);
        for (std::int32_t x = 0; x < columns; ++x) {
            const Place& p = across[static_cast<std::size_t>(x)];
            double sum = 0;
            for (int k = 0; k < 4; ++k) sum += p.weight[k] * line[static_cast<std::size_t>(p.first + k + 3)];
            fine.w[row * static_cast<std::size_t>(columns) + static_cast<std::size_t>(x)] =
                static_cast<std::int32_t>(std::lround(stretch * sum));
        }
    });
    return fine;
}

IdentitySearch::IdentitySearch(Potential guess, const Means& means, bool active_tiles)
    : guess_(std::move(guess)), lattice_(guess_.columns, guess_.rows, 2),
      sweeper_(lattice_, means, active_tiles) {
    std::vector<std::int32_t> c = toppling_matrix(guess_);
    topple_backwards(guess_, c);
    std::size_t n = 0;
    for (std::int32_t y = 0; y < lattice_.rows; ++y)
        for (std::int32_t x = 0; x < lattice_.columns; ++x)
            lattice_.set(x, y, static_cast<std::uint32_t>(c[n++]));
    odometer_.resize(lattice_.heights.size(), 0);
}

IdentitySearch::Progress IdentitySearch::sweep(std::int64_t most) {
    if (finished_) return {};
    std::array<std::uint64_t, 2> topplings{};
    const bool pair = most > 1 && sweeper_.pairs_pay();
    if (pair)
        topplings = sweeper_.sweep_pair(lattice_, false, &odometer_);
    else
        topplings[0] = sweeper_.sweep(lattice_, false, &odometer_);
    uncollected_ += pair ? 2 : 1;
    if (uncollected_ >= sweeps_between) collect_odometer();
    if (topplings[0] == 0 || (pair && topplings[1] == 0)) go_on();
    return {(topplings[0] > 0 ? 1 : 0) + (topplings[1] > 0 ? 1 : 0), topplings[0] + topplings[1]};
}

// From a stable state.
void IdentitySearch::go_on() {
    finished_ = burning_ && std::equal(before_.begin(), before_.end(), lattice_.heights.begin());
    if (!finished_) burn();
}

// What has to be added is not known: twice as often every second round, and once between, to see whether that
// changes anything.
void IdentitySearch::burn() {
    if (burning_) rounds_ = rounds_ + 1;
    const bool trial = rounds_ % 2 == 0;
    if (!trial) round_ = std::min(2 * round_, most_burned);
    burning_ = true;
    before_ = lattice_.heights;
    const std::int64_t times = trial ? 1 : round_;
    const auto often = static_cast<std::uint32_t>(times);
    const auto add = [&](std::int32_t x, std::int32_t y) { lattice_.set(x, y, lattice_.get(x, y) + often); };
    for (std::int32_t x = 0; x < lattice_.columns; ++x) {
        add(x, 0);
        add(x, lattice_.rows - 1);
    }
    for (std::int32_t y = 0; y < lattice_.rows; ++y) {
        add(0, y);
        add(lattice_.columns - 1, y);
    }
    burned_ += times;
    sweeper_.visit_all();
}

void IdentitySearch::collect_odometer() {
    uncollected_ = 0;
    for (std::int32_t y = 0; y < lattice_.rows; ++y) {
        std::uint8_t* row = odometer_.data() + lattice_.origin() + y * lattice_.stride;
        std::int32_t* w = guess_.w.data() + std::ptrdiff_t{y} * lattice_.columns;
        for (std::int32_t x = 0; x < lattice_.columns; ++x) w[x] -= row[2 * x] | row[2 * x + 1] << 8;
        std::fill_n(row, 2 * static_cast<std::size_t>(lattice_.columns), std::uint8_t{0});
    }
}

Potential IdentitySearch::potential() const {
    Potential p = guess_;
    for (std::int32_t y = 0; y < lattice_.rows; ++y) {
        const std::uint8_t* row = odometer_.data() + lattice_.origin() + y * lattice_.stride;
        std::int32_t* w = p.w.data() + std::ptrdiff_t{y} * lattice_.columns;
        for (std::int32_t x = 0; x < lattice_.columns; ++x)
            w[x] += static_cast<std::int32_t>(burned_) - (row[2 * x] | row[2 * x + 1] << 8);
    }
    return p;
}

void IdentitySearch::save(ByteWriter& bytes) const {
    bytes.put(round_);
    bytes.put(rounds_);
    bytes.put(static_cast<std::uint8_t>(burning_));
    for (std::int32_t y = 0; burning_ && y < lattice_.rows; ++y)
        bytes.put_array(before_.data() + lattice_.origin() + y * lattice_.stride,
                        2 * static_cast<std::size_t>(lattice_.columns));
}

void IdentitySearch::load(ByteReader& bytes) {
    round_ = bytes.get<std::int64_t>();
    rounds_ = bytes.get<std::int64_t>();
    burning_ = bytes.get<std::uint8_t>() != 0;
    if (!burning_) return;
    if (round_ < 1 || round_ > most_burned || rounds_ < 0)
        fail(Exit::io, "the state is one of another search");
    before_ = lattice_.heights;
    before_.fill(0);
    std::vector<std::uint8_t> row;
    for (std::int32_t y = 0; y < lattice_.rows; ++y) {
        bytes.get_array(row);
        if (row.size() != 2 * static_cast<std::size_t>(lattice_.columns))
            fail(Exit::io, "the state is one of another lattice");
        std::copy(row.begin(), row.end(), before_.data() + lattice_.origin() + y * lattice_.stride);
    }
}

} // namespace sandlane::automata
