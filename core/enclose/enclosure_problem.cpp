// Claims: the numbers of a run as boxes, splitting a box into parts and joining their results, and checks.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "enclose/enclosure.hpp"
#include "expression/expression.hpp"
#include "model/scopes.hpp"
#include "number/float_environment.hpp"
#include "system/input_error.hpp"

namespace achilles {

EnclosureProblem problem_of(const Run& run) {
    EnclosureProblem claim;
    claim.run = run;
    claim.q.assign(run.q.begin(), run.q.end());
    claim.v.assign(run.v.begin(), run.v.end());
    claim.parameters.assign(run.parameters.begin(), run.parameters.end());
    return claim;
}

Interval interval_of_decimal(double x) {
    const FloatEnvironmentGuard ground;
    Graph graph;
    const Constant shortest = graph.constant(graph.decimal(fmt::format("{}", std::abs(x))).id());
    if (shortest.low == shortest.high) return {x};
    const double around = 4.0 * rounding::epsilon * std::abs(x);
    return Interval(x) + Interval(-around, around);
}

EnclosureProblem problem_from_decimals(const Run& run) {
    EnclosureProblem claim = problem_of(run);
    for (Intervals* box : {&claim.q, &claim.v, &claim.parameters})
        for (Interval& entry : *box) entry = interval_of_decimal(mid(entry));
    return claim;
}

void inflate(EnclosureProblem& claim, double half) {
    if (half == 0.0) return;  // no change, not even by rounding
    const FloatEnvironmentGuard ground;
    const Interval off = Interval(-1.0, 1.0) * interval_of_decimal(half);
    for (Intervals* box : {&claim.q, &claim.v})
        for (Interval& entry : *box) entry += off;
}

namespace {

// The sides of a claim that are wide enough to be split.
std::vector<Interval*> sides_of(EnclosureProblem& claim) {
    std::vector<Interval*> sides;
    for (Intervals* box : {&claim.q, &claim.v, &claim.parameters})
        for (Interval& entry : *box)
            if (width(entry) > 0x1p-47 * mag(entry)) sides.push_back(&entry);
    return sides;
}

EnclosureProblem part_of(const EnclosureProblem& claim, std::size_t which, int parts) {
    EnclosureProblem result = claim;
    for (Interval* side : sides_of(result)) {
        const auto k = static_cast<double>(which % static_cast<std::size_t>(parts));
        which /= static_cast<std::size_t>(parts);
        const auto at = [&, whole = *side](double i) {  // neighboring parts share an end exactly
            if (i == 0.0) return whole.lo();
            if (i == parts) return whole.hi();
            return std::clamp(whole.lo() + i / parts * (whole.hi() - whole.lo()), whole.lo(), whole.hi());
        };
        *side = Interval(at(k), at(k + 1.0));
    }
    return result;
}

void join(Intervals& a, const Intervals& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = hull(a[i], b[i]);
}

void join(EnclosedState& a, const EnclosedState& b) {
    join(a.q, b.q);
    join(a.v, b.v);
}

bool is_same(const EnclosedEvent& a, const EnclosedEvent& b) {
    return a.kind == b.kind && a.contact == b.contact && a.mode == b.mode && a.opened == b.opened;
}

void join(EnclosedEvent& a, const EnclosedEvent& b) {
    a.t = hull(a.t, b.t);
    join(a.q, b.q);
    join(a.v_before, b.v_before);
    join(a.v_after, b.v_after);
    a.impacts = std::min(a.impacts, b.impacts);
    a.most_impacts = std::max(a.most_impacts, b.most_impacts);
}

// The index of `zeno` in the events of another part, if from `at` on only impacts of that bouncing precede it;
// otherwise `at`. This part has truncated the bouncing earlier, and the members of both parts have these impacts.
std::size_t skip_impacts_before(const EnclosedEvent& zeno, const std::vector<EnclosedEvent>& events, std::size_t at) {
    if (!zeno.is_zeno()) return at;
    std::size_t next = at;
    while (next < events.size() && events[next].is_impact() && events[next].contact == zeno.contact &&
           events[next].opened.empty())
        ++next;
    return next < events.size() && is_same(events[next], zeno) ? next : at;
}

// Keeps the common first events of two parts. They differ if one of them has a further event before the time until
// which the other is proved.
void join_events(Enclosure& a, const Enclosure& b) {
    std::vector<EnclosedEvent> common;
    std::size_t i = 0, k = 0;
    for (; i < a.events.size() && k < b.events.size(); ++i, ++k) {
        i = skip_impacts_before(b.events[k], a.events, i);
        k = skip_impacts_before(a.events[i], b.events, k);
        if (!is_same(a.events[i], b.events[k])) break;
        join(common.emplace_back(a.events[i]), b.events[k]);
    }
    const auto goes_on = [](const Enclosure& part, std::size_t next, const Enclosure& other) {
        return next < part.events.size() && part.events[next].t.lo() < other.proved_until;
    };
    if (goes_on(a, i, b) || goes_on(b, k, a)) a.events_differ = true;
    a.events = std::move(common);
}

// Joins the results of two parts into a.
void join(Enclosure& a, const Enclosure& b) {
    join_events(a, b);
    std::vector<EnclosedState> samples;
    for (EnclosedState& x : a.samples)
        for (const EnclosedState& y : b.samples)
            if (x.t == y.t) {
                join(x, y);
                samples.push_back(x);
            }
    a.samples = samples;
    if (a.end && b.end) join(*a.end, *b.end);
    if (!b.end) a.end.reset();
    if (b.outcome.kind != Enclosure::ProofOutcome::Kind::end_time &&
        (a.outcome.kind == Enclosure::ProofOutcome::Kind::end_time || b.proved_until < a.proved_until))
        a.outcome = b.outcome;
    a.proved_until = std::min(a.proved_until, b.proved_until);
    a.statistics.steps += b.statistics.steps;
    a.statistics.impacts += b.statistics.impacts;
}

}  // namespace

Enclosure prove_in_parts(const std::shared_ptr<const Model>& model, const EnclosureProblem& claim, int parts,
                         ProofMonitor* watch) {
    EnclosureProblem whole = claim;
    const double count = std::pow(parts, static_cast<double>(sides_of(whole).size()));
    if (!(parts >= 1 && count <= 1e6))
        throw InputError(fmt::format("--split {}", parts), {},
                         fmt::format("this divides the initial box into {:.0f} parts, a factor {} for each of its {} "
                                     "sides; 1 to 1000000 parts are possible",
                                     count, parts, sides_of(whole).size()));
    const auto clock = std::chrono::steady_clock::now();
    std::vector<Enclosure> all(static_cast<std::size_t>(count));
    tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
        ProofMonitor of_part{watch != nullptr ? watch->stop : std::stop_token{}};
        all[i] = prove(model, part_of(claim, i, parts), &of_part);
    });
    Enclosure result = all.front();
    for (std::size_t i = 1; i < all.size(); ++i) join(result, all[i]);
    if (watch != nullptr) watch->time = result.proved_until;
    result.statistics.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
    return result;
}

