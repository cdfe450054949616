#include "simulate/batch_simulator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "number/float_environment.hpp"

namespace achilles {

namespace {

constexpr std::size_t most_under_way = 24;  // enough that a queue is seldom shorter than the lanes

// Indices of the parameters on which the equations of motion and the gaps depend. Runs that agree in these differ at
// most in their restitutions.
std::vector<std::size_t> moving_parameters(const Model& model) {
    const Equations& from = model.equations();
    std::vector<Expression> all{from.kinetic, from.potential};
    for (const std::vector<Expression>* some : {&from.M, &from.Q, &from.gaps})
        all.insert(all.end(), some->begin(), some->end());
    std::vector<std::size_t> moving;
    for (std::size_t i = 0; i < model.default_run().parameters.size(); ++i) {
        const std::uint32_t slot = model.layout().parameter(i);
        if (std::any_of(all.begin(), all.end(), [&](Expression e) { return depends_on(e, {&slot, 1}); }))
            moving.push_back(i);
    }
    return moving;
}

}  // namespace

BatchSimulator::BatchRun::BatchRun(std::size_t number, const std::shared_ptr<const Model>& model, const Run& run)
    : index(number),
      surfaces(*model, run),
      execution(model, run, surfaces, nullptr, Recording::final_state,
                ExecutionAutomaton::AmbiguityPolicy::stop),  // undecided runs are repeated
      stepper(*model, run, surfaces) {}

BatchSimulator::BatchSimulator(const std::shared_ptr<const Model>& model, Vectors vectors)
    : end_{Vector(model->dof()), Vector(model->dof()), 0.0},
      model_(model),
      has_lanes_(!model->has_friction() && !model->has_guards() && !model->do_forces_see_contact() &&
                 model->contacts() == 1 && model->edges().empty() && !model->motion({}).series.is_partial() &&
                 !model->motion(Mode::holding(ContactSet::of(0))).series.is_partial()),
      vectors_(vectors),
      groups_{RunGroup(end_.q.size()), RunGroup(end_.q.size()), RunGroup(end_.q.size())} {
    result_.starts.resize(1);
    if (has_lanes_) moving_ = moving_parameters(*model);
}

bool BatchSimulator::move_alike(const std::vector<double>& some, const std::vector<double>& others) const {
    return std::all_of(moving_.begin(), moving_.end(), [&](std::size_t i) { return some[i] == others[i]; });
}

void BatchSimulator::work(const BatchSlice& share) {
    const FloatEnvironmentGuard ground;
    share_ = &share;
    while (true) {
        while (groups_[0].size() + groups_[1].size() + groups_[2].size() < most_under_way) {
            const std::size_t index = share.next.fetch_add(1);
            if (index >= share.count) break;
            begin(index);
        }
        const auto largest = std::max_element(groups_.begin(), groups_.end(),
                                              [](const RunGroup& a, const RunGroup& b) { return a.size() < b.size(); });
        if (largest->size() == 0) return;
        step(static_cast<Kind>(largest - groups_.begin()));
    }
}

void BatchSimulator::begin(std::size_t index) {
    Run run = share_->run_of(index);
    std::optional<InputError> refusal;
    try {
        model_->check(run);
    } catch (const InputError& error) {
        refusal = error;
    }
    if (refusal) return share_->take(index, std::move(*refusal));
    clamp_tolerances(run.options);
    if (!has_lanes_ || run.options.method != Method::taylor)
        return share_->take(index, simulate(model_, run, nullptr, Recording::final_state));
    go_on(member_for(index, run), false);
}

BatchSimulator::BatchRun& BatchSimulator::member_for(std::size_t index, const Run& run) {
    if (spare_.empty()) {
        all_.push_back(std::make_unique<BatchRun>(index, model_, run));
        all_.back()->set = set_of(run.parameters);
        return *all_.back();
    }
    BatchRun& member = *spare_.back();
    spare_.pop_back();
    member.index = index;
    member.before = {};
    member.alone = member.leaves = false;
    const bool alike = move_alike(member.execution.run().parameters, run.parameters);
    if (!alike || !member.execution.restart(run)) {
        member.surfaces = ContactCache(*model_, run);
        member.execution = ExecutionAutomaton(model_, run, member.surfaces, nullptr, Recording::final_state,
                                              ExecutionAutomaton::AmbiguityPolicy::stop);
        member.stepper = EventStepper(*model_, run, member.surfaces);
    }
    if (!alike) member.set = set_of(run.parameters);
    return member;
}

std::size_t BatchSimulator::set_of(const std::vector<double>& parameters) {
    if (sets_ == 0 || !move_alike(parameters, last_parameters_)) {
        ++sets_;
        last_parameters_ = parameters;
    }
    return sets_;
}

// Whether the next flight will be brief, because it starts slower than the last bounce and therefore is shorter. The
// tolerance of the gap scales with its height. The length allowed for a brief flight thus falls with the speed, at most
// like its square root if terms of order 4 and higher matter.
bool BatchSimulator::BatchRun::is_brief() const {
    const EventStart& start = request->starts.front();
    if (start.multiplicity != 1 || !(0.0 < start.gap.hdot && start.gap.hdot <= before.hdot)) return false;
    constexpr double room = 1.2;
    const double slower = start.gap.hdot / before.hdot;
    return room * slower * before.duration * before.duration <= before.brief * before.brief;
}

// Puts the run into a queue for the lanes, or steps it by its own stepper until a queue can take it. A step in contact
// that the lanes refused is made alone once, except on the way to a Zeno point. A flight from the surface is stepped
// alone until its gap is known to be open. Otherwise the rest of the segment is (BatchRun::alone).
void BatchSimulator::go_on(BatchRun& member, bool refused) {
    ExecutionAutomaton& run = member.execution;
    while ((member.request = run.next()) != nullptr) {
        const bool flying = member.request->mode.is_free();
        if (member.request->begins || (member.leaves && member.request->plain)) member.alone = member.leaves = false;
        if (member.request->plain && !member.alone && !refused) {
            const Kind kind = !flying ? Kind::contact : member.is_brief() ? Kind::brief_flight : Kind::flight;
            return groups_[static_cast<std::size_t>(kind)].queue.push_back(&member);
        }
        member.before = {};
        StepRequest& own = member.own;
        own = *member.request;
        if (!member.alone) own.begins = true;  // its own stepper did not make the last step
        member.leaves = member.leaves || (flying && !refused && member.request->starts.front().multiplicity > 1);
        member.alone = !refused || flying || run.completing();
        refused = false;  // it concerned only the first request
        run.accept(member.stepper.step(own));
    }
    finish(member);
}

void BatchSimulator::finish(BatchRun& member) {
    Trajectory trajectory = member.execution.finish();
    // The longer steps of simulate() may be accurate enough to decide.
    if (trajectory.outcome.kind == Outcome::Kind::undecided)
        trajectory = simulate(model_, member.execution.run(), nullptr, Recording::final_state);
    share_->take(member.index, std::move(trajectory));
    spare_.push_back(&member);
}

// Loads runs from the queue into idle lanes. All have the same tolerance, because a vector step has one order. The
// lanes that stay idle get the request of another run.
void BatchSimulator::fill_lanes(RunGroup& group, bool flying) {
    if (group.taken < lanes && !group.queue.empty()) {
        const BatchRun& first = group.taken > 0 ? group.first() : *group.queue.front();
        const double tolerance = first.execution.run().options.tolerance;
        group.step.error_per_step = integration_error(first.execution.run().options, 1.0);
        std::size_t lane = 0;
        std::erase_if(group.queue, [&](BatchRun* run) {
            if (group.taken == lanes || run->execution.run().options.tolerance != tolerance) return false;
            while (group.runs[lane] != nullptr) ++lane;
            group.runs[lane] = run;
            group.steps[lane] = 0;
            ++group.taken;
            load(group, lane, *run->request, flying);
            return true;
        });
    }
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        group.step.idle[lane] = group.runs[lane] == nullptr;
        if (group.step.idle[lane]) load(group, lane, *group.first().request, flying);
    }
}

