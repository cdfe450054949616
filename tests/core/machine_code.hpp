// Switches machine code on or off in tests.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

#include "program/machine.hpp"

namespace achilles::test {

// Sets or unsets the environment variable ACHILLES_MACHINE_CODE; the destructor restores it.
class MachineCodeSwitch {
 public:
    explicit MachineCodeSwitch(const char* value) {
        if (const char* before = std::getenv(name)) before_ = before;
        set(value);
    }
    ~MachineCodeSwitch() { set(before_ ? before_->c_str() : nullptr); }
    MachineCodeSwitch(const MachineCodeSwitch&) = delete;
    MachineCodeSwitch& operator=(const MachineCodeSwitch&) = delete;

 private:
    static constexpr const char* name = "ACHILLES_MACHINE_CODE";
    static void set(const char* value) {
        value != nullptr ? setenv(name, value, 1) : unsetenv(name);
        ask_environment_for_code();
    }
    std::optional<std::string> before_;
};

}  // namespace achilles::test