Interval restitution_over(const Model& model, const EnclosureProblem& claim, std::size_t contact) {
    const Interval e = model.restitution(claim.parameters, contact);
    const SystemDescription& description = model.description();
    if (const auto mistake = mistake_in(description.constraints[contact].restitution, e))
        throw description.error(mistake->at, mistake->message, mistake->hint);
    return e;
}

void check(const Model& model, const EnclosureProblem& claim) {
    const FloatEnvironmentGuard ground;
    const SystemDescription& description = model.description();
    if (const auto feature = first_unproved(description))
        throw description.error(feature->at, fmt::format("a proof does not cover {}", feature->what),
                                "achilles simulate runs this system, with an estimate of its error");
    std::vector<InputError> errors;
    for (std::size_t contact = 0; contact < model.contacts(); ++contact) {
        const ConstraintDescription& constraint = description.constraints[contact];
        try {
            restitution_over(model, claim, contact);
        } catch (const InputError& mistake) {
            errors.push_back(mistake);
        }
        Evaluator<Interval> gap(model.gap(contact));
        for (std::size_t i = 0; i < claim.parameters.size(); ++i)
            gap.input(model.layout().parameter(i)) = claim.parameters[i];
        // Checks the corners of the box. A corner where the gap is negative for all parameters is not a valid start.
        gap.fix();
        gap.clock() = Interval(claim.run.options.start_time);
        const std::size_t n = claim.q.size();
        for (std::size_t corner = 0; corner < std::size_t{1} << n; ++corner) {
            std::string where;
            double size = 0.0;
            for (std::size_t i = 0; i < n; ++i) {
                const double q = corner >> i & 1u ? claim.q[i].hi() : claim.q[i].lo();
                gap.input(i) = Interval(q);
                gap.input(n + i) = claim.v[i];
                size = std::max(size, std::abs(q));
                where += fmt::format("{}{} = {}", i > 0 ? ", " : "", description.coordinates[i].name, q);
            }
            gap.run();
            if (!(gap.output(0).hi() < -0x1p-44 * std::max(1.0, size))) continue;
            errors.push_back(
                description.error(constraint.gap.at,
                                  fmt::format("the gap is negative in part of the initial box: h <= {:.3g} at {}",
                                              gap.output(0).hi(), where),
                                  "choose an initial box with h(q) >= 0"));
            break;
        }
    }
    if (!errors.empty()) throw InputErrors(errors);
}

}  // namespace achilles
