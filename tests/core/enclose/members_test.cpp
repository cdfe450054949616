// Random members of random boxes, simulated nearly exactly, against the boxes' enclosures.
#include <random>

#include "core/enclose/truth.hpp"
#include "simulate/sampler.hpp"

namespace achilles::test {

namespace {

struct Tally {
    long compared = 0, outside = 0;
    double widths = 0.0;  // of event times: enclosed over observed
    int counted = 0;
    std::string first;  // that was outside

    void compare(const Interval& x, double y, double slack, const std::string& what) {
        ++compared;
        if (x.lo() - slack <= y && y <= x.hi() + slack) return;
        if (outside++ == 0) first = fmt::format("{}: {} not in [{}, {}]", what, y, x.lo(), x.hi());
    }
};

// One member's run beside the enclosure. Slack: what the run itself may be wrong by.
void compare(const Enclosure& proved, const Trajectory& run, Tally& tally, std::vector<Interval>& observed) {
    std::size_t at = 0;
    for (std::size_t k = 0; k < proved.events.size(); ++k) {
        const EnclosedEvent& event = proved.events[k];
        while (at < run.events.size() && event.kind != Event::Kind::impact &&
               run.events[at].kind == Event::Kind::impact)
            ++at;
        if (at == run.events.size()) break;
        if (event.kind == Event::Kind::impact && run.events[at].kind == Event::Kind::zeno) continue;  // cut earlier
        if (run.events[at].kind != event.kind) {
            tally.compare(Interval(0.0), 1.0, 0.0, fmt::format("the kind of event {}", k));
            return;
        }
        const Event& there = run.events[at++];
        tally.compare(event.t, there.t, 2e-11 + 1e-3 * width(event.t), fmt::format("time {}", k));
        observed[k] = observed[k].is_defined() ? hull(observed[k], Interval(there.t)) : Interval(there.t);
        for (std::size_t i = 0; i < event.q.size(); ++i)
            tally.compare(event.q[i], there.q[static_cast<Eigen::Index>(i)], 1e-9 + 1e-3 * width(event.q[i]), "q");
    }
    Sampler sampler(run);
    const auto state = [&](const EnclosedState& box) {
        if (box.t > run.end_time) return;
        const State there = sampler.at(box.t).state;
        for (std::size_t i = 0; i < box.q.size(); ++i)
            tally.compare(box.q[i], there.q[static_cast<Eigen::Index>(i)], 1e-9 + 1e-3 * width(box.q[i]),
                          fmt::format("q at {}", box.t));
    };
    for (const EnclosedState& sample : proved.samples) state(sample);
    if (proved.end) state(*proved.end);
}

}  // namespace

Tally members(const std::string& name, int count, double half, double of_parameters) {
    const auto model = load(name);
    Run run = model->default_run();
    run.options.end_time = std::min(run.options.end_time, 4.0);
    run.options.tolerance = 1e-13;
    run.options.truncation.eps_q = run.options.truncation.eps_v = run.options.truncation.eps_t = 1e-12;
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    Claim claim = widened(run, half);
    for (Interval& parameter : claim.parameters)
        parameter = parameter * Interval(1.0 - of_parameters, 1.0 + of_parameters);
    for (int i = 1; i < 20; ++i) claim.times.push_back(run.options.end_time * i / 20.0);
    const Enclosure proved = prove(model, claim);
    Tally tally;
    std::vector<Interval> observed(proved.events.size(), Interval::undefined());
    for (int member = 0; member < count; ++member) {
        const bool corner = member % 4 == 0;
        const auto any_of = [&](const Interval& box) {
            const double share = uniform(random);
            return std::clamp(mid(box) + (corner ? std::copysign(1.0, share) : share) * rad(box), box.lo(), box.hi());
        };
        Run one = run;
        for (Eigen::Index i = 0; i < run.q.size(); ++i) {
            one.q[i] = any_of(claim.q[static_cast<std::size_t>(i)]);
            one.v[i] = any_of(claim.v[static_cast<std::size_t>(i)]);
        }
        for (std::size_t i = 0; i < one.parameters.size(); ++i) one.parameters[i] = any_of(claim.parameters[i]);
        try {
            compare(proved, simulate(model, one), tally, observed);
        } catch (const InputError&) {  // no start: below the surface
        }
    }
    for (std::size_t k = 0; k < observed.size(); ++k) {
        if (!observed[k].is_defined() || !(width(observed[k]) > 0.01 * half)) continue;
        tally.widths += width(proved.events[k].t) / width(observed[k]);
        ++tally.counted;
    }
    return tally;
}

TEST(Members, OfABoxAreInItsEnclosure) {
    for (const std::string& name : systems_of_one_gap()) {
        SCOPED_TRACE(name);
        const double half = name == "triple_pendulum" ? 1e-10 : 1e-6;
        const Tally tally = members(name, 50, half, 0.0);
        EXPECT_EQ(tally.outside, 0) << tally.first;
    }
}

TEST(Members, OfABoxAreNotMuchFewerThanItsEnclosureHolds) {
    for (const Problem& problem : problems) {
        const Tally tally = members(problem.asset, 50, 1e-6, 0.0);
        EXPECT_GT(tally.compared, 1000);
        EXPECT_LT(tally.widths / tally.counted, 2.0) << problem.asset;
    }
}

// e and g included.
TEST(Members, OfABoxWithParametersAreInItsEnclosure) {
    for (const std::string name : {"ball_on_sine", "double_pendulum", "impact_oscillator"}) {
        SCOPED_TRACE(name);
        const Tally tally = members(name, 50, 1e-7, 1e-7);
        EXPECT_EQ(tally.outside, 0) << tally.first;
        EXPECT_GT(tally.compared, 1000);
        EXPECT_LT(tally.widths / tally.counted, 3.0);
    }
}

}  // namespace achilles::test
