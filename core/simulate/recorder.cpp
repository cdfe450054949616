#include "simulate/recorder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

namespace achilles {

Recorder::Recorder(std::shared_ptr<const Model> model, const Run& run, Recording keep)
    : keep_(keep), work_(*model, run) {
    if (keep_ == Recording::full) energy_ = model->evaluator(model->energy(), run.parameters);
    restart(std::move(model), run);
}

void Recorder::restart(std::shared_ptr<const Model> model, const Run& run) {
    trajectory_ = {};
    trajectory_.model = std::move(model);
    trajectory_.run = run;
    trajectory_.phases.reserve(8);
    any_gap_ = false;
    inactive_ = latched_ = {};
    largest_ = largest_change_ = 0.0;
    if (keep_ == Recording::final_state) {
        if (work_.any()) trajectory_.work = std::numeric_limits<double>::quiet_NaN();
        if (trajectory_.model->has_jumps()) trajectory_.loss = std::numeric_limits<double>::quiet_NaN();
        trajectory_.passages.reserve(32);
        return;
    }
    // Capacity for a typical run. With less than 128 kB in all, glibc returns no memory to the system between two runs.
    trajectory_.events.reserve(36);
    trajectory_.pieces.reserve(80);
    trajectory_.coefficients.reserve(8192);
}

namespace {

// Reserves room for `more` elements. The system provides memory only for pages that are written, so a vector grows by a
// large factor, which copies it rarely. Growing a vector briefly needs the memory of both copies. A large vector
// therefore reserves address space for all that the run may record; with addresses of 32 bits (on a page) there is none
// to spare.
template <class Element>
void make_room(std::vector<Element>& vector, std::size_t more, double max_bytes) {
    constexpr std::size_t large = std::size_t{8} << 20;  // bytes
    constexpr bool has_space_to_spare = sizeof(void*) >= 8;
    if (vector.capacity() - vector.size() >= more) return;
    const std::size_t size = vector.size() * sizeof(Element), factor = 4 * size < large ? 4 : 2;
    const std::size_t enlarged = factor * vector.size() + more;
    if (has_space_to_spare && enlarged * sizeof(Element) > large && size < large) {
        try {
            constexpr double max_address_space = 1e12;
            const double elements = std::min(max_bytes, max_address_space) / sizeof(Element);
            return vector.reserve(std::max(enlarged, static_cast<std::size_t>(elements) + more));
        } catch (const std::bad_alloc&) {  // the process may not have that much address space: grow stepwise
        }
    }
    vector.reserve(enlarged);
}

}  // namespace

double Recorder::bytes() const { return bytes_of(trajectory_); }

void Recorder::go_back(const Checkpoint& mark) {
    trajectory_.pieces.resize(mark.pieces);
    trajectory_.coefficients.resize(mark.coefficients);
    trajectory_.statistics = mark.statistics;
    scale_ = mark.scale;
    largest_change_ = mark.largest_change;
    trajectory_.work = mark.work;
    trajectory_.heat = mark.heat;
    any_gap_ = mark.any_gap;
}

void Recorder::open(Mode mode, ContactSet load_bearing, double t) {
    Phase phase;
    phase.kind = mode.is_free() ? Phase::Kind::hybrid : Phase::Kind::constrained;
    phase.mode = mode;
    phase.load_bearing = load_bearing;
    phase.start = phase.end = t;
    phase.first_piece = phase.last_piece = trajectory_.pieces.size();
    trajectory_.phases.push_back(phase);
}

void Recorder::continue_phase(ContactSet load_bearing) {
    Phase& phase = trajectory_.phases.back();
    if (load_bearing != phase.mode.held()) phase.load_bearing = load_bearing;
}

void Recorder::close(double t) {
    trajectory_.phases.back().end = t;
    trajectory_.phases.back().last_piece = trajectory_.pieces.size();
}

void Recorder::stretch(const State& state) {
    if (keep_ == Recording::final_state) return;
    set_state(energy_, state);
    energy_.run();
    reference_ = energy_.total() - trajectory_.work + trajectory_.heat;
    scale_ = std::abs(energy_.kinetic()) + std::abs(energy_.potential());
}

void Recorder::steps(long count, double least_gap) {
    Statistics& statistics = trajectory_.statistics;
    statistics.steps += count;
    statistics.least_gap = any_gap_ ? std::min(statistics.least_gap, least_gap) : least_gap;
    any_gap_ = true;
}

void Recorder::step(const Flow& flow, double gap, Mode mode) {
    steps(1, gap);
    if (keep_ == Recording::final_state) return;
    Statistics& statistics = trajectory_.statistics;
    // An upper bound on the coefficients of one step.
    const std::size_t max_coefficients = 128 * static_cast<std::size_t>(trajectory_.run.q.size());
    const double memory = trajectory_.run.options.memory;
    make_room(trajectory_.coefficients, max_coefficients, memory);
    make_room(trajectory_.pieces, 1, memory);
    DenseSegment& piece = trajectory_.pieces.emplace_back(flow.piece(trajectory_.coefficients));
    piece.mode = mode;
    piece.inactive = inactive_;
    piece.latched = latched_;
    piece.work = trajectory_.work;
    piece.loss = trajectory_.loss;
    piece.heat = trajectory_.heat;
    if (work_.any()) {
        const auto expanded = flow.energy_flow();
        const EnergyFlow done = expanded ? *expanded : work_.along(piece, trajectory_.coefficients, piece.end);
        trajectory_.work += done.work;
        trajectory_.heat += done.heat;
    }
    set_state(energy_, flow.end());
    energy_.run();
    // The drift is relative to the largest |T| + |V| so far, because at an instant the sum and each part may be 0.
    scale_ = std::max(scale_, std::abs(energy_.kinetic()) + std::abs(energy_.potential()));
    largest_ = std::max(largest_, scale_ + std::abs(trajectory_.work));
    // At rest, only the rounding of earlier energies remains.
    const double change = std::abs(energy_.total() - trajectory_.work + trajectory_.heat - reference_);
    if (!(change > 0x1p-60 * largest_)) return;
    // A drive may exchange much energy while T and V are small, and all of these may be 0 before it starts. The change
    // is then compared with the largest energy of the whole run.
    if (work_.any())
        largest_change_ = std::max(largest_change_, change);
    else
        statistics.energy_drift = std::max(statistics.energy_drift, change / scale_);
}

Exchange Recorder::exchange_of_jump(const State& before, const State& after, double work) {
    if (keep_ == Recording::final_state) return {work, 0.0};
    const auto energy_at = [&](const State& state) {
        set_state(energy_, state);
        energy_.run();
        return energy_.total();  // the position jumps, too, if a pair comes to rest
    };
    return {work, work + energy_at(before) - energy_at(after)};
}

void Recorder::add(const Exchange& exchange) {
    trajectory_.work += exchange.work;
    trajectory_.loss += exchange.loss;
    trajectory_.heat += exchange.heat;
}

void Recorder::impact(const State& before, const Vector& v_after, double speed, const Exchange& exchange,
                      ContactSet contacts, std::shared_ptr<const MultiContactInfo> joint) {
    ++trajectory_.statistics.impacts;
    ++trajectory_.phases.back().impacts;
    add(exchange);
    if (keep_ == Recording::final_state) {
        trajectory_.passages.push_back({{Event::Kind::impact}, contacts, before.t, speed, -1});
        return;
    }
    make_room(trajectory_.events, 1, trajectory_.run.options.memory);
    Event& event = trajectory_.events.emplace_back();
    event.kind = Event::Kind::impact;
    event.t = before.t;
    event.q = before.q;
    event.v_before = before.v;
    event.v_after = v_after;
    event.impact_speed = speed;
    event.contacts = contacts;
    event.mode = trajectory_.phases.back().mode;
    event.inactive = inactive_;
    event.latched = latched_;
    if (joint && joint->order_matters) ++trajectory_.ambiguous_impacts;
    event.joint = std::move(joint);
    event.work = trajectory_.work;
    event.loss = trajectory_.loss;
    event.heat = trajectory_.heat;
}

void Recorder::friction_at_impact(std::shared_ptr<const Event::FrictionImpulses> friction) {
    if (keep_ == Recording::full) trajectory_.events.back().friction = std::move(friction);
}

void Recorder::after_impact(ContactSet opened, Mode mode) {
    if (keep_ == Recording::final_state) return;
    trajectory_.events.back().opened = opened;
    trajectory_.events.back().mode = mode;
    trajectory_.events.back().latched = latched_;
}

void Recorder::jump(Event&& event, const Exchange& exchange) {
    trajectory_.work += exchange.work;
    trajectory_.loss += exchange.loss;
    this->event(std::move(event));
}

void Recorder::after_jumps(std::size_t count, Mode mode) {
    if (keep_ == Recording::final_state) return;
    for (auto event = trajectory_.events.rbegin(); count > 0; ++event) {
        if (!event->is_jump()) continue;
        event->mode = mode;
        event->inactive = inactive_;
        event->latched = latched_;
        --count;
    }
}

void Recorder::event(Event&& event) {
    if (keep_ == Recording::final_state) {
        const int jump = event.jump ? static_cast<int>(event.jump->number) : -1;
        trajectory_.passages.push_back({{event.kind}, event.contacts, event.t, 0.0, jump});
        return;
    }
    event.inactive = inactive_;
    event.latched = latched_;
    event.work = trajectory_.work;
    event.loss = trajectory_.loss;
    event.heat = trajectory_.heat;
    if (event.is_zeno()) event.impacts = trajectory_.phases.back().impacts;
    make_room(trajectory_.events, 1, trajectory_.run.options.memory);
    trajectory_.events.push_back(std::move(event));
}

Trajectory Recorder::finish(const State& state, Outcome outcome, long evaluations) {
    close(state.t);
    trajectory_.end_time = state.t;
    trajectory_.end = state;
    trajectory_.end_phase = phase();
    trajectory_.end_mode = trajectory_.phases.back().mode;
    trajectory_.end_inactive = inactive_;
    trajectory_.end_latched = latched_;
    trajectory_.outcome = std::move(outcome);
    trajectory_.statistics.evaluations = evaluations;
    if (largest_change_ > 0.0) trajectory_.statistics.energy_drift = largest_change_ / largest_;
    return std::move(trajectory_);
}

}  // namespace achilles
