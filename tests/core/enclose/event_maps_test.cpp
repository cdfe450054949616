// The maps between steps (impact, retraction onto the surface), checked with members in 34 digits.
#include "enclose/event_maps.hpp"

#include <random>

#include "core/enclose/truth.hpp"

namespace achilles::test {

// The ball near a point of the surface, with members of the set that lie on the surface.
class SurfaceMaps : public testing::Test {
 protected:
    static constexpr double half = 1e-4;
    SurfaceMaps() : motion_(*model_, run_), maps_(make_maps(*model_, z_)) {}

    Doubleton set(bool at_rest) const {
        const auto around = [](double x) { return Interval(x) + Interval(-half, half); };
        const double x = 4.4, slope = std::cos(x);
        Intervals box{Interval(0.0), around(x), around(std::sin(x)), around(0.8), around(0.8 * slope), Interval(0.0)};
        box.emplace_back(at_rest ? Interval(0.0) : around(-0.5));
        if (!at_rest) box[z_.v(1)] = box[z_.v(1)] + Interval(-0.5);
        return Doubleton(box);
    }
    // A random member with h = 0 and hdot = u; nullopt if the draw is outside the set.
    std::optional<Point> member(const Doubleton& set, bool at_rest, Real& u) {
        Point point;
        point.q = {any_of(set.hull(z_.q(0))), 0};
        point.q[1] = sin(point.q[0]);
        point.v = {any_of(set.hull(z_.v(0))), any_of(set.hull(z_.v(1)))};
        if (at_rest) point.v[1] = point.v[0] * cos(point.q[0]);
        u = at_rest ? Real(0) : motion_.contact(point).hdot;
        const bool inside = contains(set.hull(z_.q(1)), point.q[1]) && contains(set.hull(z_.v(1)), point.v[1]) &&
                            contains(set.hull(z_.u()), u);
        return inside ? std::optional(point) : std::nullopt;
    }
    bool holds(const Doubleton& set, const Point& point, const Real& u) const {
        bool inside = contains(set.hull(z_.u()), u);
        for (std::size_t i = 0; i < 2; ++i)
            inside = inside && contains(set.hull(z_.q(i)), point.q[i]) && contains(set.hull(z_.v(i)), point.v[i]);
        return inside;
    }
    Real any_of(const Interval& x) {
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        return Real(x.lo()) + uniform(random_) * (Real(x.hi()) - Real(x.lo()));
    }
    // Width of the set in the direction of the gap's gradient.
    double across(const Doubleton& set) const {
        Intervals row(z_.size());
        const EventMaps::GapValues surface = maps_->surface(set.center());
        for (std::size_t i = 0; i < 2; ++i) row[z_.q(i)] = surface.gradient[i];
        return rad(set.along(row.data()));
    }

    std::shared_ptr<const Model> model_ = load("ball_on_sine");
    achilles::Run run_ = model_->default_run();
    Coordinates z_{2, true, achilles::problem_of(run_).parameters, {}};
    TrueMotion motion_;
    std::unique_ptr<EventMaps> maps_;
    std::mt19937_64 random_{5};
};

// Retraction is the identity on members on the surface, and reduces the width across the surface to second order.
TEST_F(SurfaceMaps, RetractionsLeaveMembersAndTakeTheRest) {
    for (const bool at_rest : {true, false}) {
        const Doubleton before = set(at_rest);
        Doubleton after = before;
        at_rest ? maps_->retract(after) : maps_->project(after);
        EXPECT_GT(across(before), half);
        EXPECT_LT(across(after), 10.0 * half * half);
        int members = 0;
        for (int trial = 0; trial < 400; ++trial) {
            Real u;
            const auto point = member(before, at_rest, u);
            if (!point) continue;
            ++members;
            ASSERT_TRUE(holds(after, *point, u));
        }
        EXPECT_GT(members, 50);
    }
}

TEST_F(SurfaceMaps, ImpactsAreNewtonsLawForAllMembers) {
    const Doubleton before = set(false);
    Doubleton after = before, tangential = before;
    maps_->impact(after);
    maps_->take_rate_out(tangential);
    int members = 0;
    for (int trial = 0; trial < 400; ++trial) {
        Real u;
        auto point = member(before, false, u);
        if (!point) continue;
        ++members;
        const auto contact = motion_.contact(*point);
        Point slid = *point;
        for (std::size_t i = 0; i < 2; ++i) {
            slid.v[i] -= contact.n[i] * u;
            point->v[i] -= Real(1.5) * contact.n[i] * u;
        }
        ASSERT_TRUE(holds(after, *point, -u / 2));
        ASSERT_TRUE(holds(tangential, slid, u));
    }
    EXPECT_GT(members, 50);
    // No wider than the members require, to first order.
    EXPECT_LT(rad(after.hull(z_.u())), 0.5001 * half);
}

}  // namespace achilles::test
