// Output of a run as JSON and CSV, and as the text of the command line; output of a periodic orbit and its branch.
// Numbers that are not finite are written as null or left empty.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "run/trajectory.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

// Instants of output (s), in the requested order; nullopt: step ends and events.
using Instants = std::optional<std::vector<double>>;

// `count` >= 2 equidistant instants from `start` to `end`, both included.
std::vector<double> equidistant(int count, double start, double end);
// Reads one instant per line, a constant expression. Empty lines and comments after # are skipped. `name` is the file's
// name. Throws InputError for an invalid line, or an instant outside [start, end].
std::vector<double> read_instants(std::string_view text, const std::string& name, double start, double end);

// Samples at step ends and events; an impact has two, before and after it. Long steps have additional samples, so that
// a plot shows a smooth curve.
std::vector<Sample> samples_of_curve(const Trajectory& trajectory);
// Samples at these instants, after any event at that time. Instants beyond the end of the run are left out.
std::vector<Sample> samples_at(const Trajectory& trajectory, const std::vector<double>& times);

struct Branch;
struct Dependence;
struct ErrorEstimate;
struct Orbit;
struct OrbitGuess;
struct OrbitPoint;
struct SystemDescription;

// With instants, the array `samples` has the states there. With `dependence`, the events, the end and `derivatives`
// have derivatives. `estimate` is the error estimate of this run; if null, it is computed here.
std::string to_json(const Trajectory& trajectory, const Instants& instants = {}, const Dependence* dependence = nullptr,
                    const ErrorEstimate* estimate = nullptr);

struct CsvStyle {
    Instants instants{};       // adds a last column with the events since the previous row
    bool plain_names = false;  // column names valid in Python: theta1_rate for theta1'
    bool units = false;        // a second line with the unit of each column; empty if unknown
};
std::string to_csv(const Trajectory& trajectory, const CsvStyle& style = {});
// The default output of `simulate`: the result, a table of changes, then the accuracy; summary() has all details. At
// most 15 lines for a run with up to ten changes of contact. Numbers have the digits that certificates and the
// estimated error support. `prove_command`, the command line that proves this run, is printed.
std::string answer(const Trajectory& trajectory, const ErrorEstimate& estimate, const std::string& prove_command);

// Advice after a run that stopped early: "Try a smaller --tolerance."; empty if the run reached its end time.
std::string advice(const Trajectory& trajectory);

// All details, with the digits that the estimated error supports; if `estimate` is null, it is computed here.
std::string summary(const Trajectory& trajectory, const ErrorEstimate* estimate = nullptr);
// The part of the summary with derivatives.
std::string summary(const Trajectory& trajectory, const Dependence& dependence);
// Phases, events and end with 9 significant digits, for golden tests.
std::string to_text(const Trajectory& trajectory);
// Something unexpected about how a run was computed: a label of a word or two, and a sentence.
struct RunWarning {
    std::string label, sentence;
};
std::vector<RunWarning> remarks(const Trajectory& trajectory);
// The remark that the run is unreliable from a time before its end on (error_estimate.hpp); nullopt if it is reliable
// to the end, or if there is no estimate.
std::optional<RunWarning> horizon_remark(const Trajectory& trajectory, const ErrorEstimate& estimate);
// All remarks, that of the horizon first.
std::vector<RunWarning> remarks(const Trajectory& trajectory, const ErrorEstimate& estimate);
// Units of the Euclidean norms over all coordinates and over all rates: " m", " (m, rad)"; empty if no unit is given.
struct NormUnits {
    std::string position, velocity;
};
NormUnits norm_units(const SystemDescription& description);
// A certificate in one sentence.
std::string sentence(const Certificate& certificate, const SystemDescription& description);
// The error estimate at the end of the run, or the reason why there is none.
std::string sentence(const Trajectory& trajectory, const ErrorEstimate& estimate);
// The energy drift to two digits; "below 1e-14" if it is only rounding.
std::string drift_text(double drift);
// The minimum gap to two digits; "0 to rounding" if it is negative only by rounding, relative to the size of the
// coordinates.
std::string least_gap_text(double gap, double scale);
std::string version();

// A periodic orbit as JSON, without wall-clock times. Numbers are in the shortest form that is read back as the same
// double. Without a branch its member is null.
std::string to_json(const Orbit& orbit, const Branch* branch = nullptr);
std::string orbit_text(const Orbit& orbit, const Branch* branch = nullptr);
// The default output of `orbit`: period and stability first, then multipliers, one period, the start, and the events of
// the branch.
std::string orbit_answer(const Orbit& orbit, const Branch* branch = nullptr);
// Parts of that: multipliers as "1 (along the motion), -0.7, 0, 0 (the last 2 exactly)" with this number of digits;
// stability in a sentence; margins.
std::string multipliers_text(const OrbitPoint& point, int digits);
std::string stability_text(const OrbitPoint& point);
std::string margins_text(const OrbitPoint& point);
// An initial guess from the JSON of an orbit, or from the final state in that of a trajectory. Throws InputError.
OrbitGuess orbit_guess(const std::string& json, const std::string& file, std::size_t dof);

}  // namespace achilles
