#include "analysis/stress.hpp"

#include <array>
#include <numbers>
#include <span>
#include <string>

namespace sandlane::analysis {

namespace {

void add_product(Tensor& t, double factor, Vec a, Vec b) {
    t.xx += factor * a.x * b.x;
    t.xy += factor * a.x * b.y;
    t.xz += factor * a.x * b.z;
    t.yx += factor * a.y * b.x;
    t.yy += factor * a.y * b.y;
    t.yz += factor * a.y * b.z;
    t.zx += factor * a.z * b.x;
    t.zy += factor * a.z * b.y;
    t.zz += factor * a.z * b.z;
}

Tensor zero(int dimension) {
    Tensor t;
    t.dimension = dimension;
    return t;
}

struct Component {
    const char* name;
    double Tensor::*value;
};
constexpr std::array<Component, 4> plane{
    {{"xx", &Tensor::xx}, {"xy", &Tensor::xy}, {"yx", &Tensor::yx}, {"yy", &Tensor::yy}}};
constexpr std::array<Component, 3> plane_symmetric{
    {{"xx", &Tensor::xx}, {"xy", &Tensor::xy}, {"yy", &Tensor::yy}}};
constexpr std::array<Component, 9> space{{{"xx", &Tensor::xx},
                                          {"xy", &Tensor::xy},
                                          {"xz", &Tensor::xz},
                                          {"yx", &Tensor::yx},
                                          {"yy", &Tensor::yy},
                                          {"yz", &Tensor::yz},
                                          {"zx", &Tensor::zx},
                                          {"zy", &Tensor::zy},
                                          {"zz", &Tensor::zz}}};
constexpr std::array<Component, 6> space_symmetric{{{"xx", &Tensor::xx},
                                                    {"xy", &Tensor::xy},
                                                    {"xz", &Tensor::xz},
                                                    {"yy", &Tensor::yy},
                                                    {"yz", &Tensor::yz},
                                                    {"zz", &Tensor::zz}}};

class Stress : public Series {
public:
    explicit Stress(Region region) : region_(region) {}

    [[nodiscard]] std::vector<LogColumn> columns() const override {
        const std::string unit = pressure_unit(region_.dimension);
        std::vector<LogColumn> columns{{"time", "s"}};
        for (const Component& c : all()) columns.push_back({std::string("stress_") + c.name, unit});
        columns.push_back({"pressure", unit});
        for (const Component& c : symmetric()) columns.push_back({std::string("kinetic_") + c.name, unit});
        columns.insert(columns.end(), {{"contact_number", "1"}, {"packing_fraction", "1"}});
        return columns;
    }
    void add(const Frame& frame) override {
        const Tensor contact = contact_stress(frame, region_),
                     kinetic = kinetic_stress(frame.grains, region_);
        std::vector<double> row{frame.grains.time};
        for (const Component& c : all()) row.push_back(contact.*c.value);
        row.push_back(contact.pressure());
        for (const Component& c : symmetric()) row.push_back(kinetic.*c.value);
        row.insert(row.end(), {contact_number(frame, region_), packing_fraction(frame.grains, region_)});
        rows_ = {row};
    }

private:
    using Components = std::span<const Component>;
    [[nodiscard]] Components all() const {
        return region_.dimension == 3 ? Components(space) : Components(plane);
    }
    [[nodiscard]] Components symmetric() const {
        return region_.dimension == 3 ? Components(space_symmetric) : Components(plane_symmetric);
    }

    Region region_;
};

} // namespace

std::vector<Tensor> grain_stress(const Frame& frame) {
    const Snapshot& s = frame.grains;
    std::vector<Tensor> stress(s.size(), zero(s.dimension));
    // Both partners have the same sign: lever arm and force turn round together.
    const auto add = [&](std::int32_t grain, const Contact& c) {
        const auto i = static_cast<std::size_t>(grain);
        const double radius = s.radius[i];
        const double lever_over_volume =
            s.dimension == 3 ? 3 / (4 * std::numbers::pi * radius * radius) : 1 / (std::numbers::pi * radius);
        add_product(stress[i], -lever_over_volume, c.normal, c.force);
    };
    for (const Contact& c : frame.contacts) {
        add(c.i, c);
        if (!c.with_wall()) add(c.j, c);
    }
    return stress;
}

Tensor contact_stress(const Frame& frame, const Region& region) {
    const Snapshot& s = frame.grains;
    Tensor stress = zero(s.dimension);
    for (const Contact& c : frame.contacts) {
        if (!region.contains(wrapped(s, c.point))) continue;
        double length = s.radius[static_cast<std::size_t>(c.i)] - c.overlap;
        if (!c.with_wall()) length += s.radius[static_cast<std::size_t>(c.j)];
        add_product(stress, -length / region.measure(), c.normal, c.force);
    }
    return stress;
}

Tensor kinetic_stress(const Snapshot& s, const Region& region) {
    double mass = 0;
    Vec momentum;
    for (std::size_t i = 0; i < s.size(); ++i) {
        if (!region.contains(s.position(i))) continue;
        mass += s.mass[i];
        momentum = momentum + s.mass[i] * s.velocity(i);
    }
    Tensor stress = zero(s.dimension);
    if (mass == 0) return stress;
    const Vec flow = (1 / mass) * momentum;
    for (std::size_t i = 0; i < s.size(); ++i) {
        const Vec u = s.velocity(i) - flow;
        if (region.contains(s.position(i))) add_product(stress, s.mass[i] / region.measure(), u, u);
    }
    return stress;
}

double contact_number(const Frame& frame, const Region& region) {
    const Snapshot& s = frame.grains;
    double grains = 0, contacts = 0;
    std::vector<bool> inside(s.size());
    for (std::size_t i = 0; i < s.size(); ++i) {
        inside[i] = region.contains(s.position(i));
        if (inside[i]) ++grains;
    }
    for (const Contact& c : frame.contacts) {
        if (inside[static_cast<std::size_t>(c.i)]) ++contacts;
        if (!c.with_wall() && inside[static_cast<std::size_t>(c.j)]) ++contacts;
    }
    return grains > 0 ? contacts / grains : 0;
}

std::unique_ptr<Analysis> make_stress(const scene::Scene& scene, const scene::AnalysisSpec& spec) {
    return std::make_unique<Stress>(region_of(scene, spec));
}

} // namespace sandlane::analysis
