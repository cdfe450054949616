#include "boundary/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "floor/floor.hpp"

namespace achilles::test {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double rounding = 2e-15;  // smallest relative error of a state in doubles

Options options_of(const Question& question, Way way, double tolerance) {
    Options options = question.run.options;
    options.method = way == Way::dopri5 ? Method::dopri5 : Method::taylor;
    options.tolerance = tolerance;
    return options;
}

}  // namespace

std::string to_text(Way way) { return way == Way::taylor ? "taylor" : way == Way::dopri5 ? "dopri5" : "eight"; }

std::string to_text(Verdict verdict) {
    constexpr const char* names[] = {"right",      "undecided", "wrong",  "WRONG BY MORE THAN 10 ERRORS",
                                     "unmeasured", "failed",    "refused"};
    return names[static_cast<std::size_t>(verdict)];
}

std::string repeat(const Question& question, Way way, double tolerance) {
    const SystemDescription& d = question.model->description();
    std::string text =
        fmt::format("{}{}: T = {}, V = {}, gap {}, e = {};", to_text(way), question.in_contact ? ", from contact" : "",
                    d.kinetic.text, d.potential.text, d.constraints[0].gap.text, d.constraints[0].restitution.text);
    for (Eigen::Index i = 0; i < question.run.q.size(); ++i) {
        const std::string& name = d.coordinates[static_cast<std::size_t>(i)].name;
        text += fmt::format(" {} = {:.17g}, {}' = {:.17g},", name, question.run.q[i], name, question.run.v[i]);
    }
    return text + fmt::format(" end {:.17g}, tolerance {}", question.run.options.end_time, tolerance);
}

std::string impossible(const Trajectory& trajectory) {
    double last = 0.0;
    for (const Event& event : trajectory.events) {
        if (event.t < last) return fmt::format("an event at {:.17g} after one at {:.17g}", event.t, last);
        last = event.t;
    }
    if (const std::string below = below_the_floor(trajectory); !below.empty()) return below;
    last = 0.0;
    for (const DenseSegment& piece : trajectory.pieces) {
        if (piece.start < last || piece.end < piece.start)
            return fmt::format("a step from {:.17g} to {:.17g} after one that ends at {:.17g}", piece.start, piece.end,
                               last);
        last = piece.end;
    }
    for (const Phase& phase : trajectory.phases)
        if (phase.last_piece > phase.first_piece && trajectory.pieces[phase.last_piece - 1].end > phase.end)
            return fmt::format("a step ends at {:.17g}, its phase at {:.17g}",
                               trajectory.pieces[phase.last_piece - 1].end, phase.end);
    return {};
}

Judge34::Judge34(const Question& question)
    : question_(question),
      motion_(*question.model, question.run, question.longest_true_step),
      runs_(*question.model, question.run, max_true_events, question.longest_true_step),
      start_(point_of({question.run.q, question.run.v})),
      truth_(true_run(question.run.options.end_time)),
      course_(course_of(truth_, question.run.options.end_time)) {}

TrueExecution Judge34::true_run(double end_time) {
    return question_.in_contact ? runs_.run_from_contact(start_, end_time) : runs_.run(start_, end_time);
}

Trajectory Judge34::own_run(Way way, double tolerance, double end_time) const {
    Run run = question_.run;
    run.options = options_of(question_, way, tolerance);
    run.options.end_time = end_time;
    return way == Way::eight ? by_eight(question_.model, run) : simulate(question_.model, run);
}

Judgement Judge34::judge(Way way, double tolerance) {
    Judgement result;
    const double end_time = question_.run.options.end_time;
    std::optional<Trajectory> run;
    try {
        run = own_run(way, tolerance, end_time);
    } catch (const std::exception& refusal) {  // a batch reports it as a variant
        return {Verdict::refused, 0.0, 0.0, refusal.what(), 0.0};
    }
    const bool undecided = run->outcome.kind == Outcome::Kind::undecided;
    if (!undecided && run->outcome.kind != Outcome::Kind::end_time)
        return {Verdict::failed, 0.0, 0.0, run->outcome.message, run->end_time};
    result.end = run->end_time;
    Course own = course_of(*run, question_.in_contact), truth = course_;
    if (undecided) {
        result.verdict = Verdict::undecided;
        if (!own.timed) return result;
        const double limit = own.end * (1.0 - 1e-3);  // the time of the doubt has an error itself
        own = until(std::move(own), limit);
        truth = until(std::move(truth), limit);
    }
    try {
        compare(own, truth, way, tolerance, result);
    } catch (const std::runtime_error& unknown) {  // from the reference continued from the run's state
        result.verdict = Verdict::unmeasured;
        result.told += fmt::format("; {}", unknown.what());
    }
    if (!result.told.empty() && undecided) result.told += ", then undecided";
    return result;
}