void BatchSimulator::step(Kind kind) {
    RunGroup& group = groups_[static_cast<std::size_t>(kind)];
    const bool flying = kind != Kind::contact;
    fill_lanes(group, flying);
    LaneStepper& stepper = prepare(group);
    if (flying) {
        stepper.fly(group.step, kind == Kind::brief_flight);
    } else {
        stepper.stay(group.step, most_steps(group));
    }
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        if (group.runs[lane] == nullptr) continue;
        group.steps[lane] += flying ? 1 : group.step.steps;
        if (flying || !group.step.goes_on[lane] || group.steps[lane] >= group.runs[lane]->request->most)
            leave(group, lane, flying);
    }
}

// The run in this lane gets the result of its steps, and waits for others.
void BatchSimulator::leave(RunGroup& group, std::size_t lane, bool flying) {
    BatchRun& run = *group.runs[lane];
    const LaneStep& step = group.step;
    const EventStart& start = run.request->starts.front();
    run.before = {};
    if (step.end[lane] == LaneStep::LaneOutcome::impact && start.multiplicity == 1)
        run.before = {step.duration[lane], start.gap.hdot, step.brief[lane]};
    if (read(group, lane, flying)) run.execution.accept(result_);
    group.runs[lane] = nullptr;
    --group.taken;
    go_on(run, step.end[lane] == LaneStep::LaneOutcome::needs_scalar_step);
}

