// Who decides on the number of threads, and that every tile is done once.
#include "core/parallel.hpp"

#include "core/error.hpp"
#include "support/says.hpp"

#include <atomic>
#include <cstdlib>
#include <vector>

namespace sandlane {

namespace {

class Threads : public testing::Test {
protected:
    Threads() {
        for (const char* name : names) ::unsetenv(name);
    }
    ~Threads() override {
        for (const char* name : names) ::unsetenv(name);
    }
    static constexpr const char* names[] = {"SANDLANE_THREADS", "OMP_NUM_THREADS"};
};

TEST_F(Threads, RequestThenOwnVariableThenOpenMpThenMachine) {
    const ThreadChoice machine = choose_threads(0);
    EXPECT_EQ(machine.count, allowed_cpus());
    EXPECT_TRUE(machine.automatic);
    ::setenv("OMP_NUM_THREADS", "3,2", 1);
    EXPECT_EQ(choose_threads(0).count, 3);
    EXPECT_EQ(choose_threads(0).reason, "OMP_NUM_THREADS");
    EXPECT_FALSE(choose_threads(0).automatic);
    ::setenv("SANDLANE_THREADS", "2", 1);
    EXPECT_EQ(choose_threads(0).count, 2);
    EXPECT_EQ(choose_threads(0).reason, "SANDLANE_THREADS");
    EXPECT_EQ(choose_threads(1).count, 1);
    EXPECT_EQ(choose_threads(1).reason, "--threads");
    ::setenv("SANDLANE_THREADS", "", 1); // as if it were not set
    EXPECT_EQ(choose_threads(0).count, 3);
}

TEST_F(Threads, NonsenseIsRefused) {
    for (const char* nonsense : {"0", "-1", "two", "2.5", "2 ", "99999999999"}) {
        ::setenv("OMP_NUM_THREADS", nonsense, 1);
        try {
            (void)choose_threads(0);
            ADD_FAILURE() << nonsense;
        } catch (const Error& e) {
            EXPECT_EQ(e.code(), Exit::invalid_input);
            EXPECT_SAYS(std::string(e.what()), std::string("OMP_NUM_THREADS=") + nonsense);
        }
    }
    try {
        (void)choose_threads(100000);
        ADD_FAILURE();
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), Exit::unavailable);
        EXPECT_SAYS(std::string(e.what()), "--threads asks for 100000 threads, but this process may use");
    }
}

TEST(Tiles, EachIsDoneOnce) {
    for (const int threads : {1, 2, 3, 7})
        for (const std::size_t tiles : {0UL, 1UL, 2UL, 5UL, 1000UL}) {
            std::vector<std::atomic<int>> once(tiles), dynamic(tiles);
            for_tiles(tiles, threads, [&](std::size_t tile) { ++once[tile]; });
            for_tiles_dynamic(tiles, threads, [&](std::size_t tile) { ++dynamic[tile]; });
            for (std::size_t t = 0; t < tiles; ++t)
                EXPECT_TRUE(once[t] == 1 && dynamic[t] == 1) << threads << ' ' << t;
        }
}

// More threads than processors as well: whoever waits gives way.
TEST(Tiles, CrewMeetsBetweenRounds) {
    constexpr int rounds = 200;
    for (const int threads : {1, 2, 3, 7}) {
        std::vector<int> tiles(5, 0);
        int serial = 0, early = 0;
        with_crew(threads, [&](Crew& crew) {
            for (int round = 0; round < rounds; ++round) {
                crew.for_tiles(tiles.size(), [&](std::size_t tile) { ++tiles[tile]; });
                crew.once([&] {
                    serial += 1;
                    for (const int count : tiles) early += count != round + 1 ? 1 : 0;
                });
            }
        });
        EXPECT_EQ(tiles, std::vector<int>(5, rounds)) << threads;
        EXPECT_EQ(serial, rounds) << threads;
        EXPECT_EQ(early, 0) << threads;
    }
}

} // namespace

} // namespace sandlane
