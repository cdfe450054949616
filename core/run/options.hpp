// All settings of a run other than the system. Each option is defined once, in the table of all_options(). The system
// file, the command line, the explorer, JSON and the notes in pictures iterate over this table.
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

// Impacts at the same time whose order matters: resolve them together by Moreau's law, or stop the run.
enum class Simultaneous { moreau, stop };  // theory-gaps.md 2.4

// What happens at an impact with friction that would gain energy: the restitution is reduced until it does not, or the
// run stops.
enum class EnergyGain { cap, stop };  // theory-friction.md 3

std::string_view to_text(Method);
std::string_view to_text(Conditions);
std::string_view to_text(Reinitialization);
std::string_view to_text(Simultaneous);
std::string_view to_text(EnergyGain);
std::optional<Method> method_from(std::string_view);
std::optional<Conditions> conditions_from(std::string_view);
std::optional<Reinitialization> reinitialization_from(std::string_view);

// Criterion and tolerances for truncating an impact sequence. The tolerances limit the certified errors.
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
    Method method = Method::taylor;  // the fastest method at all practical tolerances
    int max_impacts = 200000;        // in the run; beyond it, Outcome "too many impacts"
    int max_steps = 2000000;         // of the integration, all stored; beyond it, Outcome "too many steps"
    double memory = 1e9;             // bytes for the stored trajectory; beyond it, Outcome "out of memory"
    Simultaneous simultaneous = Simultaneous::moreau;
    EnergyGain energy_gain = EnergyGain::cap;
    int max_events = 200000;  // with friction: sticks, slips and reversals; beyond it, Outcome "too many events"
    Truncation truncation;

    friend bool operator==(const Options&, const Options&) = default;
};

// A number (positive unless the option takes any sign), an integer of at least 1, or one of the option's words.
using OptionValue = std::variant<double, int, std::string_view>;
std::string to_text(const OptionValue& value);

// One row of the table: the names of an option in each interface, and access to its value.
struct Option {
    std::string_view key;              // in system files, JSON and messages
    std::string_view table;            // of the system file: "run" or "truncation"
    std::string_view flag;             // on the command line
    std::string_view command;          // of the explorer; options that share one are set together, in table order
    std::string_view usage = {};       // how to write that command, for messages
    std::string_view error_text = {};  // explorer's message for an invalid value, which replaces {}
    std::string_view unit = {};
    std::string_view help = {};                    // help text
    std::string_view summary_text = {};            // in a line about a run, with {} for the value
    bool omit_if_default = false;                  // such lines omit it if it has the default value
    bool is_of_friction = false;                   // only friction uses it; data files omit its default value
    bool is_tolerance = false;                     // values below min_tolerance cause a warning and are raised to it
    bool any_sign = false;                         // numbers only: negative values and 0 are allowed
    std::span<const std::string_view> words = {};  // allowed words; empty for numbers
    OptionValue (*get)(const Options&) = nullptr;
    void (*set)(Options&, const OptionValue&) = nullptr;  // requires an allowed value
};

// All options in the order of the system file.
std::span<const Option> all_options();
// The option with this key, which must exist.
const Option& option(std::string_view key);
// The options that a command of the explorer sets; empty if it sets none.
std::span<const Option> options_set_by(std::string_view command);
// All options, grouped by command.
std::vector<std::span<const Option>> options_by_command();
// The same, in an order in which the end time stays after the start time if the groups are set one after the other.
std::vector<std::span<const Option>> options_by_command(const Options& from, const Options& to);
// All options in the order of a report: those of `first`, the other options of [run], the criteria of [truncation], its
// tolerances.
std::vector<const Option*> options_in_report_order(std::initializer_list<std::string_view> first = {});

// True if data files omit the option: only friction uses it, and it has its default value.
bool is_left_out(const Option& option, const Options& options);
// True if the option may have this value: a number must be finite and, unless it takes any sign, positive; an integer
// at least 1; a word one of the option's words.
bool is_valid_value(const Option& option, const OptionValue& value);
// The option in a line about a run; `number` is the format of its number.
std::string summary_text(const Option& option, const Options& options, std::string_view number = "{}");

// Minimum of tolerance and eps that double precision supports. Smaller values are raised to it.
inline constexpr double min_tolerance = 1e-15;
// Warnings about allowed but questionable values: one sentence for each tolerance below the minimum.
std::vector<std::string> warnings(const Options& options);
// Raises tolerances below the minimum to it.
void clamp_tolerances(Options& options);
// The error message if the end time is not after the start time.
std::optional<std::string> end_time_error(const Options& options);
// Error messages for values that are not allowed, including end_time.
std::vector<std::string> validation_errors(const Options& options);

// One run: options, parameter values (in the order of the description), and initial state.
struct Run {
    Options options;
    std::vector<double> parameters;
    Vector q, v;
    State start() const { return {q, v, options.start_time}; }

    // Compares runs of the same system.
    friend bool operator==(const Run&, const Run&) = default;
};

}  // namespace achilles
