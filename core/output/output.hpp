// A trajectory as JSON and CSV, and as a summary for a person. No number that is not finite:
// null, or empty.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "output/sampling.hpp"
#include "run/trajectory.hpp"

namespace achilles {

struct ErrorEstimate;
struct SystemDescription;
struct Dependence;

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

}  // namespace achilles
