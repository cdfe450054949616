// Many runs of one system as one value: what is varied, and what is asked of each run. It has a text of one line, which is
// what a person types.
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

// A line of flags, each with a value, as on a command line: what a journal has of a study.

struct Flag {
    std::string name, value;  // "--over", "e=0:0.95:200"
};

// What stands in double quotes is one value. Throws InputError, about `whose` or the flag.
std::vector<Flag> read_flags(std::string_view text, const std::string& whose);
// As a shell reads it, too.
std::string to_text(const std::vector<Flag>& flags);

// More points than this are more than anybody can keep.
inline constexpr std::uint64_t most_points = 1'000'000'000;

// One quantity that is varied: a parameter, a coordinate x or its rate x' at the start, or an option that is a number, by
// its flag without the dashes (end, tolerance, eps).
struct SweepAxis {
    std::string name;
    double low = 0.0, high = 1.0;
    std::uint64_t count = 0;  // of values from low to high, both included; 0: they are drawn at random
    bool logarithmic = false;

    // Value i of `count`: low + (high - low) i/(count - 1), or the same of logarithms; the ends are exact.
    double value(std::uint64_t i) const;
    // The value so far on the way from low to high, 0 <= share < 1.
    double between(double share) const;

    friend bool operator==(const SweepAxis&, const SweepAxis&) = default;
};

// So many points of the box that the axes span, each coordinate uniform (or its logarithm) and independent of the others.
struct RandomPoints {
    std::uint64_t count = 0, seed = 1;
    friend bool operator==(const RandomPoints&, const RandomPoints&) = default;
};

// Where along a run it is asked, in place of its end: at every such event, or where an expression passes zero upwards.
struct Section {
    std::optional<Event::Kind> event = Event::Kind::impact;  // nothing: at the zeros of the expression
    std::string expression;
    std::optional<double> after;  // s: not before this time
    friend bool operator==(const Section&, const Section&) = default;
};

struct Sweep {
    Run base;                            // what is not varied; what an axis varies is as in the file
    std::vector<SweepAxis> axes;         // the first is slowest
    std::optional<RandomPoints> random;  // else a grid
    std::vector<std::string> prints;     // expressions over the end of a run, or a section of it (see RunMeasures)
    std::optional<Section> at;

    // Of its points.
    std::uint64_t count() const;
    // What an axis is at point i: the same bits wherever it is asked.
    double value(std::size_t axis, std::uint64_t i) const;

    friend bool operator==(const Sweep&, const Sweep&) = default;
};

// A sweep as a person asks for it: the texts behind --over, --print, --at, --after, --random and --seed.
struct AskedSweep {
    std::vector<std::string> over{}, prints{};
    std::optional<std::string> at{}, after{}, random{}, seed{};
    std::vector<std::string>
        fixed{};  // names that have one value by --set, and flags of options: no axis may be one of them
};
// Throws InputError where it cannot be. Whether the expressions mean something, and a section comes before the end, is for
// RunMeasures to say.
Sweep make_sweep(const AskedSweep& asked, const Run& base, const SystemDescription& description);

// "--over e=0:0.95:200 --print "zeno_time(2)"", with --set and the options where the base is not what the description says:
// a sweep, but for the system. A shell reads it, too.
std::string to_text(const Sweep& sweep, const SystemDescription& description);
// The sweep of such a text. Throws InputError.
Sweep read_sweep(std::string_view text, const SystemDescription& description);

// The runs of a sweep.
class SweepPoints {
 public:
    SweepPoints(const Sweep& sweep, const SystemDescription& description);
    // That of point i.
    Run run(std::uint64_t i) const;

 private:
    const Sweep* sweep_;
    struct Place {
        enum class Kind { parameter, coordinate, rate, option };
        Kind kind;
        std::size_t index;
        std::vector<const Option*> options;
    };
    std::vector<Place> places_;
};

// A run in which everything that an axis varies is as in `file`.
Run without_axes(Run run, const std::vector<SweepAxis>& axes, const Run& file, const SystemDescription& description);

// The options that a name stands for on an axis; none where it stands for none.
std::vector<const Option*> options_of_axis(std::string_view name);
// "" where it is not known.
std::string unit_of_axis(const SystemDescription& description, std::string_view name);

}  // namespace achilles
