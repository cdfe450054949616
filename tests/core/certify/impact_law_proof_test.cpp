// The proof that impacts with friction have one solution (theory-friction.md 4.3).
#include "certify/impact_law_proof.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "model/read_system.hpp"
#include "number/float_environment.hpp"

namespace achilles {
namespace {

// A block on the floor, of the mass 1, carries one that bounces. The floor slides along its slip if `skew` is not 0:
// W_NN = 1, W_NT = skew.
std::shared_ptr<const Model> carrier(const std::string& friction, double skew) {
    return derive(parse_system(fmt::format(R"-(coordinate = [{{name = "x"}}, {{name = "y"}}, {{name = "z"}}]
lagrangian.kinetic = "x'^2 + (y'^2 + z'^2)/2"
lagrangian.potential = "y + z"
constraint = [
  {{name = "floor", gap = "y", slip = "x' + {}*y'", friction = "{}", restitution = 0}},
  {{name = "seat", gap = "z - y", restitution = 0.5}}]
)-",
                                           skew, friction)));
}

// While the block slides at u and its load lands at w.
std::optional<BouncingObstacle> doubt(const Model& model, ContactState floor, double u, double w) {
    const FloatEnvironmentGuard ground;
    const BouncingKey key{1, Mode().with(std::size_t{0}, floor)};
    const ImpactLawTerms& terms = model.other_contact_terms(key).impact_law;
    auto program = model.evaluator<Interval>(terms.program, model.default_run().parameters);
    program.input(model.layout().v(0)) = Interval(u);
    program.input(model.layout().sigma()) = Interval(-w, w);
    return doubt_of_impact_law(terms, program, model.layout().sliding_speed(), Interval(0.5));
}

TEST(ImpactLawProof, HoldsForASlideThatImpulsesCannotStop) {
    const auto model = carrier("0.2", 0.0);
    EXPECT_FALSE(doubt(*model, ContactState::slip_plus, 1.0, 0.1));
    const auto reversed = doubt(*model, ContactState::slip_plus, 0.1, 1.0);  // by mu p/2 = 0.15
    ASSERT_TRUE(reversed);
    EXPECT_EQ(reversed->which, 0u);
    EXPECT_EQ(reversed->text, "is not proved to keep the direction of its slip");
}

TEST(ImpactLawProof, NeedsCoefficientsThatLeaveOneMotion) {
    for (const ContactState state : {ContactState::held, ContactState::slip_plus}) {
        EXPECT_FALSE(doubt(*carrier("0.5", 0.8), state, 10.0, 0.01));
        const auto several = doubt(*carrier("5", 0.8), state, 10.0, 0.01);
        ASSERT_TRUE(several);
        EXPECT_EQ(several->text, "is not proved to have only one motion at its impacts");
    }
}

// mu may be 5 at speeds that no impact reaches: |u| <= sqrt(2 T W_TT) = 0.1.
TEST(ImpactLawProof, TakesTheCoefficientAtSpeedsThatTheEnergyAllows) {
    EXPECT_FALSE(doubt(*carrier("0.5 + slip^2", 0.8), ContactState::held, 0.0, 0.1));
    EXPECT_TRUE(doubt(*carrier("0.5 + 200*slip^2", 0.8), ContactState::held, 0.0, 0.1));
}

}  // namespace
}  // namespace achilles
