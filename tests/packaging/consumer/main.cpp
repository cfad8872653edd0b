#include <md/simulation.hpp>
#include <scene/reader.hpp>

#include <cstdio>

int main(int, char** argv) {
    using namespace sandlane;
    const scene::Scene scene = scene::read_scene(argv[1]);
    const auto grains = scene::initial_grains(scene);
    const md::Needs needs = md::analyse(scene, grains);
    const md::Plan plan =
        md::make_plan(scene, needs, md::derive(scene, needs), simd::choose_isa("auto"), choose_threads(0));
    md::Simulation simulation(scene, grains, needs, plan);
    simulation.run(100);
    std::printf("t = %g s, kinetic energy %g J\n", simulation.time(), simulation.observe().kinetic);
}
