// A sweep: many runs of one system, defined by what is varied and what is printed. It has a one-line text form, as
// typed by users.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../run/trajectory.hpp"
#include "../system/description.hpp"

namespace achilles {

// ---- a line of flags with values, as on a command line; the form of a study in a journal ----

struct Flag {
    std::string name, value;  // "--over", "e=0:0.95:200"
};

// Text in double quotes is a single value. Throws InputError, which names `whose` or the flag.
std::vector<Flag> read_flags(std::string_view text, const std::string& whose);
// Can also be parsed by a shell.
std::string to_text(const std::vector<Flag>& flags);

// Upper limit on the number of points in one sweep.
inline constexpr std::uint64_t max_sweep_points = 1'000'000'000;

// A varied quantity: a parameter, an initial coordinate x or initial rate x', or a numeric option, by its flag without
// the dashes (end, tolerance, eps).
struct SweepAxis {
    std::string name;
    double low = 0.0, high = 1.0;
    std::uint64_t count = 0;  // number of values from low to high, both included; 0: random
    bool logarithmic = false;

    // Value i of `count`: low + (high - low) i/(count - 1), or the same with logarithms; the ends are exact.
    double value(std::uint64_t i) const;
    // The value at this fraction of the way from low to high, 0 <= share < 1.
    double between(double share) const;

    friend bool operator==(const SweepAxis&, const SweepAxis&) = default;
};

// Random points of the box that the axes span; each coordinate (or its logarithm) is uniform and independent.
struct RandomPoints {
    std::uint64_t count = 0, seed = 1;
    friend bool operator==(const RandomPoints&, const RandomPoints&) = default;
};

// Where along a run the prints are evaluated instead of at its end: at every event of a kind, or at upward zero
// crossings of an expression.
struct Section {
    std::optional<Event::Kind> event = Event::Kind::impact;  // empty: zero crossings of the expression
    std::string expression;
    std::optional<double> after;  // s: no earlier
    friend bool operator==(const Section&, const Section&) = default;
};

struct SweepSpec {
    Run base;                            // everything else; values that an axis varies are those of the file
    std::vector<SweepAxis> axes;         // the first varies slowest
    std::optional<RandomPoints> random;  // otherwise a grid
    std::vector<std::string> prints;     // expressions at the end of a run or at a section (see RunMeasures)
    std::optional<Section> at;

    // The number of points.
    std::uint64_t count() const;
    // Value of an axis at point i. Bit-identical wherever it is evaluated.
    double value(std::size_t axis, std::uint64_t i) const;

    friend bool operator==(const SweepSpec&, const SweepSpec&) = default;
};

// The unparsed options of a sweep: the values of --over, --print, --at, --after, --random and --seed.
struct SweepOptions {
    std::vector<std::string> over{}, prints{};
    std::optional<std::string> at{}, after{}, random{}, seed{};
    std::vector<std::string> fixed{};  // names set by --set, and flags of options; none of them may be an axis
};
// Throws InputError if the options are invalid. Whether the expressions are valid, and a section begins before the end,
// is checked by RunMeasures.
SweepSpec make_sweep(const SweepOptions& typed, const Run& base, const SystemDescription& description);

// The sweep as text, without the system: "--over e=0:0.95:200 --print "zeno_time(2)"", with --set and options for
// differences between the base and the description. A shell can parse it, too.
std::string to_text(const SweepSpec& sweep, const SystemDescription& description);
// Parses such a text. Throws InputError.
SweepSpec read_sweep(std::string_view text, const SystemDescription& description);

// The runs of a sweep.
class SweepPoints {
 public:
    SweepPoints(const SweepSpec& sweep, const SystemDescription& description);
    // The run of point i.
    Run run(std::uint64_t i) const;

 private:
    const SweepSpec* sweep_;
    struct AxisTarget {
        enum class Kind { parameter, coordinate, rate, option };
        Kind kind;
        std::size_t index;
        std::vector<const Option*> options;
    };
    std::vector<AxisTarget> places_;
};

// A copy of the run with everything that an axis varies set as in `file`.
Run without_axes(Run run, const std::vector<SweepAxis>& axes, const Run& file, const SystemDescription& description);

// The options that an axis name stands for; empty if there are none.
std::vector<const Option*> options_of_axis(std::string_view name);
// "" if unknown.
std::string unit_of_axis(const SystemDescription& description, std::string_view name);

}  // namespace achilles
