// The claims of one step and of one completion.
#include "enclose/completion.hpp"

#include "certify/truth.hpp"
#include "core/enclose/truth.hpp"
#include "enclose/event_maps.hpp"
#include "enclose/step.hpp"

namespace achilles::test {

namespace {

Coordinates coordinates_of(const Model& model, const achilles::EnclosureProblem& claim) {
    Coordinates z;
    z.dof = static_cast<std::size_t>(model.dof());
    z.parameters = claim.parameters;
    return z;
}

// The ball on the surface at x, sliding at this rate, just before an impact of speed w.
Doubleton landing(double x, double rate, double w) {
    const Interval at(x), slope = cos(at);
    return Doubleton({Interval(3.0), at, sin(at), Interval(rate), slope * Interval(rate), Interval(0.0), Interval(-w)});
}

}  // namespace

// a = sin(t): the truncation error after order 20 is the tail of the series. The remainder contains it; half of the
// remainder does not.
TEST(EnclosureStep, ItsRemainderIsWhatTheSeriesLeavesOut) {
    const auto model = model_of({.potential = "a^2/2 + b", .b = 1.0, .a_rate = 1.0});
    const achilles::EnclosureProblem claim = achilles::problem_of(model->default_run());
    const Coordinates z = coordinates_of(*model, claim);
    EnclosureStepper stepper(*model, z, {});
    const Doubleton start(
        {Interval(0.0), Interval(0.0), Interval(1.0), Interval(1.0), Interval(0.0), Interval(1.0), Interval(0.0)});
    const EnclosureStep step = stepper.make(start, 1.0, {{}});
    const Real length = step.length();
    Real term = length, tail = 0;
    for (int k = 3; k < 60; k += 2) {
        term *= -length * length / (k * (k - 1));
        if (k > EnclosureStepper::order) tail += term;
    }
    const Interval remainder = step.remainder_at(Interval(step.length()))[z.q(0)];
    EXPECT_GT(step.length(), 0.2);
    EXPECT_TRUE(contains(remainder, tail)) << tail << " in " << remainder.lo() << " " << remainder.hi();
    EXPECT_FALSE(contains(Interval(0.5) * remainder, tail));
    EXPECT_TRUE(contains(step.box_over(start, Interval(0.0, step.length()))[z.q(0)], sin(length)));
}

// Signed bounds gain an order: the center of the error decreases with w^3, its radius with w^4.
TEST(Completion, ItsErrorIsOfFourthOrder) {
    const auto model = load("ball_on_sine");
    const achilles::EnclosureProblem claim = achilles::problem_of(model->default_run());
    const Coordinates z = coordinates_of(*model, claim);
    Completion completion(*model, z);
    std::vector<double> middles, radii;
    for (const double w : {4e-3, 2e-3, 1e-3}) {
        const auto proof = completion.prove(landing(4.6, 0.7, w), Interval(0.5));
        ASSERT_TRUE(proof) << w;
        double middle = 0.0, radius = 0.0;
        for (const Interval& error : proof->error) {
            middle = std::max(middle, std::abs(mid(error)));
            radius = std::max(radius, rad(error));
        }
        middles.push_back(middle);
        radii.push_back(radius);
    }
    for (std::size_t i = 0; i + 1 < radii.size(); ++i) {
        EXPECT_NEAR(middles[i] / middles[i + 1], 8.0, 0.4);
        EXPECT_NEAR(radii[i] / radii[i + 1], 16.0, 1.5);
    }
}

// b falls with acceleration 1 + a, which changes fast, and pushes a by 2 b', so that a lags by 2 int h. This is near
// the largest or the smallest possible integral, as the bounces begin with the smallest or the largest acceleration.
TEST(Completion, ItsIntegralsAreThoseOfTheRightAccelerations) {
    const auto model =
        model_of({.potential = "0*a", .a = 3.0, .a_rate = 50.0, .a_force = "2*b'", .b_force = "-(1 + a)"});
    const achilles::Run run = model->default_run();
    const Coordinates z = coordinates_of(*model, achilles::problem_of(run));
    Completion completion(*model, z);
    TrueMotion motion(*model, run);
    const double w = 0.02;
    for (const double rate : {50.0, -50.0}) {
        const Doubleton set(
            {Interval(0.0), Interval(3.0), Interval(0.0), Interval(rate), Interval(0.0), Interval(0.0), Interval(-w)});
        const auto proof = completion.prove(set, Interval(0.5));
        ASSERT_TRUE(proof);
        const Point restart{{3, 0}, {rate, 0}, 0};
        Point collision = restart;
        collision.v[1] -= w;
        const auto zeno = motion.zeno(collision);
        ASSERT_TRUE(zeno);
        const Point shadow = motion.constrained(restart, zeno->time, 1e-28);
        EXPECT_TRUE(contains(proof->error[0], zeno->point.q[0] - shadow.q[0]))
            << rate << ": " << zeno->point.q[0] - shadow.q[0] << " in " << proof->error[0].lo() << " "
            << proof->error[0].hi();
        EXPECT_TRUE(contains(proof->accumulation_time, zeno->time));
    }
}

// Against 34-digit references of single completions: the accumulation time, and the difference from the constrained
// motion at its end.
TEST(Completion, EnclosesAccumulationTimeAndShadowingError) {
    const auto model = load("ball_on_sine");
    const achilles::Run run = model->default_run();
    const Coordinates z = coordinates_of(*model, achilles::problem_of(run));
    Completion completion(*model, z);
    TrueMotion motion(*model, run);
    for (const double w : {0.05, 0.02, 1e-2, 1e-3})
        for (const double x : {4.6, 11.2}) {
            const Doubleton set = landing(x, 0.7, w);
            const auto proof = completion.prove(set, Interval(0.5));
            if (!proof) continue;
            State before{Vector(2), Vector(2), 3.0};
            for (std::size_t i = 0; i < 2; ++i) {
                before.q[static_cast<Eigen::Index>(i)] = set.center(z.q(i));
                before.v[static_cast<Eigen::Index>(i)] = set.center(z.v(i));
            }
            Point collision = motion.restart(motion.collision(before), Reinitialization::kinetic);
            const Point restart = collision;
            const auto contact = motion.contact(collision);
            for (std::size_t i = 0; i < 2; ++i) collision.v[i] -= w * contact.n[i];
            const auto zeno = motion.zeno(collision);
            ASSERT_TRUE(zeno);
            EXPECT_TRUE(contains(proof->accumulation_time, zeno->time)) << w;
            const Point shadow = motion.constrained(restart, zeno->time, 1e-28);
            for (std::size_t i = 0; i < 2; ++i) {
                const Interval slack = Interval(-1e-14, 1e-14) * Interval(w);
                EXPECT_TRUE(contains(proof->error[i] + slack, zeno->point.q[i] - shadow.q[i])) << w << " q " << i;
                EXPECT_TRUE(contains(proof->error[2 + i] + slack, zeno->point.v[i] - shadow.v[i])) << w << " v " << i;
            }
        }
}

// The same at random impacts of three systems, with configuration-dependent M(q) and curved gaps.
TEST(Completion, EnclosesRandomCollisions) {
    int proved = 0;
    double closest = 0.0;  // largest distance from the center of the error, relative to its radius
    for (const char* name : {"ball_on_sine", "double_pendulum", "falling_rod"}) {
        const auto model = load(name);
        Trials trials(model, 17);
        for (int i = 0; i < 40; ++i) {
            SCOPED_TRACE(fmt::format("{} {}", name, i));
            const Trial trial = trials.next();
            if (!trial.zeno) continue;
            const Collision& collision = trial.kinetic.collision;
            const Coordinates z = coordinates_of(*model, achilles::problem_of(trial.run));
            const auto maps = make_maps(*model, z);
            Intervals box(z.size());
            box[0] = Interval(collision.before.t);
            for (std::size_t k = 0; k < z.dof; ++k) {  // the reference moves the rounded state onto the surface
                const double q = collision.before.q[static_cast<Eigen::Index>(k)];
                box[z.q(k)] = Interval(q) + Interval(-1.0, 1.0) * Interval(1e-14 * (std::abs(q) + 1.0));
                box[z.v(k)] = Interval(collision.before.v[static_cast<Eigen::Index>(k)]);
            }
            Doubleton set(box);
            maps->measure_gap(set);
            set.set(z.h(), 0.0);
            maps->project(set);
            if (!certainly_negative(set.hull(z.u()))) continue;
            maps->take_rate_out(set);
            const auto proof = Completion(*model, z).prove(set, model->restitution(z.parameters, 0));
            if (!proof) continue;
            ++proved;
            EXPECT_TRUE(contains(proof->accumulation_time, trial.zeno->time));
            const Point &true_point = trial.zeno->point, &shadow = trial.kinetic.at_zeno;
            for (std::size_t k = 0; k < 2 * z.dof; ++k) {
                const Real off = k < z.dof ? Real(true_point.q[k] - shadow.q[k])
                                           : Real(true_point.v[k - z.dof] - shadow.v[k - z.dof]);
                const Interval& error = proof->error[k];
                EXPECT_TRUE(contains(error + Interval(-1e-24, 1e-24), off))
                    << k << ": " << off << " not in " << error.lo() << " " << error.hi();
                if (rad(error) > 1e-20)
                    closest = std::max(closest, std::abs(static_cast<double>(off) - mid(error)) / rad(error));
            }
        }
    }
    EXPECT_GT(proved, 60);
    EXPECT_GT(closest, 0.5);  // the bound is nearly attained, so a missing term would show
}

}  // namespace achilles::test
