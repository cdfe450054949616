// Everything a run may be told, apart from the system itself.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "run/state.hpp"

namespace achilles {

enum class Method { dopri5, taylor };
enum class Conditions { paper, sharp };              // theory.md 3 and 6
enum class Reinitialization { euclidean, kinetic };  // R* of Def. 7, and the plastic impact (theory.md 5)

std::string_view to_text(Method);
std::string_view to_text(Conditions);
std::string_view to_text(Reinitialization);
std::optional<Method> method_from(std::string_view);
std::optional<Conditions> conditions_from(std::string_view);
std::optional<Reinitialization> reinitialization_from(std::string_view);

// When the bouncing may be cut short. The bounds are on what the conditions certify.
struct Truncation {
    double eps_q = 1e-6;  // position, Euclidean norm, in the coordinates' units
    double eps_v = 1e-6;  // velocity
    double eps_t = 1e-6;  // time, s
    Conditions conditions = Conditions::sharp;
    Reinitialization reinitialization = Reinitialization::kinetic;

    friend bool operator==(const Truncation&, const Truncation&) = default;
};

struct Options {
    double end_time = 10.0;          // s, the run stops here at the latest
    double tolerance = 1e-10;        // local error per step, absolute and relative
    Method method = Method::taylor;  // the faster one from any tolerance on that is worth asking for
    int max_impacts = 200000;        // over the run; then Outcome "too many impacts"
    int max_steps = 2000000;         // of the integration, over the run: all are kept; then Outcome "too many steps"
    Truncation truncation;
};

// The least tolerance and eps that double precision can serve. A run that asks for less has this.
inline constexpr double least_tolerance = 1e-15;
// What a person should be told about options that are no mistake: a sentence for each that is below it.
std::vector<std::string> warnings(const Options& options);
// Raises those that are below to it.
void raise_to_least(Options& options);

// One run: options, the parameters' values (in the order of the description), and the start.
struct Run {
    Options options;
    std::vector<double> parameters;
    Vector q, v;
};

}  // namespace achilles
