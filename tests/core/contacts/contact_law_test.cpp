#include "contacts/contact_law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/systems.hpp"
#include "series/evaluator.hpp"

namespace achilles {
namespace {

std::vector<Mode> modes_of(std::size_t contacts) {
    std::vector<Mode> modes;
    for (unsigned bits = 0; bits < 1u << contacts; ++bits) {
        Mode& mode = modes.emplace_back();
        for (std::size_t i = 0; i < contacts; ++i)
            if ((bits >> i & 1u) != 0) mode = mode.with(i, ContactState::held);
    }
    return modes;
}

TEST(ContactLaw, HasOneRowForEachState) {
    for (std::size_t i = 0; i < contact_laws.size(); ++i) {
        EXPECT_EQ(contact_laws[i].state, static_cast<ContactState>(i));
        EXPECT_EQ(&law_of(contact_laws[i].state), &contact_laws[i]);
    }
    EXPECT_EQ(law_of(ContactState::open).transition, Transition::impact);
    EXPECT_EQ(law_of(ContactState::held).transition, Transition::release);
}

// A quantity that is kept at zero cannot be the next one to reach zero.
TEST(ContactLaw, WatchesNothingThatItKeeps) {
    for (const ContactLaw& law : contact_laws)
        EXPECT_EQ(law.kept == Constraint::gap, law.watched != WatchedFunction::gap);
}

TEST(ContactLaw, SortsTheContactsOfAMode) {
    for (const Mode mode : modes_of(5)) {
        EXPECT_EQ(contacts_keeping(mode, Constraint::gap), mode.held());
        for (std::size_t i = 0; i < max_contacts; ++i) {
            const ContactLaw& law = law_of(mode.state(i));
            EXPECT_EQ(contacts_keeping(mode, Constraint::gap).contains(i), law.kept == Constraint::gap);
            EXPECT_EQ(contacts_keeping(mode, Constraint::none).contains(i), law.kept == Constraint::none);
            for (const auto watched : {WatchedFunction::gap, WatchedFunction::normal_force})
                EXPECT_EQ(contacts_watching(mode, watched).contains(i), law.watched == watched);
        }
    }
}

// A system at a generic state.
class AtState {
 public:
    explicit AtState(const std::string& name) : model_(test::load(name)), run_(model_->default_run()) {
        state_ = run_.start();
        for (Eigen::Index i = 0; i < state_.q.size(); ++i) {
            state_.q[i] += 0.1 + 0.01 * static_cast<double>(i);
            state_.v[i] += 0.3 - 0.02 * static_cast<double>(i);
        }
    }
    const Model& model() const { return *model_; }
    std::size_t dof() const { return static_cast<std::size_t>(model_->dof()); }

    double value(const Program& program) const {
        auto evaluator = model_->evaluator(program, run_.parameters);
        set_state(evaluator, state_);
        evaluator.run();
        return evaluator.output(0);
    }
    std::vector<double> accelerations(Mode mode) const {
        MotionTerms<Evaluator<double>> terms(model_->evaluator(model_->motion(mode).program, run_.parameters), dof(),
                                             model_->contacts());
        set_state(terms, state_);
        terms.run();
        std::vector<double> a;
        for (std::size_t i = 0; i < dof(); ++i) a.push_back(terms.acceleration(i));
        return a;
    }
    // hddot of a contact in a mode: free-flight acceleration plus dh times what the contact forces add.
    double normal_acceleration(std::size_t contact, Mode mode) const {
        auto surface = model_->evaluator(model_->programs_of(contact).contact_terms, run_.parameters);
        set_state(surface, state_);
        surface.run();
        const std::vector<double> a = accelerations(mode), f = accelerations({});
        double hddot = value(model_->programs_of(contact).normal_acceleration);
        for (std::size_t k = 0; k < dof(); ++k) hddot += surface.gradient(k) * (a[k] - f[k]);
        return hddot;
    }
    // Value of the contact's event function along the motion in this mode.
    double event_function(std::size_t contact, Mode mode) const {
        SeriesEvaluator<double> series(model_->motion(mode).series, run_.parameters);
        std::vector<double> inputs(state_.q.begin(), state_.q.end());
        inputs.insert(inputs.end(), state_.v.begin(), state_.v.end());
        series.begin(inputs.data(), state_.t);
        return series.start(dof() + contact);
    }

 private:
    std::shared_ptr<const Model> model_;
    achilles::Run run_;
    State state_;
};

TEST(ContactLaw, DecidesWhatAMotionKeepsAndWatches) {
    int kept = 0, watched_gaps = 0;
    for (const char* name : {"bowl_and_post", "pendulum_two_stops", "ball_on_sine"}) {
        const AtState at(name);
        const Model& model = at.model();
        for (const Mode mode : modes_of(model.contacts())) {
            if (static_cast<std::size_t>(mode.held().count()) > at.dof()) continue;  // no degree of freedom is left
            SCOPED_TRACE(std::string(name) + " holds " + std::to_string(mode.held().count()));
            for (std::size_t i = 0; i < model.contacts(); ++i) {
                const ContactLaw& law = law_of(mode.state(i));
                const bool is_gap = law.watched == WatchedFunction::gap;
                const double wanted =
                    at.value(is_gap ? model.gap(i) : model.programs_of(i, mode.without(i)).normal_acceleration);
                EXPECT_NEAR(at.event_function(i, mode), wanted, 1e-11 * (1.0 + std::abs(wanted)));
                watched_gaps += is_gap ? 1 : 0;
                if (law.kept != Constraint::gap) continue;
                EXPECT_NEAR(at.normal_acceleration(i, mode), 0.0, 1e-11 * (1.0 + std::abs(wanted)));
                ++kept;
            }
        }
    }
    EXPECT_GE(kept, 5);
    EXPECT_GE(watched_gaps, 5);
}

}  // namespace
}  // namespace achilles