void Judge34::compare(const Course& own, const Course& truth, Way way, double tolerance, Judgement& result) {
    // The error of the first impact is a few local errors, not yet magnified by the motion.
    if (own.timed && !question_.in_contact && !own.stretches[0].impacts.empty() &&
        !truth.stretches[0].impacts.empty()) {
        const double late = own.stretches[0].impacts[0] - truth.stretches[0].impacts[0];
        const double gap = std::abs(late) * static_cast<double>(truth_.events[0].speed);
        if (gap > 1e3 * tolerance + 1e-11) {
            result = {Verdict::blatant, gap, tolerance, {}, result.end};
            result.told = fmt::format("the first impact is off by {:.2e} s, {:.2e} in the gap", late, gap);
            return;
        }
    }
    Impacts same;
    auto difference = first_difference(own, truth, same);
    while (difference) {
        if (difference->own_time && is_its_own(*difference, way, tolerance)) {
            same.insert({difference->stretch, difference->impact});
        } else if (difference->kind == Difference::Kind::zeno_time && own.timed) {
            // The certificate is about the run's own state. So the error of that state is added to the interval.
            Judgement off;
            if (!measure_zeno(*difference, own, way, tolerance, off) || !(off.distance <= off.error)) break;
            if (off.error == infinity) break;
            same.insert({difference->stretch, zeno});
        } else {
            break;
        }
        difference = first_difference(own, truth, same);
    }
    if (!difference) return;
    result.told = fmt::format("{}: {} for {}", to_text(difference->kind), to_text(own), to_text(truth));
    difference = located(*difference, way, tolerance);
    if (difference) {
        result.told += fmt::format(", near t = {:.9g}", difference->t);
        measure(*difference, own, way, tolerance, result);
    } else {
        result.verdict = Verdict::unmeasured;
    }
}

// ---- distance from the boundary ----

struct Judge34::Decisive {
    double t = 0.0;
    Real value;
    bool is_dip = false;
};

Real Judge34::quantity(const Point& point, bool contact) {
    return contact ? Real(-motion_.normal_acceleration(point)) : motion_.contact(point).h;
}

Judge34::Decisive Judge34::at(const Point& from, double time, bool contact, double when) {
    const Reals times{Real(when) - time};
    const Point there = contact ? motion_.contact_at(from, times, 1e-26)[0] : motion_.flight_at(from, times, 1e-26)[0];
    return {when, quantity(there, contact), false};
}

// Local minima of the gap in free flight through the floor, or of the force in contact regardless of its sign. Stops at
// the first minimum after the time `enough`.
std::vector<Judge34::Decisive> Judge34::dips(const Point& from, double time, bool contact, double enough) {
    // s. The search continues this long after a minimum, so as not to find it again. On a flat floor rounding causes
    // infinitely many minima.
    double past = 1e-7;
    std::vector<Decisive> result;
    Flight flight{from, time, 0};
    const double end = question_.run.options.end_time;
    while (result.size() < 100 && (result.empty() || result.back().t < enough)) {
        const Real left = end - flight.time;
        if (!(left > past)) break;
        const bool found = contact ? motion_.stay_to_dip(flight, left, 1e-26)
                                   : motion_.fly_to_dip(flight, left, static_cast<double>(left), 1e-26);
        if (!found) break;
        result.push_back({static_cast<double>(flight.time), quantity(flight.point, contact), true});
        const Reals next{Real(past)};
        flight.point = contact ? motion_.contact_at(flight.point, next, 1e-26)[0]
                               : motion_.flight_at(flight.point, next, 1e-26)[0];
        flight.time += past;
        past = std::min(2.0 * past, 1e-3);
    }
    return result;
}

