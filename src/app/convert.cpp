// `sandlane convert` and `sandlane render`: between scenes, checkpoints, the book's 25-column files and
// pictures.
#include "app/prepare.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "output/checkpoint.hpp"
#include "output/picture.hpp"
#include "scene/book_format.hpp"

#include <cmath>

namespace sandlane::app {

namespace {

bool is_toml(const std::filesystem::path& path) {
    return path.extension() == ".toml";
}

// The simulation as it stood in a checkpoint, or at the start of a scene.
md::Simulation load_state(const std::filesystem::path& path, const Common& common) {
    if (path.extension() != ".checkpoint") return prepare(scene::read_scene(path), common).simulation();
    const output::Checkpoint checkpoint = output::read_checkpoint(path);
    md::Simulation simulation =
        prepare(scene::parse_scene(checkpoint.scene, path.string()), common).simulation();
    simulation.restore(checkpoint.engine_state);
    return simulation;
}

scene::BookRecord free_grain(const md::Simulation& sim, std::size_t i) {
    const md::State& state = sim.state();
    const double dt = sim.plan().dt;
    const auto value = [&](int dof, int k) {
        return dof < state.dofs && k < state.order ? state.value(i, dof, k) : 0.0;
    };
    scene::BookRecord r;
    r.x = value(0, 0);
    r.y = value(1, 0);
    r.phi = value(2, 0);
    r.vx = value(0, 1) / dt;
    r.vy = value(1, 1) / dt;
    r.omega = value(2, 1) / dt;
    r.radius = state.radius[i];
    r.mass = state.mass[i];
    double factorial = 1, power = dt;
    for (int k = 2; k <= 4; ++k) { // Nordsieck: X_k = dt^k/k! d^k y/dt^k
        factorial *= k;
        power *= dt;
        for (int dof = 0; dof < 3; ++dof)
            r.derivatives[static_cast<std::size_t>(3 * (k - 2) + dof)] = value(dof, k) * factorial / power;
    }
    return r;
}

void set_material(scene::BookRecord& r, const scene::Material& m) {
    r.modulus = m.young > 0 ? 4 * m.young / (3 * (1 - m.poisson * m.poisson)) : m.stiffness;
    r.dissipation = m.dissipation;
    r.friction = m.friction;
    r.damping = m.tangential_damping;
}

scene::Book to_book(const md::Simulation& sim) {
    scene::Book book;
    const scene::Scene& s = sim.scene();
    book.header.gravity = s.domain.gravity;
    book.header.time = sim.time();
    book.header.time_step = sim.plan().dt;
    book.header.steps = sim.plan().steps;
    book.header.print_every = book.header.energy_every = std::max<std::int64_t>(1, sim.plan().steps / 100);
    book.header.x_0 = s.domain.lower.x;
    book.header.y_0 = s.domain.lower.y;
    book.header.lx = s.domain.upper.x - s.domain.lower.x;
    book.header.ly = s.domain.upper.y - s.domain.lower.y;
    for (std::size_t i = 0; i < sim.state().size(); ++i) {
        scene::BookRecord r = free_grain(sim, i);
        set_material(r, s.materials[static_cast<std::size_t>(sim.state().material[i])]);
        book.records.push_back(r);
    }
    // Wall grains as fixed ones (type 1): the format has no parameters for motions. Analytic walls have no
    // place in it.
    for (const analysis::WallShape& w : sim.snapshot().walls) {
        if (w.kind != analysis::WallShape::Kind::disc) continue;
        scene::BookRecord r;
        r.x = w.centre.x;
        r.y = w.centre.y;
        r.radius = w.radius;
        r.mass = 1;
        r.type = 1;
        set_material(r, s.materials[static_cast<std::size_t>(w.material)]);
        book.records.push_back(r);
    }
    return book;
}

} // namespace

int convert(const std::filesystem::path& from, const std::filesystem::path& to) {
    const Common common;
    const bool from_book = !is_toml(from) && from.extension() != ".checkpoint";
    if (from_book && !is_toml(to))
        fail(Exit::invalid_input,
             "convert: {} is a book file; it converts to a scene, so the target must end in .toml",
             from.string());
    if (from_book)
        write_file_atomically(to, scene::write_scene(scene::scene_from_book(
                                      scene::parse_book(read_file(from), from.string()), from.string())));
    else if (is_toml(to))
        write_file_atomically(to, scene::write_scene(load_state(from, common).scene()));
    else
        write_file_atomically(to, scene::write_book(to_book(load_state(from, common))));
    return 0;
}

int render(const std::filesystem::path& checkpoint, const std::filesystem::path& png,
           const std::string& colour, int width) {
    output::PictureStyle style;
    style.width = width;
    style.colour = colour == "pressure" ? scene::Colour::pressure
                   : colour == "spin"   ? scene::Colour::spin
                   : colour == "radius" ? scene::Colour::radius
                                        : scene::Colour::speed;
    const md::Simulation simulation = load_state(checkpoint, Common{});
    style.body = simulation.scene().md.body;
    output::write_picture(png, simulation.snapshot(), style);
    return 0;
}

} // namespace sandlane::app
