// `sandlane convert` and `sandlane render`: between scenes, checkpoints, the book's 25-column files and
// pictures.
#include "app/md_engine.hpp"
#include "app/prepare.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/progress.hpp"
#include "scene/book_format.hpp"
#include "scene/reader.hpp"
#include "scene/schema.hpp"

#include <algorithm>
#include <numeric>

namespace sandlane::app {

namespace fs = std::filesystem;

namespace {

bool is_toml(const fs::path& path) {
    return path.extension() == ".toml";
}

// As it stood in a checkpoint, or at the start of a scene.
std::unique_ptr<Engine> load_state(const fs::path& path) {
    const Common common;
    if (is_toml(path)) return prepare(scene::read_scene(path), common)->start();
    return prepare_checkpoint(path, common).engine();
}

// The storage order of a run follows the places of the grains.
std::vector<std::size_t> in_order_of_ids(const md::State& state) {
    std::vector<std::size_t> order(state.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return state.id[a] < state.id[b]; });
    return order;
}

scene::BookRecord free_grain(const md::Simulation& sim, std::size_t i) {
    const md::State& state = sim.state();
    const double dt = sim.plan().dt;
    // The third degree of freedom is the arc R phi.
    const auto value = [&](int dof, int k) {
        if (dof >= state.dofs() || k >= state.order) return 0.0;
        return state.value(i, dof, k) * (dof == 2 ? state.inverse_radius(i) : 1.0);
    };
    const Vec position = state.position(i), velocity = (1 / dt) * state.shift(i);
    scene::BookRecord r;
    r.x = position.x;
    r.y = position.y;
    r.phi = state.angle(i);
    r.vx = velocity.x;
    r.vy = velocity.y;
    r.omega = state.turn(i).z / dt;
    r.radius = state.radius(i);
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
    r.modulus = 4 * m.young / (3 * (1 - m.poisson * m.poisson));
    r.dissipation = m.dissipation;
    r.friction = m.friction;
    r.damping = m.tangential_damping;
}

// The format knows one normal law, and walls made of grains only.
void check_suits_book(const scene::Scene& s, const fs::path& from) {
    if (s.method != scene::Engine::md)
        fail(
            Exit::invalid_input,
            "convert: {}: method = \"{}\" has no place in the book's format, which knows grains of molecular "
            "dynamics only",
            from.string(), scene::engine_choices()[static_cast<std::size_t>(s.method)]);
    if (s.domain.dimension != 2)
        fail(Exit::invalid_input,
             "convert: {}: is three-dimensional, and the book's format knows two dimensions only. Convert to "
             "a scene (.toml), or run it with output.trajectory = [\"dump\"], [\"xyz\"] or [\"vtp\"].",
             from.string());
    if (s.md.normal != scene::NormalLaw::viscoelastic)
        fail(Exit::invalid_input,
             "convert: {}: md.normal = \"{}\" has no place in the book's format, which knows viscoelastic "
             "grains only",
             from.string(), scene::normal_choices()[static_cast<std::size_t>(s.md.normal)]);
    const auto lost = std::count_if(s.walls.begin(), s.walls.end(),
                                    [](const scene::Wall& w) { return w.kind != scene::WallKind::grains; });
    if (lost > 0)
        tell(fmt::format("warning: {}: {} walls are left out; the book's format knows rows of grains only\n",
                         from.string(), lost));
}

scene::Book to_book(const md::Simulation& sim) {
    scene::Book book;
    const scene::Scene& s = sim.scene();
    book.header.gravity = s.domain.gravity;
    book.header.time = sim.time();
    book.header.time_step = sim.plan().tick;
    book.header.steps = sim.plan().steps;
    book.header.print_every = book.header.energy_every = std::max<std::int64_t>(1, sim.plan().steps / 100);
    book.header.x_0 = s.domain.lower.x;
    book.header.y_0 = s.domain.lower.y;
    book.header.lx = s.domain.upper.x - s.domain.lower.x;
    book.header.ly = s.domain.upper.y - s.domain.lower.y;
    for (const std::size_t i : in_order_of_ids(sim.state())) {
        scene::BookRecord r = free_grain(sim, i);
        set_material(r, s.materials[static_cast<std::size_t>(sim.state().material[i])]);
        book.records.push_back(r);
    }
    // Wall grains as fixed ones (type 1): the format has no parameters for motions.
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

// An init file, or one frame of a file of snapshots.
scene::Book read_book(const fs::path& path, std::int64_t frame) {
    const std::string text = read_file(path), name = path.string();
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string::npos || text.compare(first, 9, "#NewFrame") != 0) {
        if (frame >= 0)
            fail(Exit::invalid_input, "{}: is an init file without frames; leave out --frame", name);
        return scene::parse_book(text, name);
    }
    std::vector<scene::Book> frames = scene::parse_book_frames(text, name);
    const auto count = static_cast<std::int64_t>(frames.size());
    if (frame >= count)
        fail(Exit::invalid_input, "{}: --frame {}: the file has {} frames; allowed: 0 to {}", name, frame,
             count, count - 1);
    return std::move(frames[static_cast<std::size_t>(frame < 0 ? count - 1 : frame)]);
}

std::string scene_text_of_book(const ConvertOptions& options) {
    const scene::Scene scene =
        scene::scene_from_book(read_book(options.from, options.frame), options.from.string());
    scene::validate(scene, options.from.string());
    return scene::write_scene(scene);
}

std::string book_text(const ConvertOptions& options) {
    const std::unique_ptr<Engine> engine = load_state(options.from);
    check_suits_book(engine->scene(), options.from);
    const scene::Book book = to_book(dynamic_cast<const MdEngine&>(*engine).simulation());
    return options.snapshot ? scene::write_book_frame(book) : scene::write_book(book);
}

} // namespace

int convert(const ConvertOptions& options) {
    const bool from_book = !is_toml(options.from) && options.from.extension() != ".checkpoint";
    if (from_book && !is_toml(options.to))
        fail(Exit::invalid_input,
             "convert: {} is a book file; it converts to a scene, so the target must end in .toml",
             options.from.string());
    if (!from_book && options.frame >= 0)
        fail(Exit::invalid_input, "convert: {}: --frame goes with the book's snapshot files only",
             options.from.string());
    if (is_toml(options.to) && options.snapshot)
        fail(Exit::invalid_input,
             "convert: {}: --snapshot goes with book files; a target that ends in .toml is a scene",
             options.to.string());
    const std::string text = from_book             ? scene_text_of_book(options)
                             : is_toml(options.to) ? scene::write_scene(load_state(options.from)->scene())
                                                   : book_text(options);
    write_file_atomically(options.to, text);
    return 0;
}

int render(const RenderOptions& options) {
    const std::unique_ptr<Engine> engine = load_state(options.from);
    try {
        engine->draw(options.png, options.look);
    } catch (const Error& e) {
        if (e.code() != Exit::invalid_input) throw;
        fail(e.code(), "render: {}: {}", options.from.string(), e.what());
    }
    return 0;
}

} // namespace sandlane::app
