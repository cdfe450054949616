// A line of flags, each with a value, as on a command line: what a journal has of a study.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace achilles {

struct Flag {
    std::string name, value;  // "--over", "e=0:0.95:200"
};

// What stands in double quotes is one value. Throws InputError, about `whose` or the flag.
std::vector<Flag> read_flags(std::string_view text, const std::string& whose);
// As a shell reads it, too.
std::string to_text(const std::vector<Flag>& flags);

}  // namespace achilles
