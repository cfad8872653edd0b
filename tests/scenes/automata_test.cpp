// The scenes of cellular automata in data/scenes, smaller or shorter: what they show must happen.
#include "automata/model.hpp"
#include "scene/reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace sandlane {

namespace {

std::unique_ptr<automata::Model> shipped_model(const std::string& name, const scene::Overrides& overrides) {
    const scene::Scene s =
        scene::read_scene(std::string(SANDLANE_SOURCE_DIR "/data/scenes/") + name, overrides);
    return automata::make_model(s, {simd::available_isas().back(), 1});
}

const automata::Table& named(const std::vector<automata::Table>& tables, const std::string& name) {
    return *std::find_if(tables.begin(), tables.end(),
                         [&](const automata::Table& t) { return t.name == name; });
}

double logged(const automata::Model& model, const std::string& column) {
    const auto columns = model.log_columns();
    const auto at =
        std::find_if(columns.begin(), columns.end(), [&](const auto& c) { return c.name == column; });
    return model.log_row()[static_cast<std::size_t>(at - columns.begin())];
}

// The identity has the symmetries of the square, and the middle is a square of twos.
TEST(ShippedAutomata, IdentityIsSymmetric) {
    const auto model = shipped_model("sandpile-identity.toml", {"sandpile.columns=128", "sandpile.rows=128"});
    while (!model->finished()) model->run(1000);
    const std::vector<double> h = model->quantities()[0].values;
    for (std::size_t y = 0; y < 128; ++y)
        for (std::size_t x = 0; x < 128; ++x) {
            EXPECT_EQ(h[y * 128 + x], h[x * 128 + y]);
            EXPECT_EQ(h[y * 128 + x], h[y * 128 + 127 - x]);
        }
    EXPECT_EQ(h[64 * 128 + 64], 2);
    EXPECT_EQ(h[70 * 128 + 55], 2);
}

TEST(ShippedAutomata, SourceSpreadsToADisc) {
    const auto model = shipped_model("sandpile-source.toml",
                                     {"sandpile.centre=20000", "sandpile.columns=201", "sandpile.rows=201"});
    while (!model->finished()) model->run(1000);
    EXPECT_EQ(logged(*model, "grains"), 20000); // none reached a side
    const std::vector<double> h = model->quantities()[0].values;
    double squares = 0, north = 0, farthest = 0, axis = 0;
    for (int y = -100; y <= 100; ++y)
        for (int x = -100; x <= 100; ++x) {
            const double grains = h[static_cast<std::size_t>((y + 100) * 201 + x + 100)];
            squares += grains * (x * x + y * y);
            north += grains * (x * x - y * y);
            if (grains > 0) farthest = std::max(farthest, std::hypot(x, y));
            if (grains > 0 && y == 0) axis = std::max(axis, static_cast<double>(x));
        }
    // Four grains that go one site each way add 4 to the sum of the squares.
    EXPECT_EQ(squares, 4 * logged(*model, "topplings"));
    EXPECT_EQ(north, 0); // as far along as across
    // Levine and Peres: between the discs of mean heights 3 and 2, but for a few sites.
    EXPECT_GT(axis, std::sqrt(20000 / (3 * std::numbers::pi)));
    EXPECT_LT(farthest, std::sqrt(20000 / (2 * std::numbers::pi)) + 2);
}

// Probabilities of sizes fall as s^-tau with an effective tau between 1.0 and 1.3 far from the cut-off.
TEST(SlowShippedAutomata, AvalanchesHaveAPowerLaw) {
    const auto model = shipped_model("avalanches.toml", {"sandpile.columns=64", "sandpile.rows=64",
                                                         "sandpile.burn_in=20000", "sandpile.steps=120000"});
    model->run(120000);
    const auto tables = model->final_tables();
    const automata::Table& sizes = named(tables, "avalanche-size");
    const auto probability = [&](double size) {
        const auto row =
            std::find_if(sizes.rows.begin(), sizes.rows.end(), [&](const auto& r) { return r[0] >= size; });
        return *row;
    };
    const auto small = probability(4), large = probability(200);
    const double tau = -std::log(large[2] / small[2]) / std::log(large[0] / small[0]);
    EXPECT_GT(tau, 1.0);
    EXPECT_LT(tau, 1.3);
}

TEST(ShippedAutomata, HeapHasATail) {
    const auto model = shipped_model("heap-energy.toml", {"heap.heaps=40", "heap.steps=2000"});
    model->run(2000);
    const auto tables = model->final_tables();
    const std::vector<double> tail = named(tables, "tail").rows[0];
    EXPECT_LT(tail[4], 0.5 * tail[5]); // the logarithm fits better than a line
    EXPECT_LT(tail[2], 0);             // and the foot is flatter
}

TEST(ShippedAutomata, RipplesGrowAndMerge) {
    const auto model = shipped_model("ripples.toml", {"ripples.columns=128", "ripples.rows=64"});
    const double start = logged(*model, "rms_height");
    model->run(60);
    const double early = logged(*model, "crest_distance");
    EXPECT_GT(logged(*model, "rms_height"), 100 * start);
    EXPECT_NEAR(logged(*model, "wavelength"), 10, 2.5); // the fastest mode of linear theory: 10 sites
    model->run(540);
    EXPECT_GT(logged(*model, "crest_distance"), 1.1 * early);
}

// Root of the sum of squares of the velocity across, of means over 16 x 16 values and 20 times: flow, not
// single particles.
double flow_across(automata::Model& model) {
    std::vector<double> mean;
    std::size_t columns = 0, rows = 0;
    for (int n = 0; n < 20; ++n) {
        model.run(10);
        const automata::Field v = model.fields()[0];
        columns = v.columns;
        rows = v.rows;
        mean.resize((columns / 16) * (rows / 16), 0);
        for (std::size_t y = 0; y < rows / 16 * 16; ++y)
            for (std::size_t x = 0; x < columns / 16 * 16; ++x)
                mean[y / 16 * (columns / 16) + x / 16] += v.values[y * columns + x] / (256 * 20);
    }
    double sum = 0;
    for (const double m : mean) sum += m * m;
    return std::sqrt(sum);
}

// Flow turns sideways behind the plate; without a plate nothing does.
TEST(SlowShippedAutomata, PlateShedsVortices) {
    const auto make = [](const char* size) {
        return shipped_model("vortex-street.toml",
                             {"lattice_gas.columns=512", "lattice_gas.rows=256",
                              "obstacles.0.centre=[120, 128]", std::string("obstacles.0.size=") + size});
    };
    const auto plate = make("[4, 60]"), none = make("[0.1, 0.1]");
    for (const auto& model : {plate.get(), none.get()}) model->run(2000);
    const double with = flow_across(*plate), without = flow_across(*none);
    // Both are sums over 128 means: they scatter by 6 %. Measured: 3.0.
    EXPECT_GT(with, 2.5 * without);
    EXPECT_GT(logged(*plate, "flow"), 0.1);
}

TEST(ShippedAutomata, PipeFlowHasWaves) {
    const auto variance = [](const std::string& dissipation) {
        const auto model = shipped_model("pipe-waves.toml",
                                         {"pipe_flow.length=512", "pipe_flow.dissipation=" + dissipation});
        model->run(6000);
        const std::vector<double> map = model->final_fields()[0].values;
        const std::vector<double> last(map.end() - 512, map.end());
        // Over 16 columns: waves, not single particles.
        double sum = 0, squares = 0;
        for (std::size_t x = 0; x < 512; x += 16) {
            double mean = 0;
            for (std::size_t k = 0; k < 16; ++k) mean += last[x + k] / 16;
            sum += mean;
            squares += mean * mean;
        }
        return squares / 32 - sum / 32 * (sum / 32);
    };
    EXPECT_GT(variance("0.1"), 2 * variance("0"));
}

} // namespace

} // namespace sandlane
