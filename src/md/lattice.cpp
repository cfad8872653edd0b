#include "md/lattice.hpp"

#include <algorithm>

namespace sandlane::md {

namespace {

constexpr std::int32_t row_margin =
    8; // halo columns left of the domain, at least the reach; keeps rows aligned

} // namespace

Lattice::Lattice(const scene::Scene& scene, const Plan& plan, double radius_max)
    : columns_(plan.columns), rows_(plan.rows), reach_(plan.reach), lower_x_(plan.lower.x),
      lower_y_(plan.lower.y), site_x_(plan.site_x), site_y_(plan.site_y),
      period_x_(scene.domain.periodic[0] ? plan.upper.x - plan.lower.x : 0.0),
      period_y_(scene.domain.periodic[1] ? plan.upper.y - plan.lower.y : 0.0),
      uniform_square_(
          static_cast<float>(4 * radius_max * radius_max * simd::lattice_margin * simd::lattice_margin)),
      many_radii_(plan.many_radii) {
    constexpr auto group = static_cast<std::int32_t>(simd::site_group);
    row_stride_ = (columns_ + group - 1) / group * group + 2 * row_margin;
    origin_ = reach_ * row_stride_ + row_margin;
    // A function of the scene alone. Higher tiles repeat fewer rows of the half mask at their edges, lower
    // ones balance better.
    tile_rows_ = std::clamp(rows_ / 16, 8, 32);
    const auto sites = static_cast<std::size_t>((rows_ + 2 * reach_) * row_stride_) + 2 * simd::site_group;
    x_.resize(sites, simd::empty_site);
    y_.resize(sites, 0.0F);
    owner_.resize(sites, -1);
    if (many_radii_) radius_.resize(sites, 0.0F);
    for (int a = -reach_; a <= reach_; ++a)
        for (int b = -reach_; b <= reach_; ++b) {
            if (a == 0 && b == 0) continue;
            offsets_.push_back(static_cast<std::int32_t>(a * row_stride_ + b));
            offset_x_.push_back(static_cast<float>(b * site_x_));
            offset_y_.push_back(static_cast<float>(a * site_y_));
        }
}

std::size_t Lattice::bytes() const {
    return x_.bytes() + y_.bytes() + radius_.bytes() + owner_.bytes() + site_.bytes() + next_site_.bytes() +
           relative_x_.bytes() + relative_y_.bytes() + edge_.bytes();
}

simd::LatticeView Lattice::view() const {
    return {x_.data(),        y_.data(),        radius_.data(), owner_.data(), row_stride_,
            origin_,          columns_,         rows_,          reach_,        offsets_.data(),
            offset_x_.data(), offset_y_.data(), uniform_square_};
}

void Lattice::clear(const State& state) {
    x_.fill(simd::empty_site);
    owner_.fill(-1);
    for (Column<std::int32_t>* column : {&site_, &next_site_}) column->resize(state.size());
    for (Column<float>* column : {&relative_x_, &relative_y_}) column->resize(state.size());
    edge_.resize(state.size());
    site_.fill(-1);
}

// Calls body(site) for the periodic images of a site in the halo.
template <class Body> void Lattice::for_images(std::int32_t site, const Body& body) const {
    const std::ptrdiff_t local = site - origin_ + row_margin;
    const std::ptrdiff_t row = local / row_stride_, column = local % row_stride_ - row_margin;
    const int left = period_x_ > 0 && column < reach_ ? 1 : 0,
              right = period_x_ > 0 && column >= columns_ - reach_ ? -1 : 0;
    const int down = period_y_ > 0 && row < reach_ ? 1 : 0,
              up = period_y_ > 0 && row >= rows_ - reach_ ? -1 : 0;
    // A direction with few sites can have images on both sides.
    for (const int b : {0, left, right})
        for (const int a : {0, down, up}) {
            if (a == 0 && b == 0) continue;
            body(static_cast<std::size_t>(site + a * row_stride_ * rows_ + b * columns_));
        }
}

void Lattice::leave(const State& state, simd::BinKernel kernel, std::size_t begin, std::size_t end) {
    simd::BinView bin{};
    bin.records = state.record.data();
    bin.site = next_site_.data();
    bin.lower[0] = lower_x_;
    bin.lower[1] = lower_y_;
    bin.edge[0] = site_x_;
    bin.edge[1] = site_y_;
    bin.count[0] = columns_;
    bin.count[1] = rows_;
    bin.stride[0] = 1;
    bin.stride[1] = row_stride_;
    bin.origin = origin_;
    bin.relative_x = relative_x_.data();
    bin.relative_y = relative_y_.data();
    bin.edge_site = edge_.data();
    bin.reach = reach_;
    kernel(bin, static_cast<std::int64_t>(begin), static_cast<std::int64_t>(end));
    const bool periodic = period_x_ > 0 || period_y_ > 0;
    const auto empty = [&](std::size_t site) {
        x_[site] = simd::empty_site;
        owner_[site] = -1;
    };
    for (std::size_t i = begin; i < end; ++i) {
        const std::int32_t old = site_[i];
        if (old == next_site_[i] || old < 0) continue;
        empty(static_cast<std::size_t>(old));
        if (periodic) for_images(old, empty);
    }
}

void Lattice::enter(const State& state, std::size_t begin, std::size_t end) {
    const bool periodic = period_x_ > 0 || period_y_ > 0;
    for (std::size_t i = begin; i < end; ++i) {
        const bool moved = site_[i] != next_site_[i];
        const auto put = [&](std::size_t site) {
            x_[site] = relative_x_[i];
            y_[site] = relative_y_[i];
            if (!moved) return;
            owner_[site] = static_cast<std::int32_t>(i);
            if (many_radii_) radius_[site] = static_cast<float>(state.radius(i) * simd::lattice_margin);
        };
        put(static_cast<std::size_t>(next_site_[i]));
        if (periodic && edge_[i] != 0) for_images(next_site_[i], put);
        site_[i] = next_site_[i];
    }
}

Lattice::Clash Lattice::find_clash(const State& state) const {
    std::vector<std::pair<std::int32_t, std::int64_t>> seats(state.size());
    for (std::size_t i = 0; i < seats.size(); ++i) seats[i] = {site_[i], static_cast<std::int64_t>(i)};
    std::sort(seats.begin(), seats.end());
    for (std::size_t n = 1; n < seats.size(); ++n)
        if (seats[n].first == seats[n - 1].first) return {seats[n - 1].second, seats[n].second};
    return {};
}

} // namespace sandlane::md
