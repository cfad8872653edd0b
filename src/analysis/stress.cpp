#include "analysis/stress.hpp"

#include <numbers>

namespace sandlane::analysis {

namespace {

void add_product(Tensor& t, double factor, Vec a, Vec b) {
    t.xx += factor * a.x * b.x;
    t.xy += factor * a.x * b.y;
    t.yx += factor * a.y * b.x;
    t.yy += factor * a.y * b.y;
}

Vec centre(const Snapshot& s, std::size_t i) {
    return {s.x[i], s.y[i], 0};
}

class Stress : public Series {
public:
    explicit Stress(Region region) : region_(region) {}

    [[nodiscard]] std::vector<LogColumn> columns() const override {
        return {{"time", "s"},           {"stress_xx", "N/m"},     {"stress_xy", "N/m"},
                {"stress_yx", "N/m"},    {"stress_yy", "N/m"},     {"pressure", "N/m"},
                {"kinetic_xx", "N/m"},   {"kinetic_xy", "N/m"},    {"kinetic_yy", "N/m"},
                {"contact_number", "1"}, {"packing_fraction", "1"}};
    }
    void add(const Frame& frame) override {
        const Tensor contact = contact_stress(frame, region_),
                     kinetic = kinetic_stress(frame.grains, region_);
        rows_ = {{frame.grains.time, contact.xx, contact.xy, contact.yx, contact.yy, contact.pressure(),
                  kinetic.xx, kinetic.xy, kinetic.yy, contact_number(frame, region_),
                  packing_fraction(frame.grains, region_)}};
    }

private:
    Region region_;
};

} // namespace

std::vector<Tensor> grain_stress(const Frame& frame) {
    const Snapshot& s = frame.grains;
    std::vector<Tensor> stress(s.size());
    // Both partners have the same sign: lever arm and force turn round together.
    const auto add = [&](std::int32_t grain, const Contact& c) {
        const auto i = static_cast<std::size_t>(grain);
        add_product(stress[i], -1 / (std::numbers::pi * s.radius[i]), c.normal, c.force);
    };
    for (const Contact& c : frame.contacts) {
        add(c.i, c);
        if (!c.with_wall()) add(c.j, c);
    }
    return stress;
}

Tensor contact_stress(const Frame& frame, const Region& region) {
    const Snapshot& s = frame.grains;
    Tensor stress;
    for (const Contact& c : frame.contacts) {
        if (!region.contains(wrapped(s, c.point))) continue;
        double length = s.radius[static_cast<std::size_t>(c.i)] - c.overlap;
        if (!c.with_wall()) length += s.radius[static_cast<std::size_t>(c.j)];
        add_product(stress, -length / region.area(), c.normal, c.force);
    }
    return stress;
}

Tensor kinetic_stress(const Snapshot& s, const Region& region) {
    double mass = 0;
    Vec momentum;
    for (std::size_t i = 0; i < s.size(); ++i) {
        if (!region.contains(centre(s, i))) continue;
        mass += s.mass[i];
        momentum = momentum + s.mass[i] * Vec{s.vx[i], s.vy[i], 0};
    }
    Tensor stress;
    if (mass == 0) return stress;
    const Vec flow = (1 / mass) * momentum;
    for (std::size_t i = 0; i < s.size(); ++i) {
        const Vec u = Vec{s.vx[i], s.vy[i], 0} - flow;
        if (region.contains(centre(s, i))) add_product(stress, s.mass[i] / region.area(), u, u);
    }
    return stress;
}

double contact_number(const Frame& frame, const Region& region) {
    const Snapshot& s = frame.grains;
    double grains = 0, contacts = 0;
    std::vector<bool> inside(s.size());
    for (std::size_t i = 0; i < s.size(); ++i) {
        inside[i] = region.contains(centre(s, i));
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
