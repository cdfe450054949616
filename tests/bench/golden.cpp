// Measures how well the comparison of pixels separates falsified from correct pictures. Every falsification is applied
// to every figure of the gallery. Prints the smallest score of each kind, the number that the coarse limit alone would
// miss, and the largest score of pictures drawn again in other ways. render/image/comparison.hpp has the limits; a
// score of 1 is the limit.
//
//     bench_golden [REPETITIONS [SYSTEM...]]        exits with 1 if a lie is missed or a correct picture is rejected
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "cli/assets.hpp"
#include "golden/mutated_figures.hpp"
#include "golden/pictures.hpp"
#include "image/comparison.hpp"

namespace {

using namespace achilles;
using namespace achilles::golden;

struct Tally {
    int told = 0, missed = 0, missed_by_coarse = 0;
    ImageDistance least;
    std::string example;
    void add(const ImageDistance& distance, const std::string& what) {
        if (told++ == 0 || distance.score() < least.score()) least = distance, example = what;
        if (distance.coarse <= worst_tile_allowed) ++missed_by_coarse;
        if (distance.score() <= 1.0) {
            ++missed;
            fmt::print("missed: {} (coarse {:.4f}, fine {:.4f})\n", what, distance.coarse, distance.fine);
        }
    }
};

// The number of falsified pictures that are missed.
int tell_lies(const std::vector<std::string>& systems) {
    constexpr std::pair<FigureMutation::Kind, const char*> kinds[] = {
        {FigureMutation::Kind::moved_right, "curve moved right"},
        {FigureMutation::Kind::moved_up, "curve moved up"},
        {FigureMutation::Kind::other_hue, "hue"},
        {FigureMutation::Kind::thicker, "thicker"},
        {FigureMutation::Kind::no_marker, "marker missing"},
        {FigureMutation::Kind::other_digit, "digit"}};
    std::map<FigureMutation::Kind, Tally> tallies;
    for (const std::string& system : systems) {
        Easel easel(system);
        const Image truth = easel.draw(easel.truth());
        for (const FigureMutation& lie : lies_about(easel.truth()))
            tallies[lie.kind].add(distance(truth, easel.draw(told(lie, easel.truth()))),
                                  system + ": " + to_text(lie, easel.truth()));
    }
    int missed = 0;
    fmt::print("{:<18} {:>5} {:>6} {:>11} {:>8} {:>8}\n", "lie", "told", "missed", "coarse only", "coarse", "fine");
    for (const auto& [kind, name] : kinds) {
        const Tally& tally = tallies[kind];
        fmt::print("{:<18} {:>5} {:>6} {:>11} {:>8.4f} {:>8.4f}  {}\n", name, tally.told, tally.missed,
                   tally.missed_by_coarse, tally.least.coarse, tally.least.fine, tally.example);
        missed += tally.missed;
    }
    return missed;
}

// The number of correct pictures that are rejected.
int be_honest(const std::vector<std::string>& systems, int repetitions) {
    const std::vector<std::string> commands{figure_command(systems.back()),
                                            "screenshot --size 1200x750 " + systems.back()};
    int refused = 0;
    for (const std::string& command : commands) {
        const Image truth = image_of(command);
        for (const char* means :
             {"LP_NUM_THREADS=1 LP_NATIVE_VECTOR_WIDTH=128", "LP_NUM_THREADS=1 LP_NATIVE_VECTOR_WIDTH=256",
              "LP_NUM_THREADS=2 LP_NATIVE_VECTOR_WIDTH=128", "LP_NUM_THREADS=2 LP_NATIVE_VECTOR_WIDTH=256",
              "ACHILLES_OFFSCREEN=egl", "GALLIUM_OVERRIDE_CPU_CAPS=sse2"}) {
            ImageDistance greatest;
            for (int i = 0; i < repetitions; ++i) {
                const ImageDistance distance = achilles::distance(truth, image_of(command, means));
                if (distance.score() > greatest.score()) greatest = distance;
                refused += distance.score() > 1.0 ? 1 : 0;
            }
            fmt::print("{:<10} {:<44} {} times: score {:.2f} (coarse {:.4f}, fine {:.4f})\n",
                       command.substr(0, command.find(' ')), means, repetitions, greatest.score(), greatest.coarse,
                       greatest.fine);
            std::fflush(stdout);
        }
    }
    return refused;
}

}  // namespace

int main(int argc, char** argv) {
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    const int repetitions = argc > 1 ? std::max(std::atoi(argv[1]), 1) : 30;
    std::vector<std::string> systems(argv + std::min(argc, 2), argv + argc);
    if (systems.empty()) systems = system_names();
    const int refused = be_honest(systems, repetitions), missed = tell_lies(systems);
    return refused + missed == 0 ? 0 : 1;
}