// A batch gives only the number of impacts. The time of one is found by runs that end earlier.
std::optional<Difference> Judge34::located(Difference difference, Way way, double tolerance) const {
    if (difference.t >= 0.0) return difference;
    const Stretch& truth = course_.stretches[difference.stretch];
    const auto count_by = [&](double time) -> std::size_t {
        const Course course = course_of(own_run(way, tolerance, time), question_.in_contact);
        return difference.stretch < course.stretches.size() ? course.stretches[difference.stretch].count : 0;
    };
    const auto end_of = [&](std::size_t i) {
        if (i < truth.impacts.size()) return truth.impacts[i];
        return truth.zeno_high > 0.0 ? truth.zeno_high : question_.run.options.end_time;
    };
    for (std::size_t i = 0; i <= truth.impacts.size(); ++i) {
        difference.last = i > 0 ? truth.impacts[i - 1] : truth.start;
        difference.impact = i;
        double low = difference.last + 1e-3 * (end_of(i) - difference.last), high = end_of(i);
        if (difference.kind == Difference::Kind::missed_impact) {
            difference.t = high;
            if (i == truth.impacts.size() || count_by(high + 0.5 * (end_of(i + 1) - high)) < i + 1) return difference;
            continue;
        }
        if (count_by(high - 1e-3 * (high - low)) <= i) continue;
        for (int round = 0; round < 30; ++round) {
            const double middle = 0.5 * (low + high);
            (count_by(middle) > i ? high : low) = middle;
        }
        difference.t = high;
        return difference;
    }
    return std::nullopt;
}

// Whether an impact at a different time is the same impact: the reference has it at that time too, if it continues from
// the run's own state.
bool Judge34::is_its_own(const Difference& difference, Way way, double tolerance) {
    const double before = difference.last + 0.9 * (difference.t - difference.last);
    if (!(before > 0.0)) return false;
    const Trajectory own = own_run(way, tolerance, before);
    if (own.outcome.kind != Outcome::Kind::end_time || own.end_phase != Phase::Kind::hybrid) return false;
    const double t = *difference.own_time, truth = course_.stretches[difference.stretch].impacts[difference.impact];
    Flight flight{point_of(own.end), before, 0};
    const double longest = 2.0 * std::abs(t - before);
    return motion_.fly(flight, longest, longest, 1e-26) &&
           std::abs(static_cast<double>(flight.time) - t) < 0.1 * std::abs(truth - t);
}

void Judge34::measure(const Difference& difference, const Course& own, Way way, double tolerance,
                      Judgement& judgement) {
    using Kind = Difference::Kind;
    judgement.verdict = Verdict::blatant;
    judgement.error = rounding;
    bool measured = true;
    if (difference.t == 0.0) {
        judgement.distance = std::abs(static_cast<double>(quantity(start_, true)));
    } else if (difference.kind == Kind::zeno_time) {
        measured = measure_zeno(difference, own, way, tolerance, judgement);
    } else if (difference.kind == Kind::no_zeno) {
        measured = measure_settling(difference, way, tolerance, judgement);
    } else {
        for (const double share : {0.5, 0.9})
            measured = measured && measure_at(difference.last + share * (difference.t - difference.last), difference,
                                              way, tolerance, judgement);
    }
    if (!measured) {
        judgement.verdict = Verdict::unmeasured;
        return;
    }
    judgement.told += fmt::format("; {:.2e} from the decision, error {:.2e}", judgement.distance, judgement.error);
    if (judgement.distance <= 10.0 * judgement.error) judgement.verdict = Verdict::wrong;
}

