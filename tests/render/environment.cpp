// Environment of all rendering tests, however the test program is started.
#include <gtest/gtest.h>

#include <cstdlib>

namespace {

class Mesa : public testing::Environment {
 public:
    // A picture must not depend on shaders cached by an earlier run.
    void SetUp() override { setenv("MESA_SHADER_CACHE_DISABLE", "true", 1); }
};

[[maybe_unused]] const testing::Environment* const mesa = testing::AddGlobalTestEnvironment(new Mesa);

}  // namespace
