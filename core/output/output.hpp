// A run for programs and for a person: as JSON and CSV, as the default output and the summary of the command line; a periodic run
// and its branch. No number that is not finite: null, or empty.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "run/trajectory.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

// Which instants of a run its files hold.

// Instants of a run, in the order in which they are asked for; nothing: step ends and events.
using Instants = std::optional<std::vector<double>>;

// So many, at equal distances, from `start` to `end` with both: at least 2.
std::vector<double> equidistant(int count, double start, double end);
// One a line, a constant expression each; an empty line, or what follows #, is none. `name` stands for the file. Throws
// InputError, too, for one that is not in [start, end].
std::vector<double> read_instants(std::string_view text, const std::string& name, double start, double end);

// Step ends and events, an impact as two, before and after it; where steps are long, so many instants between them that a plot
// of them is a curve.
std::vector<Sample> samples_of_curve(const Trajectory& trajectory);
// The states at these instants, after an event that happens there. Instants that the run did not reach have none.
std::vector<Sample> samples_at(const Trajectory& trajectory, const std::vector<double>& times);

struct Branch;
struct Dependence;
struct ErrorEstimate;
struct Orbit;
struct OrbitGuess;
struct OrbitPoint;
struct SystemDescription;

// With instants the array `samples` holds them; with derivatives its events, its end and `derivatives` have them. The estimate
// is that of this run; null: it is made here.
std::string to_json(const Trajectory& trajectory, const Instants& instants = {}, const Dependence* dependence = nullptr,
                    const ErrorEstimate* estimate = nullptr);

struct CsvStyle {
    Instants instants{};       // with them a last column tells the events since the row before
    bool plain_names = false;  // columns called by names that Python can use: theta1_rate for theta1'
    bool units = false;        // a second line with the unit of every column; empty where it is not known
};
std::string to_csv(const Trajectory& trajectory, const CsvStyle& style = {});
// The default output of `simulate`: the result first, then a table of what changed, then the accuracy; summary() has everything.
// At most 15 lines for a run with up to ten changes of contact. Numbers have the digits that certificates and the estimated error
// support. `prove_command` is the command line that proves this run; the output names it.
std::string answer(const Trajectory& trajectory, const ErrorEstimate& estimate, const std::string& prove_command);

// What to type after a run that stopped early: "Try a smaller --tolerance."; empty for a run that reached its end time.
std::string advice(const Outcome& outcome);

// With the digits that the estimated error leaves; null: it is made here.
std::string summary(const Trajectory& trajectory, const ErrorEstimate* estimate = nullptr);
// What the summary says besides where derivatives were asked for.
std::string summary(const Trajectory& trajectory, const Dependence& dependence);
// Phases, events and end, 9 significant digits: what golden tests compare first.
std::string to_text(const Trajectory& trajectory);
// What a person should know of how a run was made, and may not expect: in a word or two for a line about the run, and in full.
struct Remark {
    std::string label, sentence;
};
std::vector<Remark> remarks(const Trajectory& trajectory);
// That the run is not trusted from a time before its end on (error_estimate.hpp); nothing where it is, or where there is no
// estimate.
std::optional<Remark> horizon_remark(const Trajectory& trajectory, const ErrorEstimate& estimate);
// The same before all others.
std::vector<Remark> remarks(const Trajectory& trajectory, const ErrorEstimate& estimate);
// What the Euclidean norms over all coordinates, and over all rates, are in: " m", " (m, rad)"; nothing where no unit is given.
struct NormUnits {
    std::string position, velocity;
};
NormUnits norm_units(const SystemDescription& description);
// What a certificate says, in one sentence.
std::string sentence(const Certificate& certificate, const SystemDescription& description);
// What is estimated of the error at the end, or why nothing is known of it.
std::string sentence(const Trajectory& trajectory, const ErrorEstimate& estimate);
// The energy drift, to two digits; one of rounding alone is "below 1e-14", which is not nothing.
std::string drift_text(double drift);
// The least gap beside the size of the coordinates, to two digits; a negative one of rounding alone is "0 to rounding".
std::string least_gap_text(double gap, double scale);
std::string version();

// A periodic run and its branch, written.

// Numbers in the shortest form that reads back the same double; no wall clock. Without a branch its member is null.
std::string to_json(const Orbit& orbit, const Branch* branch = nullptr);
std::string orbit_text(const Orbit& orbit, const Branch* branch = nullptr);
// The default output: period and stability first, then multipliers, one period, the start, and what the branch meets.
std::string orbit_answer(const Orbit& orbit, const Branch* branch = nullptr);
// Parts of it: "1 (along the motion), -0.7, 0, 0 (the last 2 exactly)", with so many digits; how stable it is, in a sentence; its
// margins.
std::string multipliers_text(const OrbitPoint& point, int digits);
std::string stability_text(const OrbitPoint& point);
std::string margins_text(const OrbitPoint& point);
// What a run may begin from, in what to_json() wrote of an orbit, or of a trajectory: there its end. Throws InputError.
OrbitGuess orbit_guess(const std::string& json, const std::string& file, std::size_t dof);

}  // namespace achilles
