#include "simulate/side_by_side.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "number/ground.hpp"

namespace achilles {

namespace {

constexpr std::size_t most_under_way = 24;  // so that a line is seldom shorter than the lanes

}  // namespace

SideBySide::SideBySide(const std::shared_ptr<const Model>& model, std::size_t count, std::atomic<std::size_t>& next,
                       const std::function<Run(std::size_t)>& run_of,
                       const std::function<void(std::size_t, Attempt&&)>& take)
    : step_(model->lane_programs().coordinates),
      model_(model),
      count_(count),
      next_(next),
      run_of_(run_of),
      take_(take) {}

void SideBySide::work() {
    const Ground ground;
    while (true) {
        while (flying_.size() + staying_.size() < most_under_way) {
            const std::size_t index = next_.fetch_add(1);
            if (index >= count_) break;
            begin(index);
        }
        if (flying_.empty() && staying_.empty()) return;
        const bool flying = flying_.size() >= staying_.size();
        step(flying ? flying_ : staying_, flying);
    }
}

void SideBySide::begin(std::size_t index) {
    Run run = run_of_(index);
    std::optional<InputError> refusal;
    try {
        model_->check(run);
    } catch (const InputError& error) {
        refusal = error;
    }
    if (refusal) return take_(index, std::move(*refusal));
    raise_to_least(run.options);
    const bool in_lanes = run.options.method == Method::taylor && model_->edges().empty() &&
                          !model_->motion({}).series.is_partial() &&
                          !model_->motion(ContactSet::of(0)).series.is_partial();
    if (!in_lanes) return take_(index, simulate(model_, run, nullptr, Keep::end));
    Member& member = member_for(index, run);
    member.execution.asks_again_ = false;  // an undecided run is made again as a whole
    member.execution.begin();
    go_on(member);
}

SideBySide::Member& SideBySide::member_for(std::size_t index, const Run& run) {
    if (spare_.empty()) {
        all_.push_back(std::make_unique<Member>(index, model_, run));
        all_.back()->set = set_of(run.parameters);
        return *all_.back();
    }
    Member& member = *spare_.back();
    spare_.pop_back();
    member.index = index;
    if (!member.execution.restart(run)) {
        member.execution = Execution(model_, run, nullptr, Keep::end);
        member.set = set_of(run.parameters);
    }
    return member;
}

std::size_t SideBySide::set_of(const std::vector<double>& parameters) {
    if (sets_ == 0 || parameters != last_parameters_) {
        ++sets_;
        last_parameters_ = parameters;
    }
    return sets_;
}

// Into line, after what only the run itself can do.
void SideBySide::go_on(Member& member) {
    Execution& run = member.execution;
    while (run.running()) {
        const bool in_contact = run.constrained_ || run.completing();
        const double until = in_contact ? run.contact_until() : run.run_.options.end_time;
        const bool plain = run.record_.steps() < run.run_.options.max_steps && run.stalled_ == 0 &&
                           until - run.t_ > 1e-15 * std::abs(run.t_);
        if (in_contact) {
            if (plain && !run.constrained_start_.asked_again) return staying_.push_back(&member);
            run.completing() ? run.wait_for_zeno_point() : run.stay_until_release();
        } else {
            const bool known = !run.at_impact_ && run.flight_start_.multiplicity <= 1 && !run.flight_start_.asked_again;
            if (plain && known) return flying_.push_back(&member);
            run.fly_to_impact();
        }
    }
    const bool decided = run.outcome_->kind != Outcome::Kind::undecided;
    // The longer steps of a run alone may know enough.
    take_(member.index, decided ? run.finish() : simulate(model_, run.run_, nullptr, Keep::end));
    spare_.push_back(&member);
}

// The first of the line, and those of its tolerance: steps have one order.
void SideBySide::choose(Line& line) {
    members_.clear();
    const double tolerance = line.front()->execution.run_.options.tolerance;
    std::erase_if(line, [&](Member* member) {
        if (members_.size() == Eight::count || member->execution.run_.options.tolerance != tolerance) return false;
        members_.push_back(member);
        return true;
    });
}

void SideBySide::step(Line& line, bool flying) {
    choose(line);
    LaneStepper& stepper = prepare();
    gather(flying);
    if (flying) {
        stepper.fly(step_);
    } else {
        stepper.stay(step_, most_steps_in_contact());
    }
    for (std::size_t lane = 0; lane < members_.size(); ++lane) {
        Execution& run = members_[lane]->execution;
        if (flying) {
            after_flight(run, lane);
        } else {
            after_contact(run, lane);
        }
        go_on(*members_[lane]);
    }
}

// The stepper for these, with their parameters in its lanes. Lanes without a run repeat the first.
LaneStepper& SideBySide::prepare() {
    const double tolerance = members_.front()->execution.run_.options.tolerance;
    auto found = steppers_.find(tolerance);
    if (found == steppers_.end())
        found = steppers_.emplace(tolerance, Prepared{make_lane_stepper(model_->lane_programs(), tolerance), {}}).first;
    Prepared& prepared = found->second;
    std::array<std::size_t, Eight::count> sets{};
    for (std::size_t lane = 0; lane < Eight::count; ++lane) sets[lane] = member_in(lane).set;
    if (prepared.sets == sets) return *prepared.stepper;
    prepared.sets = sets;
    std::vector<Eight> parameters(members_.front()->execution.run_.parameters.size());
    for (std::size_t lane = 0; lane < Eight::count; ++lane)
        for (std::size_t i = 0; i < parameters.size(); ++i)
            parameters[i][lane] = member_in(lane).execution.run_.parameters[i];
    prepared.stepper->fix(parameters);
    return *prepared.stepper;
}

void SideBySide::gather(bool flying) {
    for (std::size_t lane = 0; lane < Eight::count; ++lane) {
        const Execution& run = member_in(lane).execution;
        const auto n = run.state_.q.size();
        for (Eigen::Index i = 0; i < n; ++i) {
            step_.q_and_v[static_cast<std::size_t>(i)][lane] = run.state_.q[i];
            step_.q_and_v[static_cast<std::size_t>(n + i)][lane] = run.state_.v[i];
        }
        step_.t[lane] = run.t_;
        step_.state_error[lane] = flying ? run.flight_start_.gap.state_error : run.state_error();
        step_.until[lane] = flying ? run.run_.options.end_time : run.contact_until();
        if (!flying) continue;
        const auto& [gap, multiplicity, asked_again] = run.flight_start_;
        step_.h[lane] = gap.h;
        step_.hdot[lane] = gap.hdot;
        step_.error[lane] = gap.error;
        step_.rate_error[lane] = gap.rate_error;
        step_.known[lane] = multiplicity;
    }
}

Contact SideBySide::contact_of(std::size_t lane) const {
    Contact contact;
    contact.h = step_.end_h[lane];
    contact.hdot = step_.end_hdot[lane];
    contact.W = step_.end_W[lane];
    const auto n = static_cast<Eigen::Index>(step_.impulse_direction.size());
    contact.impulse_direction.resize(n);
    contact.g.resize(n);
    for (std::size_t i = 0; i < step_.impulse_direction.size(); ++i) {
        contact.impulse_direction.data()[i] = step_.impulse_direction[i][lane];
        contact.g.data()[i] = step_.g[i][lane];
    }
    return contact;
}

// The fewest that one of the runs may still make.
long SideBySide::most_steps_in_contact() const {
    long most = std::numeric_limits<long>::max();
    for (const Member* member : members_)
        most = std::min(most, member->execution.run_.options.max_steps - member->execution.record_.steps());
    return most;
}

// To the end of so many steps.
void SideBySide::move(Execution& run, std::size_t lane, long steps, double least_gap) const {
    const auto n = run.state_.q.size();
    for (Eigen::Index i = 0; i < n; ++i) {
        run.state_.q[i] = step_.q_and_v[static_cast<std::size_t>(i)][lane];
        run.state_.v[i] = step_.q_and_v[static_cast<std::size_t>(n + i)][lane];
    }
    run.record_.steps(steps, least_gap);
    run.advance_clock(step_.duration[lane], step_.t[lane]);
    run.other_evaluations_ += steps;
}

void SideBySide::after_flight(Execution& run, std::size_t lane) {
    if (step_.end[lane] == LaneStep::End::impact) {
        move(run, lane, 1, step_.end_h[lane]);
        run.contact_ = contact_of(lane);
        run.land();
    } else if (step_.end[lane] == LaneStep::End::no_event) {
        move(run, lane, 1, step_.end_h[lane]);
        Gap gap{step_.h[lane], step_.hdot[lane], step_.error[lane], step_.rate_error[lane], step_.state_error[lane]};
        const double off = step_.end_h[lane] - gap.h;
        if (std::abs(off) > 2.0 * step_.rounding[lane] &&
            !run.kinematics_.within_gap_error(off, 4.0, contact_of(lane), run.state_)) {
            gap.h = step_.end_h[lane];
            gap.hdot = step_.end_hdot[lane];
        }
        run.flight_start_ = {gap, 0};
    } else {
        run.fly_to_impact();
    }
}

void SideBySide::after_contact(Execution& run, std::size_t lane) {
    const bool plain = step_.end[lane] == LaneStep::End::no_event;
    const long steps = plain ? step_.steps : step_.steps - 1;
    if (steps > 0) move(run, lane, steps, step_.least_gap[lane]);
    if (plain) return;
    if (run.completing()) return run.wait_for_zeno_point();
    run.flow_.stay(run.t_, run.state_, run.state_error());
    const bool vanished = run.constrained_step(run.run_.options.end_time);
    run.settle();
    if (vanished) run.release();
}

}  // namespace achilles