// The stepper for these runs, with their parameters in its lanes. Idle lanes repeat the first run.
LaneStepper& BatchSimulator::prepare(const RunGroup& group) {
    BatchRun& first = group.first();
    const auto run_in = [&](std::size_t lane) -> const BatchRun& {
        return group.runs[lane] != nullptr ? *group.runs[lane] : first;
    };
    const double tolerance = first.execution.run().options.tolerance;
    auto found = steppers_.find(tolerance);
    if (found == steppers_.end())
        found =
            steppers_
                .emplace(tolerance, StepperSlot{make_lane_stepper(model_->lane_programs(), tolerance, vectors_), {}})
                .first;
    StepperSlot& prepared = found->second;
    std::array<std::size_t, lanes> sets{};
    for (std::size_t lane = 0; lane < lanes; ++lane) sets[lane] = run_in(lane).set;
    if (prepared.sets == sets) return *prepared.stepper;
    prepared.sets = sets;
    std::vector<Double8> parameters(first.execution.run().parameters.size());
    for (std::size_t lane = 0; lane < lanes; ++lane)
        for (std::size_t i = 0; i < parameters.size(); ++i)
            parameters[i][lane] = run_in(lane).execution.run().parameters[i];
    prepared.stepper->fix(parameters);
    return *prepared.stepper;
}

void BatchSimulator::load(RunGroup& group, std::size_t lane, const StepRequest& request, bool flying) {
    LaneStep& step = group.step;
    const auto n = request.state.q.size();
    for (Eigen::Index i = 0; i < n; ++i) {
        step.q_and_v[static_cast<std::size_t>(i)][lane] = request.state.q[i];
        step.q_and_v[static_cast<std::size_t>(n + i)][lane] = request.state.v[i];
    }
    const EventStart& start = request.starts.front();
    const auto& gap = start.gap;
    step.t[lane] = request.state.t;
    step.until[lane] = request.until;
    step.state_error[lane] = gap.state_error;
    step.least_gap[lane] = std::numeric_limits<double>::infinity();
    if (!flying) return;
    step.h[lane] = gap.h;
    step.hdot[lane] = gap.hdot;
    step.error[lane] = gap.error;
    step.rate_error[lane] = gap.rate_error;
    step.known[lane] = start.multiplicity;
}

// The smallest number of steps that one of these runs may still make.
long BatchSimulator::most_steps(const RunGroup& group) {
    long most = std::numeric_limits<long>::max();
    for (std::size_t lane = 0; lane < lanes; ++lane)
        if (group.runs[lane] != nullptr) most = std::min(most, group.runs[lane]->request->most - group.steps[lane]);
    return most;
}

// Reads the result of the plain steps in a lane; false if there was none.
bool BatchSimulator::read(const RunGroup& group, std::size_t lane, bool flying) {
    const LaneStep& step = group.step;
    const bool plain = step.end[lane] != LaneStep::LaneOutcome::needs_scalar_step;
    result_.steps = plain ? group.steps[lane] : group.steps[lane] - 1;
    if (result_.steps == 0) return false;
    const auto n = end_.q.size();
    for (Eigen::Index i = 0; i < n; ++i) {
        end_.q[i] = step.q_and_v[static_cast<std::size_t>(i)][lane];
        end_.v[i] = step.q_and_v[static_cast<std::size_t>(n + i)][lane];
    }
    end_.t = step.t[lane];
    result_.state = &end_;
    result_.duration = step.duration[lane];
    result_.gap = flying ? step.end_h[lane] : step.least_gap[lane];
    result_.evaluations = result_.steps;
    result_.end = StepResult::StepOutcome::no_event;
    if (step.end[lane] == LaneStep::LaneOutcome::impact) {
        result_.end = StepResult::StepOutcome::impact;
        read_contact(step, lane);
    } else {
        result_.starts.front() = {};
        if (flying) read_gap(step, lane, *group.runs[lane]);
    }
    return true;
}

void BatchSimulator::read_contact(const LaneStep& step, std::size_t lane) {
    Contact& contact = result_.contact;
    contact.h = step.end_h[lane];
    contact.hdot = step.end_hdot[lane];
    contact.W = step.end_W[lane];
    contact.gap_t = step.end_gap_t[lane];
    const auto n = static_cast<Eigen::Index>(step.impulse_direction.size());
    contact.impulse_direction.resize(n);
    contact.g.resize(n);
    for (std::size_t i = 0; i < step.impulse_direction.size(); ++i) {
        contact.impulse_direction.data()[i] = step.impulse_direction[i][lane];
        contact.g.data()[i] = step.g[i][lane];
    }
}

// The gap at the end of a step without event: from its series, or evaluated there if that is more accurate.
void BatchSimulator::read_gap(const LaneStep& step, std::size_t lane, BatchRun& run) {
    Gap& gap = result_.starts.front().gap;
    gap = {step.h[lane], step.hdot[lane], step.error[lane], step.rate_error[lane], step.state_error[lane]};
    const double off = step.end_h[lane] - gap.h;
    if (!(std::abs(off) > 2.0 * step.rounding[lane])) return;
    read_contact(step, lane);
    if (run.surfaces.of(0).within_gap_error(off, 4.0, result_.contact, end_)) return;
    gap.h = step.end_h[lane];
    gap.hdot = step.end_hdot[lane];
}

}  // namespace achilles
