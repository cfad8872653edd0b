// More memory than there is is refused in words.
#include "core/memory.hpp"

#include "core/error.hpp"
#include "support/says.hpp"

#include <sys/resource.h>

namespace sandlane {

namespace {

TEST(Memory, RefusesWhatCannotBe) {
    EXPECT_GT(allowed_memory(), 1e6);
    EXPECT_NO_THROW(require_memory(allowed_memory(), "all of it"));
    try {
        require_memory(3e18, "a large scene");
        ADD_FAILURE();
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), Exit::unavailable);
        EXPECT_SAYS(std::string(e.what()),
                    "a large scene needs about 3e+09 GB of memory; this process may use");
    }
}

TEST(Memory, KnowsTheLimitOfItsAddressSpace) {
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_AS, &before), 0);
    const auto less = static_cast<rlim_t>(allowed_memory() / 2);
    const rlimit lower{less, before.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_AS, &lower), 0);
    const double allowed = allowed_memory();
    ASSERT_EQ(::setrlimit(RLIMIT_AS, &before), 0);
    EXPECT_EQ(allowed, static_cast<double>(less));
}

} // namespace

} // namespace sandlane
