// Everything a run may be told, apart from the system itself. Every option is said once, in the table of all_options():
// the system file, the command line, the explorer, JSON and the notes of pictures iterate it.
#pragma once

#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "state.hpp"

namespace achilles {

enum class Method { dopri5, taylor };
enum class Conditions { paper, sharp };              // theory.md 3 and 6
enum class Reinitialization { euclidean, kinetic };  // R* of Def. 7, and the plastic impact (theory.md 5)

// Landings at the same time whose order matters: Moreau's law for them together, or the run stops.
enum class Simultaneous { moreau, stop };  // theory-gaps.md 2.4

std::string_view to_text(Method);
std::string_view to_text(Conditions);
std::string_view to_text(Reinitialization);
std::string_view to_text(Simultaneous);
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
    double start_time = 0.0;         // s
    double end_time = 10.0;          // s, after the start time: the run stops here at the latest
    double tolerance = 1e-10;        // local error per step, absolute and relative
    Method method = Method::taylor;  // the faster one from any tolerance on that is worth asking for
    int max_impacts = 200000;        // over the run; then Outcome "too many impacts"
    int max_steps = 2000000;         // of the integration, over the run: all are kept; then Outcome "too many steps"
    double memory = 1e9;             // bytes, of what is kept of the run; then Outcome "out of memory"
    Simultaneous simultaneous = Simultaneous::moreau;
    Truncation truncation;

    friend bool operator==(const Options&, const Options&) = default;
};

// A number, positive unless the option takes any sign, a whole number from 1 on, or one of the option's words.
using OptionValue = std::variant<double, int, std::string_view>;
std::string to_text(const OptionValue& value);

// One row of the table: what an option is called wherever a person meets it, and where a run keeps it.
struct Option {
    std::string_view key;         // in a system file, JSON and messages
    std::string_view table;       // of the system file: "run" or "truncation"
    std::string_view flag;        // of the command line
    std::string_view command;     // of the explorer; options that share one are set together, in the table's order
    std::string_view usage = {};  // how that is written
    std::string_view wrong = {};  // what the explorer says of a value that is not allowed, {}
    std::string_view unit = {};
    std::string_view about = {};                   // what --help says
    std::string_view phrase = {};                  // in a line about a run, with the value for {}
    bool quiet = false;                            // such a line has it only where it is not the default
    bool is_tolerance = false;                     // values below least_tolerance are told, and raised to it
    bool any_sign = false;                         // of a number: not only positive ones
    std::span<const std::string_view> words = {};  // where it is one of these
    OptionValue (*get)(const Options&) = nullptr;
    void (*set)(Options&, const OptionValue&) = nullptr;  // an allowed one
};

// In the order of the system file.
std::span<const Option> all_options();
// The option of a key. There must be one.
const Option& option(std::string_view key);
// Those that a command of the explorer sets; none where it is no option's.
std::span<const Option> options_set_by(std::string_view command);
// All of them, by the commands that set them.
std::vector<std::span<const Option>> options_by_command();
// The same for who sets them one after the other: in an order in which the end stays after the start.
std::vector<std::span<const Option>> options_by_command(const Options& from, const Options& to);
// In the order in which a run is told: those named first, the others of [run], what decides about a cut, its bounds.
std::vector<const Option*> told_options(std::initializer_list<std::string_view> first = {});

// Whether an option may have a value by itself: a number finite and, unless it takes any sign, positive, a whole number
// at least 1.
bool allows(const Option& option, const OptionValue& value);
// The option's words in a line about a run; `number` is how fmt writes its number.
std::string phrase(const Option& option, const Options& options, std::string_view number = "{}");

// The least tolerance and eps that double precision can serve. A run that asks for less has this.
inline constexpr double least_tolerance = 1e-15;
// What a person should be told about options that are no mistake: a sentence for each that is below it.
std::vector<std::string> warnings(const Options& options);
// Raises those that are below to it.
void raise_to_least(Options& options);
// What is wrong where the end time is not after the start time.
std::optional<std::string> fault_of_times(const Options& options);
// A sentence for each that is not allowed, and the above: no run can have it.
std::vector<std::string> faults(const Options& options);

// One run: options, the parameters' values (in the order of the description), and the start.
struct Run {
    Options options;
    std::vector<double> parameters;
    Vector q, v;
    // Where it starts.
    State start() const { return {q, v, options.start_time}; }

    // Of runs of one system.
    friend bool operator==(const Run&, const Run&) = default;
};

}  // namespace achilles
