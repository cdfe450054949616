#include "certify/members.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "simulate/sampler.hpp"
#include "simulate/simulate.hpp"

namespace achilles::test {

namespace {

class Comparison {
 public:
    explicit Comparison(Membership& result)
        : result_(result), observed_(result.proved.events.size(), Interval::undefined()) {}

    void add(const Trajectory& run) {
        for (std::size_t contact = 0; contact < run.model->contacts(); ++contact) add_events(run, contact);
        Sampler sampler(run);
        const auto state = [&](const EnclosedState& box) {
            if (box.t <= run.end_time) compare(box.q, sampler.at(box.t).state.q, 1e-9, fmt::format("q at {}", box.t));
        };
        for (const EnclosedState& sample : result_.proved.samples) state(sample);
        if (result_.proved.end) state(*result_.proved.end);
    }

    void finish() const {
        for (std::size_t k = 0; k < observed_.size(); ++k) {
            if (!observed_[k].is_defined() || !(width(observed_[k]) > 1e-9)) continue;
            result_.width_over_observed += width(result_.proved.events[k].t) / width(observed_[k]);
            ++result_.widths;
        }
        if (result_.widths > 0) result_.width_over_observed /= result_.widths;
    }

 private:
    // Adds the events of one contact. They are compared per contact: if two contacts bounce, a run may cut the sequence
    // of one before an impact of the other, and the proof after it.
    void add_events(const Trajectory& run, std::size_t contact) {
        std::vector<const Event*> events;
        for (const Event& event : run.events)
            if (event.contacts.contains(contact)) events.push_back(&event);
        std::size_t at = 0;
        for (std::size_t k = 0; k < observed_.size(); ++k) {
            const EnclosedEvent& event = result_.proved.events[k];
            if (event.contact != contact) continue;
            while (at < events.size() && event.kind != Event::Kind::impact && events[at]->kind == Event::Kind::impact)
                ++at;
            if (at == events.size()) break;
            const bool is_cut = events[at]->is_zeno() || events[at]->is_collapse();  // earlier than the proof
            if (event.kind == Event::Kind::impact && is_cut) continue;
            const Event& there = *events[at++];
            if (there.kind != event.kind || !(there.opened == event.opened))
                return compare(Interval(0.0), 1.0, 0.0, fmt::format("what event {} is", k));
            compare(event.t, there.t, 2e-11, fmt::format("time {}", k));
            observed_[k] = observed_[k].is_defined() ? hull(observed_[k], Interval(there.t)) : Interval(there.t);
            compare(event.q, there.q, 1e-9, fmt::format("q of event {}", k));
        }
    }

    // `slack` is the error of the run itself.
    void compare(const Interval& x, double y, double slack, const std::string& what) {
        ++result_.compared;
        const double allowed = slack + 1e-3 * width(x);
        if (x.lo() - allowed <= y && y <= x.hi() + allowed) return;
        if (result_.outside++ == 0) result_.first = fmt::format("{}: {} not in [{}, {}]", what, y, x.lo(), x.hi());
    }
    void compare(const Intervals& box, const Vector& q, double slack, const std::string& what) {
        for (std::size_t i = 0; i < box.size(); ++i) compare(box[i], q[static_cast<Eigen::Index>(i)], slack, what);
    }

    Membership& result_;
    Intervals observed_;
};

}  // namespace

achilles::EnclosureProblem claim_around(const Model& model, double end, double half, double of_parameters,
                                        unsigned seed) {
    achilles::EnclosureProblem claim = problem_of(model.default_run());
    claim.run.options.end_time = std::min(claim.run.options.end_time, end);
    double closest = 1.0;
    for (std::size_t i = 0; i < model.contacts(); ++i) {
        auto gap = model.evaluator(model.gap(i), claim.run.parameters);
        set_state(gap, claim.run.start());
        gap.run();
        closest = std::min(closest, std::abs(gap.output(0)));
    }
    if (closest > 1e-9) {  // otherwise the gap of most members would be negative
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> uniform(0.99, 1.01);
        for (Intervals* box : {&claim.q, &claim.v})
            for (Interval& entry : *box)
                if (seed != 0) entry = Interval(mid(entry) * uniform(random));
        inflate(claim, half);
    }
    for (Interval& parameter : claim.parameters)
        parameter = parameter * Interval(1.0 - of_parameters, 1.0 + of_parameters);
    const double start = claim.run.options.start_time;
    for (int i = 1; i < 20; ++i) claim.times.push_back(start + (claim.run.options.end_time - start) * i / 20.0);
    return claim;
}

Membership members_of(const std::shared_ptr<const Model>& model, const achilles::EnclosureProblem& claim, int count,
                      unsigned seed) {
    Membership result;
    result.proved = prove(model, claim);
    Run run = claim.run;
    run.options.tolerance = 1e-13;
    run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = 1e-12;
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    Comparison comparison(result);
    for (int member = 0; member < count; ++member) {
        const auto any_of = [&](const Interval& box) {
            const double share = uniform(random), place = member % 4 == 0 ? std::copysign(1.0, share) : share;
            return std::clamp(mid(box) + place * rad(box), box.lo(), box.hi());
        };
        for (std::size_t i = 0; i < claim.q.size(); ++i) {
            run.q[static_cast<Eigen::Index>(i)] = any_of(claim.q[i]);
            run.v[static_cast<Eigen::Index>(i)] = any_of(claim.v[i]);
        }
        for (std::size_t i = 0; i < claim.parameters.size(); ++i) run.parameters[i] = any_of(claim.parameters[i]);
        try {
            comparison.add(simulate(model, run));
        } catch (const InputError&) {  // invalid start: negative gap
        }
    }
    comparison.finish();
    return result;
}

}  // namespace achilles::test
