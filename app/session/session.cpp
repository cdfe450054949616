#include "session/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <new>
#include <utility>

#include "expression/name_suggestions.hpp"
#include "expression/parse.hpp"
#include "figure/mechanism_scene.hpp"
#include "figure/plane.hpp"
#include "journal/journal.hpp"
#include "model/model.hpp"
#include "model/read_system.hpp"
#include "session/command.hpp"
#include "session/study_jobs.hpp"
#include "simulate/sampler.hpp"

namespace achilles {

Session::OpenSystem::OpenSystem(const std::string& name_as_opened, const SystemDescription& description)
    : name(name_as_opened),
      model(std::make_shared<const Model>(description)),
      mechanism(*model),
      file_run(model->default_run()) {}

namespace {

// The curves of a run of more steps take longer than a frame.
constexpr std::size_t most_exact_at_once = 1000;

}  // namespace

Session::FinishedRun::FinishedRun(std::shared_ptr<const OpenSystem> of, Trajectory made, const Plots& plotted,
                                  const Theme& theme, bool is_coarse_first)
    : trajectory(std::move(made)),
      system(std::move(of)),
      is_coarse(is_coarse_first && trajectory.pieces.size() > most_exact_at_once),
      sampler(trajectory),
      samples(plot_samples(trajectory)),
      scale(scale_of(trajectory)),
      least_gap(achilles::least_gap(trajectory)),
      remarks(achilles::remarks(trajectory)),
      sentences(trajectory, nullptr, EventDescriptions::Angles::degrees),
      quantity(default_quantity(trajectory)),
      mechanism_scene(std::make_unique<MechanismScene>(system->mechanism, trajectory, samples, is_coarse)),
      revision(plotted.revision()),
      dark(theme.dark),
      has_coarse_plots(is_coarse),
      plots(plotted.compose(trajectory, samples, theme, {}, {}, is_coarse)) {}

Session::FinishedRun::~FinishedRun() = default;

void Session::FinishedRun::turn(const std::optional<ViewAngles>& from) {
    if (from == direction) return;
    direction = from;
    mechanism_scene.reset();  // it refers to the mechanism
    turned = from ? std::make_unique<Mechanism>(*system->model, from) : nullptr;
    mechanism_scene = std::make_unique<MechanismScene>(mechanism(), trajectory, samples);
}

const Trail& Session::trail() const { return simulated_->mechanism_scene->trail(); }

const Drawing& Session::limits() const { return simulated_->mechanism_scene->limits(); }

Session::Session(const std::string& name, const SystemDescription& first, const Run& run, SystemSource library,
                 Timeout patience)
    : library_(std::move(library)),
      patience_(patience),
      document_{name, first.file == name ? name : "", first.file, first.source_text, first.source_text, {}},
      system_(std::make_shared<const OpenSystem>(name, first)),
      plots_(system_->model),
      orbit_job_(std::make_shared<OrbitJob>()) {
    change_system(system_, plots_, run);
}

bool Session::apply(const Command& command) {
    if (!patience_) {
        receive_pins(patience_);
        receive(patience_);
    }
    // What leaves the window has exact curves.
    const bool is_output =
        std::holds_alternative<command::Export>(command) || std::holds_alternative<command::Copy>(command);
    if (!patience_ || is_output) follow_curves({});
    const UndoState before = undo_state();
    const std::string noticed = std::exchange(notice_, {});
    const std::string failed = std::exchange(error_, {});
    warnings_.clear();
    try {
        std::visit([this](const auto& what) { perform(what); }, command);
        // Playback commands and the end of an edit must not clear the error of the last change.
        const bool changes_nothing = undo_policy_of(command) == command::UndoPolicy::none;
        if (changes_nothing && error_.empty()) error_ = failed;
        if (changes_nothing && notice_.empty()) notice_ = noticed;
        history_.remember(command, before, undo_state());
        follow_direction();
        follow_studies();
        return true;
    } catch (const PermissionDenied&) {
        throw;
    } catch (const InputError& problem) {
        error_ = problem.what();
        return false;
    }
}

void Session::follow_studies() {
    follow_sweep();
    follow_proof(0.0);
    // Batch replay waits for this, too: the result of a journal must not depend on timing.
    follow_dependence(patience_ ? Timeout(0.0) : patience_);
}

// Restores an earlier state.
void Session::restore(UndoState back) {
    document_ = std::move(back.document);
    placed_ = command::Seek{time_};
    if (!same_system(back.system->model->description(), description())) {
        cancel_pins();
        pinned_ = std::move(back.pinned);
    }
    if (back.system != system_) return change_system(back.system, back.plots, back.run);
    plots_ = back.plots;
    rerun(back.run);
}

void Session::perform(const command::Undo&) {
    if (!can_undo()) throw refusal("there is nothing to undo");
    // Back to the last valid system; invalid texts in between can only be redone.
    UndoState back = history_.undo(undo_state());
    while (!back.document.problems.empty() && can_undo()) back = history_.undo(std::move(back));
    restore(std::move(back));
}

void Session::perform(const command::Redo&) {
    if (!can_redo()) throw refusal("there is nothing to redo");
    restore(history_.redo(undo_state()));
}

void Session::perform(const command::Reset&) { rerun(system_->file_run); }

void Session::perform(const command::SetTheme& command) {
    theme_ = command.dark ? dark_theme() : light_theme();
    compose_plots();
}

void Session::perform(const command::Open& command) {
    begin_document(library_.open ? library_.open(command.system)
                                 : open_document(command.system, library_.find(command.system)));
}

void Session::perform(const command::New&) { begin_document(new_document()); }

// Takes a new text. If it is not a valid system, the editor shows the errors and the last system stays.
void Session::begin_document(Document document) {
    document_ = std::move(document);
    try {
        const SystemDescription description = parse_system(document_.text, document_.source);
        Run run = default_run(description);
        if (library_.finish) library_.finish(run.options);
        const auto system = std::make_shared<const OpenSystem>(document_.name, description);
        system->model->check(run);
        playing_ = false;
        choose(0);
        time_ = run.options.start_time;
        scene_.forget_place();
        placed_.reset();
        animation_.reset();
        drop_pinned_runs();
        change_system(system, Plots(system->model), run);
        for (const std::string& warning : outside_ranges(description, run)) warn(warning);
        for (const std::string& warning : unseen_lines(description)) warn(warning);
    } catch (const PermissionDenied&) {
        throw;
    } catch (const InputError& problem) {
        document_.problems = each_of(problem);
        scene_.perform(command::Show{"editor", true});
    }
}

void Session::perform(const command::SetText& command) {
    document_.text = command.text;
    read_document();
}

void Session::perform(const command::Save& command) {
    const std::string before = document_.source;
    if (!library_.saves_any_text && !document_.problems.empty())
        throw refusal("the text is not a valid system, and is not saved", document_.problems.front().what());
    if (library_.before_writing) library_.before_writing(command.file);
    if (library_.save)
        library_.save(document_, command.file, command.overwrite);
    else
        save(document_, command.file, command.overwrite);
    if (library_.after_writing) library_.after_writing(command.file);
    if (document_.source != before) read_document();  // with its new name in messages
}

void Session::perform(const command::Reload&) {
    if (document_.file.empty())
        throw refusal("this system has no file of its own to read again", "save it first, or open a file");
    const Document fresh =
        library_.open ? library_.open(document_.file) : open_document(document_.file, document_.file);
    document_.text = document_.saved = fresh.text;
    read_document();
}

// Applies the edited text if it is a valid system.
void Session::read_document() {
    document_.problems.clear();
    try {
        const SystemDescription description = parse_system(document_.text, document_.source);
        const auto system = std::make_shared<const OpenSystem>(document_.name, description);
        Run run = carried_over(this->description(), requested_run_, *system->model);
        try {
            system->model->check(run);
        } catch (const InputError&) {  // values set by the sliders do not fit the new text: use the text alone
            run = system->model->default_run();
            system->model->check(run);
        }
        placed_ = command::Seek{time_};
        if (!same_system(description, this->description())) drop_pinned_runs();
        change_system(system, plots_.carried_over(system->model), run);
    } catch (const PermissionDenied&) {
        throw;
    } catch (const InputError& problem) {
        document_.problems = each_of(problem);
    }
}

void Session::perform(const command::Turn& command) {
    if (!is_in_space())
        throw refusal("the mechanism of this system lies in a plane and cannot be turned",
                      "a system turns whose coordinates are x, y and z, or r, phi and z, of a point");
    scene_.perform(command);
}

void Session::perform(const command::ShowPlane& command) {
    or_refuse<command::ShowPlane>([&] { check_plane(command); });
    scene_.perform(command);
}

void Session::check_plane(const command::ShowPlane& plane) const { Plane(*system_->model, {plane.x, plane.y}); }

void Session::keep_plane() {
    if (scene_.plane() && !passes([&] { check_plane(*scene_.plane()); })) scene_.forget_plane();
}

// Shows the start of the system until its run is finished. The run must have a valid start.
void Session::change_system(const std::shared_ptr<const OpenSystem>& system, const Plots& plots, const Run& run) {
    if (library_.budget) library_.budget->check(run.options);  // before any change
    put_aside_pin();
    system_ = system;
    plots_ = plots;
    if (!is_in_space()) scene_.forget_direction();
    keep_plane();
    keep_sweep();
    keep_dependence();
    orbit_job_->forget();
    simulated_.reset();
    rerun(run);
    if (simulated_ != nullptr) return;
    std::stop_source at_once;
    at_once.request_stop();
    RunMonitor watch;
    watch.stop = at_once.get_token();
    simulated_ = std::make_shared<FinishedRun>(system_, simulate(system_->model, run, &watch), plots_, theme_);
    follow_direction();
    compose_pinned();
    move_to(run.options.start_time);
}

namespace {

// Throws if a value is given in a unit that does not fit the name.
void check_unit(const SystemDescription& description, const std::string& name, const command::ValueArgument& given) {
    if (given.text.empty()) return;
    try {
        read_number(given.text, unit_of(description, name));
    } catch (const ParseError& problem) {
        throw refusal(fmt::format("{}: {}", name, problem.what()));
    }
}

}  // namespace

void Session::perform(const command::Set& command) {
    perform(command::SetStart{{{command.name, command.value}}});
    for (const std::string& warning : warnings_) notice_ += (notice_.empty() ? "" : "; ") + warning;
}

void Session::perform(const command::Animate& command) {
    constexpr double usual_seconds = 5.0;
    if (!std::isfinite(command.to.value)) throw refusal(fmt::format("'{}' must be finite", command.name));
    check_unit(description(), command.name, command.to);
    perform(command::SetStart{{{command.name, command.from}}});  // also checks the name
    const double seconds = command.seconds > 0.0 ? command.seconds : usual_seconds;
    animation_ = {command.name, command.from.value, command.to.value, seconds, 0.0};
}

// Sends no notice: a drag makes many of these commands, and notices would flicker over the mechanism.
void Session::perform(const command::SetStart& command) {
    Run changed = run();
    for (const auto& [name, given] : command.values) {
        double* const found = find_value(description(), changed, name);
        if (found == nullptr) throw refusal(why_not_settable(description(), name));
        if (!std::isfinite(given.value)) throw refusal(fmt::format("'{}' must be finite", name));
        check_unit(description(), name, given);
        *found = given.value;
    }
    try {
        system_->model->check(changed);
    } catch (const InputError& problem) {  // the values are wrong, not the file, which runs
        std::string names;
        for (const auto& [name, given] : command.values)
            names += fmt::format("{}{} = {}", names.empty() ? "" : ", ", name, given.value);
        throw refusal(fmt::format("{}: {}", names, problem.message), problem.hint);
    }
    rerun(changed);
    for (const std::string& warning : outside_ranges(description(), changed))
        if (std::any_of(command.values.begin(), command.values.end(),
                        [&](const auto& value) { return warning.starts_with(value.first + " "); }))
            warnings_.push_back(warning);
}

std::optional<double> Session::value(const std::string& name) const {
    Run copy = run();
    const double* const found = find_value(description(), copy, name);
    return found == nullptr ? std::nullopt : std::optional(*found);
}

void Session::perform(const command::SetOption& command) {
    Run changed = run();
    for (std::size_t i = 0; i < command.values.size(); ++i) {
        const Option& option = options_set_by(command.name)[i];
        if (!is_valid_value(option, command.values[i]))
            throw refusal(fmt::format(fmt::runtime(option.error_text), to_text(command.values[i])));
        option.set(changed.options, command.values[i]);
    }
    const std::vector<std::string> before = achilles::warnings(run().options);
    rerun(changed);
    for (const std::string& warning : achilles::warnings(changed.options))
        if (std::find(before.begin(), before.end(), warning) == before.end()) warn(warning);
}

// Starts another run of the same model, without reading or deriving again.
void Session::rerun(const Run& run) {
    system_->model->check(run);
    if (library_.budget) library_.budget->check(run.options);
    put_aside_pin();
    stop_proof_behind();
    stop_followers();
    requested_run_ = run;
    const auto watch = std::make_shared<RunMonitor>();
    watch_ = watch;
    began_ = std::chrono::steady_clock::now();
    worker_->start([system = system_, run, plots = plots_, theme = theme_, watch,
                    is_coarse_first = patience_.has_value()](const std::stop_token& stop) {
        watch->stop = stop;
        Trajectory trajectory = simulate(system->model, run, watch.get());
        // Do not build plots of a long run that was stopped: the next run, or a closing window, would wait for them.
        if (stop.stop_requested()) return std::shared_ptr<FinishedRun>();
        return std::make_shared<FinishedRun>(system, std::move(trajectory), plots, theme, is_coarse_first);
    });
    receive(patience_);
    if (library_.budget && watch_ == nullptr) library_.budget->charge(trajectory());
}

double Session::seconds_under_way() const {
    return watch_ == nullptr ? 0.0 : std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
}

// Starts the error estimate of the newest run on a second thread, so that the next run does not wait. During a drag
// each value cancels the estimate of the run before it. At rest the estimate always finishes, so no picture depends on
// timing.
void Session::estimate(Timeout patience) {
    simulated_->is_estimated = true;
    estimator_->start(
        [run = simulated_](const std::stop_token& stop) { return estimate_error(run->trajectory, stop); });
    receive_estimate(patience);
}

// Replaces coarse curves by exact ones. They, and the error estimate of such a run, begin when the coarse ones are on
// the screen, so that they do not delay them. Plots that were composed meanwhile for a command are exact already. The
// trail of a scene that was turned is exact, too.
void Session::follow_curves(Timeout patience) {
    if (!has_coarse_curves() || (patience && watch_ != nullptr)) {
        curves_worker_->take(0.0);  // what a stopped job has left
        return;
    }
    if (patience && !is_on_screen()) return;
    if (run_made_exact_ != simulated_) {
        run_made_exact_ = simulated_;
        curves_worker_->start([run = simulated_, limits = limits(), plots = plots_,
                               theme = theme_](const std::stop_token& stop) -> std::shared_ptr<ExactCurves> {
            auto curves = std::make_shared<ExactCurves>();
            curves->trail = trail_of(run->system->mechanism, run->trajectory, run->samples, limits);
            if (stop.stop_requested()) return nullptr;
            curves->plots = plots.compose(run->trajectory, run->samples, theme);
            return curves;
        });
        if (!simulated_->is_estimated) estimate(0.0);
    }
    try {
        const auto made = curves_worker_->take(patience);
        if (!made || *made == nullptr) return;
        if (simulated_->turned == nullptr) simulated_->mechanism_scene->refine(std::move((*made)->trail));
        if (std::exchange(simulated_->has_coarse_plots, false)) simulated_->plots = std::move((*made)->plots);
    } catch (const std::bad_alloc&) {
        error_ = "there is not enough memory for the exact curves of this run; coarse curves are shown";
    }
    run_made_exact_.reset();
    simulated_->is_coarse = false;
    compose_pinned();
}

// Whether a window has shown the newest run since it came. What only follows it would delay that picture.
bool Session::is_on_screen() const {
    constexpr int updates_of_a_frame = 2;  // a window makes the lists of a frame again after a command
    return simulated_->updates >= updates_of_a_frame;
}

// Another run is about to start: it should not wait for what follows this one.
void Session::stop_followers() {
    if (run_made_exact_ != nullptr)
        curves_worker_->start([](const std::stop_token&) { return std::shared_ptr<ExactCurves>(); });
    run_made_exact_.reset();
    if (simulated_ == nullptr || !simulated_->is_estimated || simulated_->estimate) return;
    simulated_->is_estimated = false;
    estimator_->start([](const std::stop_token&) { return ErrorEstimate(); });
}

void Session::receive_estimate(Timeout patience) {
    if (simulated_->estimate || shows_start()) return;
    if (!simulated_->is_estimated) {
        // On a few cores it would delay the first picture of the run, and the next run is waited for.
        if (patience && (watch_ != nullptr || has_coarse_curves() || !is_on_screen())) return;
        return estimate(patience);
    }
    try {
        simulated_->estimate = estimator_->take(patience);
    } catch (const std::bad_alloc&) {
        simulated_->estimate.emplace().no_estimate_reason = "there was not enough memory for it";
    } catch (const InputError& problem) {
        simulated_->estimate.emplace().no_estimate_reason = problem.message;
    }
    if (simulated_->estimate) use_horizon();
}

// Applies the error estimate: numbers get the digits it justifies, and curves are pale after the horizon.
void Session::use_horizon() {
    simulated_->sentences.take(*simulated_->estimate);
    for (PinnedRun& run : pinned_)
        if (run.estimate.get() == &simulated_->estimate) run.revision = -1;
    if (const auto remark = horizon_remark(trajectory(), *simulated_->estimate)) {
        simulated_->remarks.insert(simulated_->remarks.begin(), *remark);
        simulated_->revision = -1;
        compose_plots();
    } else if (!pinned_.empty()) {
        compose_pinned();
    }
}

void Session::receive(Timeout patience) {
    if (watch_ == nullptr) return;
    std::optional<std::shared_ptr<FinishedRun>> motion;
    const auto keep_previous = [this](const std::string& problem) {
        watch_.reset();
        requested_run_ = simulated_->trajectory.run;
        error_ = problem;
        if (!has_coarse_curves() && !simulated_->is_estimated) estimate(0.0);
    };
    try {
        motion = worker_->take(patience);
    } catch (const std::bad_alloc&) {  // without a previous run the session cannot continue
        if (simulated_ == nullptr) throw;
        keep_previous("there is not enough memory for this run; the previous run is kept. Use an earlier end time");
    } catch (const InputError& problem) {  // a page does not wait for a long run
        if (simulated_ == nullptr) throw;
        keep_previous(problem.what());
    }
    if (!motion) return;
    const bool is_at_event = selected_ > 0 && simulated_ != nullptr && selected_ <= std::ssize(trajectory().events) &&
                             time_ == trajectory().events[static_cast<std::size_t>(selected_ - 1)].t;
    simulated_ = *motion;
    follow_direction();
    watch_.reset();
    if (!patience_) estimate({});  // otherwise once it is on the screen
    try {
        if (pin_waits_) pin(*std::exchange(pin_waits_, std::nullopt), pin_requests_, simulated_);
    } catch (const InputError& problem) {
        error_ = problem.what();
    }
    compose_plots();  // the plots may have changed meanwhile
    compose_pinned();
    keep_choice(is_at_event);
    if (!placed_) return;
    // A time requested before this run was known is clamped to it, without a warning.
    Command placed = *std::exchange(placed_, std::nullopt);
    if (auto* const seek = std::get_if<command::Seek>(&placed))
        seek->time = std::clamp(seek->time, run().options.start_time, trajectory().end_time);
    apply(placed);
}

void Session::warn(const std::string& warning) {
    warnings_.push_back(warning);
    notice_ += (notice_.empty() ? "" : "; ") + warning;
}

std::vector<double> Session::values(std::size_t plot, const Sample& sample) const {
    return values_at(simulated_->trajectory, sample, *plots_.list()[plot].prepared);
}

std::vector<double> Session::errors(std::size_t plot, const Sample& sample) const {
    return errors_at(simulated_->trajectory, sample, *plots_.list()[plot].prepared, precision());
}

template <class OtherCommand>
void Session::perform(const OtherCommand& command) {
    if constexpr (requires { scene_.perform(command); }) {
        scene_.perform(command);
    } else {
        plots_.perform(command);
        compose_plots();
    }
}

void Session::compose_plots() {
    if (simulated_->revision == plots_.revision() && simulated_->dark == theme_.dark) return;
    simulated_->revision = plots_.revision();
    simulated_->dark = theme_.dark;
    simulated_->plots = plots_.compose(simulated_->trajectory, simulated_->samples, theme_, horizon());
    simulated_->has_coarse_plots = false;
    compose_pinned();
}

}  // namespace achilles
