// What every drawing test runs under, however the test program is started.
#include <gtest/gtest.h>

#include <cstdlib>

namespace {

class Mesa : public testing::Environment {
 public:
    // A picture must not depend on shaders that an earlier run left in a cache.
    void SetUp() override { setenv("MESA_SHADER_CACHE_DISABLE", "true", 1); }
};

[[maybe_unused]] const testing::Environment* const mesa = testing::AddGlobalTestEnvironment(new Mesa);

}  // namespace
