// Studies of a session: sweep, proof, sensitivities, periodic orbit.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "expression/parse.hpp"
#include "figure/sweep_figure.hpp"
#include "journal/journal.hpp"
#include "session/command.hpp"
#include "session/session.hpp"
#include "session/study_jobs.hpp"

namespace achilles {

// ---- sweep ----

namespace {

constexpr std::uint64_t points = 512;  // along an axis, at the finest level

// The text may not set values or options: those come from the current run.
SweepSpec sweep_of(const std::string& text, const SystemDescription& description) {
    SweepSpec sweep = read_sweep(text, description);
    if (sweep.base != default_run(description))
        throw refusal("--set and the options of a run are not allowed here", "the sliders set what does not vary");
    if (sweep.axes.size() > 2) throw refusal("at most two axes can be shown");
    if (sweep.count() > max_drawn_rows)
        throw refusal(
            fmt::format("a sweep of {} points cannot be drawn: at most {} can be", sweep.count(), max_drawn_rows),
            "achilles sweep --csv F writes it as a table");
    return sweep;
}

}  // namespace

std::string default_sweep(const SystemDescription& description) {
    std::vector<const ParameterDescription*> order;
    for (const ParameterDescription& parameter : description.parameters) order.push_back(&parameter);
    const auto restitutes = [&](const ParameterDescription* parameter) {
        return std::any_of(description.constraints.begin(), description.constraints.end(), [&](const auto& constraint) {
            const std::vector<std::string> names = names_in(constraint.restitution.text);
            return std::find(names.begin(), names.end(), parameter->name) != names.end();
        });
    };
    std::stable_partition(order.begin(), order.end(), restitutes);
    SweepSpec sweep;
    sweep.base = default_run(description);
    if (!order.empty()) {
        const ParameterDescription& first = *order.front();
        sweep.axes.push_back({first.name, first.range[0], first.range[1], points, false});
    } else {
        const CoordinateDescription& first = description.coordinates.front();
        sweep.axes.push_back({first.name + "'", first.rate_range[0], first.rate_range[1], points, false});
    }
    sweep.prints = {"zeno_time(1)"};
    return to_text(sweep, description);
}

std::string Session::sweep_text() const { return scene_.sweep().value_or(default_sweep(description())); }

SweepSpec Session::sweep() const {
    SweepSpec sweep = sweep_of(sweep_text(), description());
    sweep.base = requested_run_;
    return sweep;
}

// Throws InputError if the sweep cannot be made with the options of the current run.
void Session::check_sweep(const std::string& text) const {
    SweepSpec sweep = sweep_of(text, description());
    sweep.base.options = requested_run_.options;
    if (library_.budget) library_.budget->check(sweep);
    const RunMeasures measures(system_->model, sweep);
}

void Session::perform(const command::ShowSweep& command) {
    or_refuse<command::ShowSweep>([&] { check_sweep(command.text); });
    scene_.perform(command);
}

void Session::keep_sweep() {
    if (scene_.sweep() && !passes([&] { check_sweep(*scene_.sweep()); })) scene_.forget_sweep();
}

void Session::follow_sweep() {
    if (scene_.shows("sweep"))
        sweep_job_->ask(system_->model, sweep());
    else
        sweep_job_->pause();
    sweep_job_->update(0.0);
}

void Session::settle() {
    receive_pins({});
    receive({});
    follow_curves({});
    receive_proof({});
    receive_estimate({});
    follow_proof_behind({});
    sweep_job_->update({});
    follow_dependence({});
    receive_orbit({});
}

// ---- proof of the current run ----

const Proof* Session::proof() const {
    const Proof* const proof = proof_job_->result().get();
    const bool is_its = proof != nullptr && proof_job_->model() == trajectory().model && !shows_start() &&
                        same_to_a_proof(proof->claim.run, trajectory().run);
    return is_its ? proof : nullptr;
}

const ProofMonitor* Session::proof_under_way() const { return proof_job_->under_way(); }

std::optional<command::Prove> Session::proof_command() const {
    if (proof_request_) return prove_command(proof_request_->spread);
    return proof() == nullptr ? std::nullopt : std::optional(prove_command(proof()->spread));
}

void Session::perform(const command::Prove& command) {
    InitialUncertainty spread;
    spread.width = command.width;
    for (const std::string& interval : command.intervals) {
        const auto side = parse_interval(interval, description());
        if (!side)
            throw refusal(fmt::format("'{}' is not an interval", interval), std::string(command::Prove::spec.usage));
        const double present = *value(side->name);
        if (!(side->low <= present && present <= side->high))
            throw refusal(fmt::format("{} = {} in the present run is not in [{}, {}]", side->name, present, side->low,
                                      side->high));
        spread.sides.push_back(*side);
    }
    check(*system_->model, problem_of(description(), requested_run_, spread));
    proof_job_->forget();
    proof_request_ = ProofRequest{system_, requested_run_, spread};
    follow_proof(patience_);
    compose_pinned();
}

void Session::perform(const command::StopProof&) {
    stop_proof_behind();
    proof_request_.reset();
    proof_job_->forget();
    compose_pinned();
}

// Drops a request for another run than the current one; starts the proof once its run is finished. Throws InputError if
// proofs do not cover the system.
void Session::follow_proof(Timeout patience) {
    if (proof_request_ &&
        (proof_request_->system != system_ || !same_to_a_proof(proof_request_->run, requested_run_))) {
        proof_request_.reset();
        proof_job_->stop();
    }
    try {
        if (proof_request_ && watch_ == nullptr && proof_job_->under_way() == nullptr)
            proof_job_->begin(system_->model, proof_request_->spread,
                              problem_to_draw(trajectory(), proof_request_->spread));
        if (!proof_job_->update(patience)) return;
        proof_request_.reset();
        compose_pinned();
    } catch (const InputError&) {
        proof_request_.reset();
        throw;
    } catch (const std::bad_alloc&) {
        proof_request_.reset();
        throw refusal("there is not enough memory for a proof of this run");
    }
}

void Session::receive_proof(Timeout patience) {
    try {
        follow_proof(patience);
    } catch (const InputError& problem) {
        error_ = problem.what();
    }
}

// ---- the proof behind the run ----

const Proof* Session::shown_proof() const {
    if (const Proof* const requested = proof()) return requested;
    const Proof* const behind = proof_behind_job_->result().get();
    // One that stops at its limit of steps says nothing about the run.
    const bool is_its = behind != nullptr && run_proved_behind_ == simulated_ && behind->enclosure.end;
    return is_its ? behind : nullptr;
}

void Session::stop_proof_behind() {
    if (simulated_ == nullptr || proof() == nullptr) enclosed_.clear();  // they are events of the proof that ends here
    proof_behind_job_->forget();
    run_proved_behind_.reset();
}

// Starts the proof once the run and its estimate are finished; the estimate waits until the run is on the screen. The
// next run stops the proof.
void Session::follow_proof_behind(Timeout patience) {
    constexpr int most_steps = 150;  // about 0.1 s for two coordinates
    if (!proves_behind_) return;
    const bool is_wanted = watch_ == nullptr && simulated_->estimate && !shows_start() && !proof_request_ &&
                           proof() == nullptr && !first_unproved(system_->model->description());
    if (!is_wanted) return stop_proof_behind();
    try {
        if (run_proved_behind_ != simulated_) {
            Run run = trajectory().run;
            run.options.max_steps = std::min(run.options.max_steps, most_steps);
            run_proved_behind_ = simulated_;
            proof_behind_job_->begin(system_->model, {}, problem_of(description(), run, {}));
        }
        if (!proof_behind_job_->update(patience)) return;
    } catch (const InputError&) {  // no proof covers this run; "Prove this run" says why
        return;
    } catch (const std::bad_alloc&) {
        return;
    }
    compose_pinned();
}

// ---- sensitivities of a quantity of the current run ----

std::string Session::depend_text() const { return scene_.depends().value_or(simulated_->quantity); }

bool Session::sensitivities_are_current() const {
    const Sensitivities* const known = sensitivities();
    return known != nullptr && watch_ == nullptr && known->run.get() == &trajectory() &&
           known->quantity.expression == depend_text();
}

void Session::perform(const command::ShowSensitivity& command) {
    or_refuse<command::ShowSensitivity>([&] { check_quantity(command.quantity); });
    scene_.perform(command);
}

void Session::check_quantity(const std::string& quantity) const {
    const Text text{quantity, {}};
    system_->model->compile_measures({&text, 1});
}

void Session::keep_dependence() {
    if (scene_.depends() && !passes([&] { check_quantity(*scene_.depends()); })) scene_.forget_dependence();
}

// True if they are shown, or if they are the slope of the curve that the sweep shows.
bool Session::wants_sensitivities() const {
    if (scene_.shows("depend") || !scene_.shows("sweep")) return scene_.shows("depend");
    const SweepSpec shown = sweep();
    return shown.axes.size() == 1 && !shown.at && shown.prints.front() == depend_text();
}

// Follows the run that is shown. What takes less than half a frame is available in the same frame.
void Session::follow_dependence(Timeout patience) {
    constexpr double glance = 0.008;
    if (!wants_sensitivities() || shows_start()) return sensitivities_job_->forget();
    const bool is_new = sensitivities_job_->ask({simulated_, &simulated_->trajectory}, depend_text());
    sensitivities_job_->update(is_new && patience ? glance : patience);
}

std::optional<TangentLine> Session::sweep_tangent() const {
    if (!sensitivities_are_current()) return std::nullopt;
    const SweepSpec shown = sweep();
    if (shown.axes.size() != 1 || shown.at || shown.prints.front() != sensitivities()->quantity.expression)
        return std::nullopt;
    const SweepAxis& axis = shown.axes.front();
    const Sensitivities::Sensitivity* const by = sensitivities()->find(axis.name);
    if (by == nullptr || !std::isfinite(by->derivative)) return std::nullopt;
    return TangentLine{*value(axis.name), sensitivities()->quantity.value, by->derivative, axis.logarithmic};
}

// ---- periodic orbit near the current run, and its branch ----

namespace {

bool have_same_start(const Run& a, const Run& b) {
    return a.q == b.q && a.v == b.v && a.parameters == b.parameters && a.options.start_time == b.options.start_time;
}

}  // namespace

std::shared_ptr<const OrbitJobResult> Session::orbit() const { return orbit_job_->result(); }

const OrbitMonitor* Session::orbit_under_way() const { return orbit_job_->under_way(); }

void Session::receive_orbit(Timeout patience) {
    try {
        orbit_job_->update(patience);
    } catch (const InputError& problem) {
        error_ = problem.what();
    }
}

void Session::perform(const command::FindOrbit& command) {
    or_refuse<command::FindOrbit>([&] {
        orbit_job_->begin(system_->model, command.text, requested_run_,
                          parse_orbit_request(read_orbit(command.text), requested_run_, system_->model));
    });
    scene_.perform(command::Show{"orbit", true});
    receive_orbit(patience_);
}

void Session::perform(const command::StopOrbit&) { orbit_job_->forget(); }

void Session::perform(const command::SelectBranchPoint& command) {
    const auto found = orbit();
    if (found == nullptr || found->count() == 0)
        throw refusal(orbit_under_way() != nullptr ? "the search for a periodic run is under way"
                                                   : "no periodic run has been found yet",
                      "orbit \"\" searches for one");
    if (command.point < 1 || static_cast<std::size_t>(command.point) > found->count())
        throw refusal(fmt::format("the branch has no point {}: its points are numbered from 1 to {}", command.point,
                                  found->count()));
    rerun(run_on(found->point(static_cast<std::size_t>(command.point) - 1), requested_run_));
}

std::optional<std::size_t> Session::orbit_point() const {
    const auto found = orbit();
    for (std::size_t i = 0; found != nullptr && i < found->count(); ++i)
        if (have_same_start(run_on(found->point(i), requested_run_), requested_run_)) return i;
    return std::nullopt;
}

std::optional<command::FindOrbit> Session::orbit_command() const {
    const auto found = orbit();
    if (found == nullptr) return std::nullopt;
    if (have_same_start(found->base, requested_run_)) return command::FindOrbit{found->text};
    if (!orbit_point()) return std::nullopt;
    OrbitOptions typed = read_orbit(found->text);
    typed.from = "start";
    return command::FindOrbit{to_text(typed)};
}

}  // namespace achilles
