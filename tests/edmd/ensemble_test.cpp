// Replicas: each is the run of its own seed, whatever the threads, the division of the run, and a checkpoint.
#include "core/error.hpp"
#include "edmd/ensemble.hpp"
#include "edmd/support.hpp"

using namespace sandlane;
using test::widest;

namespace {

edmd::Ensemble replicas(const edmd::Setup& s, std::uint32_t n, int count, int threads) {
    std::vector<std::unique_ptr<edmd::Algorithm>> runs;
    for (int k = 0; k < count; ++k) {
        edmd::Setup other = s;
        other.seed += static_cast<std::uint64_t>(k);
        runs.push_back(
            std::make_unique<edmd::Simulation>(other, edmd::make_particles(other, {n}, 1.0), widest(), 1));
    }
    return {std::move(runs), threads};
}

} // namespace

TEST(EdmdEnsemble, SameForAnyThreads) {
    const edmd::Setup s = test::hard_gas(3, 0.2, 0.9, 100);
    edmd::Ensemble one = replicas(s, 100, 5, 1);
    EXPECT_EQ(one.run(3000), 3000);
    for (const int threads : {2, 7}) {
        edmd::Ensemble many = replicas(s, 100, 5, threads), resumed = replicas(s, 100, 5, threads);
        for (int part = 0; part < 3; ++part) many.run(500);
        resumed.restore(many.serialise());
        resumed.run(1500);
        EXPECT_EQ(resumed.state_hash(), one.state_hash());
        EXPECT_EQ(resumed.log_hash(), one.log_hash());
    }
    for (std::size_t k = 0; k < one.size(); ++k) {
        edmd::Setup other = s;
        other.seed += k;
        edmd::Simulation alone(other, edmd::make_particles(other, {100}, 1.0), widest(), 1);
        alone.run(1 << 30, one.first().time());
        EXPECT_EQ(alone.log().hash(), one[k].log().hash());
        EXPECT_EQ(alone.time(), one[k].time());
    }
    EXPECT_NE(one[0].log().hash(), one[1].log().hash());
    edmd::Ensemble fewer = replicas(s, 100, 4, 1);
    EXPECT_THROW(fewer.restore(one.serialise()), Error);
}

// What ends one of them ends all.
TEST(EdmdEnsemble, ErrorsOfAnyReplica) {
    const edmd::Setup s = test::hard_gas(2, 0.3, 0.1, 100); // collapses
    edmd::Ensemble gas = replicas(s, 100, 3, 2);
    EXPECT_THROW(gas.run(1 << 30), Error);
}

TEST(EdmdEnsemble, MeanAndError) {
    const edmd::MeanError m = edmd::mean_of({1, 2, 3, 4});
    EXPECT_NEAR(m.mean, 2.5, 1e-15);
    EXPECT_NEAR(m.error, std::sqrt(5.0 / 12), 1e-15); // of variance 5/3 over four
}
