// A valid system file, into which tests insert mistakes.
#pragma once

#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace achilles::test {

inline const std::string good = R"toml(title = "drop"
[[coordinate]]
name = "x"
start = 1
rate = 0.5
[[coordinate]]
name = "theta"
[[parameter]]
name = "m"
value = 2
[[parameter]]
name = "e"
value = 0.5
[lagrangian]
kinetic = "m/2*(x'^2 + theta'^2)"
potential = "m*x"
[[constraint]]
gap = "x - sin(theta)/9"
restitution = "e"
[run]
end_time = 5
[truncation]
eps_q = 1e-6
[[drawing]]
shape = "curve"
over = ["s", -1, 1]
at = ["s", "s^2"]
[[view]]
name = "path"
x = "x"
y = ["gap'"]
)toml";

// The text with the first occurrence of each `from` replaced, in turn.
inline std::string changed(std::string text, const std::vector<std::pair<std::string, std::string>>& changes) {
    for (const auto& [from, to] : changes) {
        const std::size_t at = text.find(from);
        if (at == text.npos) return "no '" + from + "' to change";
        text.replace(at, from.size(), to);
    }
    return text;
}

// One change of the valid text, and the whole message for it.
struct FileEdit {
    std::string from, to, message;
};

inline void PrintTo(const FileEdit& change, std::ostream* out) { *out << change.to; }

}  // namespace achilles::test