// Compares the Zeno time of the reference with that of the reference continued from the run's own state before the cut.
bool Judge34::measure_zeno(const Difference& difference, const Course& own, Way way, double tolerance,
                           Judgement& judgement) {
    const Stretch &claimed = own.stretches[difference.stretch], &truth = course_.stretches[difference.stretch];
    // Without recorded events the cut is not known, but it is not before the first impact.
    const double before_cut = own.timed || truth.impacts.empty() ? difference.t : truth.impacts[0];
    const double before = difference.last + 0.9 * (before_cut - difference.last);
    const Trajectory its = own_run(way, tolerance, before);
    if (its.outcome.kind != Outcome::Kind::end_time) return false;
    const bool ended = difference.stretch + 1 < own.stretches.size();
    const double estimate = ended ? own.stretches[difference.stretch + 1].start : own.end;
    const bool interval = ended && own.timed;
    const double low = interval ? claimed.zeno_low : estimate, high = interval ? claimed.zeno_high : estimate;
    judgement.distance = std::max(low - truth.zeno_low, truth.zeno_low - high);
    // The cut is at the end of a step, and no certificate covers the error of that step. Its effect on the time
    // increases with decreasing impact speed.
    double speed = 1.0;
    for (const TrueEvent& event : truth_.events)
        if (event.kind != Event::Kind::release && event.t < difference.t + 1e-6)
            speed = static_cast<double>(event.speed);
    judgement.error = (rounding + tolerance) / std::min(1.0, speed);
    const TrueExecution rest = runs_.run(point_of(its.end), 2.0 * (truth.zeno_low - before));
    double off = infinity;  // if no Zeno point follows from its state
    for (const TrueEvent& event : rest.events)
        if (event.kind == Event::Kind::zeno)
            off = std::min(off, std::abs(before + static_cast<double>(event.t) - truth.zeno_low));
    judgement.error = std::max(judgement.error, off);
    return true;
}

// Continues the reference from its own state and from the run's, both at time `before`, to the decisive minimum.
bool Judge34::measure_at(double before, const Difference& difference, Way way, double tolerance, Judgement& judgement) {
    using Kind = Difference::Kind;
    const bool contact = difference.kind == Kind::missed_release || difference.kind == Kind::extra_release;
    const bool missed = difference.kind == Kind::missed_impact || difference.kind == Kind::missed_release;
    const TrueExecution truth = true_run(before);
    const Trajectory own = own_run(way, tolerance, before);
    if (own.outcome.kind != Outcome::Kind::end_time || truth.end_phase != own.end_phase ||
        (truth.end_phase == Phase::Kind::constrained) != contact)
        return false;
    // For a missed event take the first minimum after it, for an extra event a minimum near it.
    const auto near = [](const std::vector<Decisive>& all, double t, double reach) {
        std::optional<Decisive> best;
        for (const Decisive& dip : all)
            if (std::abs(dip.t - t) <= (best ? std::abs(best->t - t) : reach)) best = dip;
        return best;
    };
    const double t = difference.t, reach = 2.0 * (t - before);
    const auto true_dips = dips(truth.end, before, contact, missed ? t : t + reach);
    std::optional<Decisive> decisive;
    if (!missed) {
        decisive = near(true_dips, t, reach);
    } else if (!true_dips.empty() && true_dips.back().t >= t) {
        decisive = true_dips.back();
    }
    if (!decisive) decisive = at(truth.end, before, contact, missed ? question_.run.options.end_time : t);
    const Point start = point_of(own.end);
    std::optional<Decisive> its;
    if (decisive->is_dip)
        its = near(dips(start, before, contact, decisive->t + reach), decisive->t, 0.5 * (decisive->t - before));
    if (!its) its = at(start, before, contact, decisive->t);
    // Without a minimum the end of the run is decisive.
    const double end_time = question_.run.options.end_time;
    if (missed && !decisive->is_dip) {
        const Trajectory whole = own_run(way, tolerance, end_time);
        const Real value = quantity(point_of(whole.end), contact);
        if (whole.end_time == end_time)
            judgement.error = std::max(judgement.error, std::abs(static_cast<double>(value - decisive->value)));
    }
    judgement.distance = std::abs(static_cast<double>(decisive->value));
    judgement.error = std::max(judgement.error, std::abs(static_cast<double>(its->value - decisive->value)));
    return true;
}

// The run came to rest, but the reference continues to bounce. Decisive is the force at its first impact without a
// contact force.
bool Judge34::measure_settling(const Difference& difference, Way way, double tolerance, Judgement& judgement) {
    for (const TrueEvent& event : truth_.events) {
        if (event.kind != Event::Kind::impact || event.t < difference.last) continue;
        const Real force = quantity(motion_.restart(event.point, Reinitialization::kinetic), true);
        if (force > 0) continue;
        const Trajectory own = own_run(way, tolerance, static_cast<double>(event.t));
        const Point there = motion_.restart(point_of(own.end), Reinitialization::kinetic);
        judgement.distance = std::abs(static_cast<double>(force));
        judgement.error = std::max(judgement.error, std::abs(static_cast<double>(quantity(there, true) - force)));
        return true;
    }
    return false;
}

}  // namespace achilles::test
