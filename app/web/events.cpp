// Prints the event times of a system file's run with all their bits, one per line. tests/web/run compares them with
// those of the native program.
#include <cstdio>

#include "achilles.hpp"

int main(int count, char** words) try {
    if (count != 2) {
        std::fprintf(stderr, "usage: achilles_events SYSTEM.toml\n");
        return 2;
    }
    const achilles::SystemDescription system = achilles::read_system(words[1]);
    const achilles::Trajectory trajectory = achilles::simulate(achilles::derive(system), achilles::NamedRun(system));
    for (const achilles::Event& event : trajectory.events) std::printf("%a\n", event.t);
} catch (const achilles::InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
