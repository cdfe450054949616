// The state of the explorer: one system, its current run, and the playback position. It is changed only through
// apply().
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "figure/body.hpp"
#include "figure/compose.hpp"
#include "figure/mechanism.hpp"
#include "output/event_descriptions.hpp"
#include "output/output.hpp"
#include "sensitivity/error_estimate.hpp"
#include "session/chosen_event.hpp"
#include "session/command.hpp"
#include "session/document.hpp"
#include "session/history.hpp"
#include "session/plots.hpp"
#include "session/run_table.hpp"
#include "session/scene.hpp"
#include "session/study_jobs.hpp"
#include "session/worker.hpp"
#include "simulate/sampler.hpp"
#include "simulate/simulate.hpp"

namespace achilles {

class Budget;
class FilmJob;
class OrbitJob;
class MechanismScene;
struct OrbitJobResult;
struct OrbitMonitor;

// How a session finds the systems that `open` names, and where `save` writes them. All functions throw InputError.
struct SystemSource {
    std::function<std::filesystem::path(const std::string& system)> find{};  // returns its file
    // Applies the options of the command line over those of a file; may be empty.
    std::function<void(Options&)> finish{};
    std::function<Document(const std::string& system)> open{};                                // empty: reads its file
    std::function<void(Document& document, const std::string& file, bool overwrite)> save{};  // empty: writes to disk
    // Returns the commands of a journal; empty: journals are not available.
    std::function<std::vector<Command>(const std::string& journal)> journal{};
    // Folder of relative paths, named in messages about written files; empty: not named.
    std::string folder{};
    bool exports = true;  // false: `export` writes nothing
    // Receives an animation job that was started; empty: the session waits for it.
    std::function<void(std::unique_ptr<FilmJob>)> film{};
    // Puts the bytes of a PNG on the clipboard; empty: there is no clipboard for pictures. Throws InputError.
    std::function<void(const std::string& png)> copy_picture{};
    std::function<void(const std::string& file)> before_writing{};  // called by `save` and `export`; may be empty
    std::function<void(const std::string& file)> after_writing{};   // the same, once the file is written
    bool saves_any_text = true;                                     // false: only a text that is a valid system
    std::shared_ptr<Budget> budget{};                               // limits of its runs and sweeps; null: no limits
    bool is_from_picture = false;  // if so, the first run is subject to the budget, too
};

// Runs are computed on another thread. By default a command waits for its run as long as it takes, so that the same
// commands always lead to the same session. With a timeout the last result stays visible until update() receives the
// new one, and a newer run cancels an older one; a long run is shown first with coarse curves, which exact ones replace
// after a frame. Its events, certificates and numbers are exact from the beginning. Commands that set the playback
// position while a run is under way are repeated when it is finished, so that they mean the same as in a replayed
// journal.
class Session {
 public:
    // Opens `first` under the name `name` with the given run. Throws InputError if it cannot be derived or cannot
    // start.
    Session(const std::string& name, const SystemDescription& first, const Run& run, SystemSource library,
            Timeout patience = {});
    // Opens it with the run that the description specifies.
    Session(const std::string& name, const SystemDescription& first, SystemSource library, Timeout patience = {})
        : Session(name, first, default_run(first), std::move(library), patience) {}

    // Performs a command. On failure everything stays as it was, except error() or, for a text that is not a valid
    // system, problems(); returns false then, but true for a text. Throws PermissionDenied if a journal does
    // something that its policy does not allow, or exceeds its budget.
    bool apply(const Command& command);

    // Reports an error that does not come from a command. error() returns it until the next command.
    void refuse(const InputError& problem) { error_ = problem.what(); }

    // Sets notice(): something was done that is not visible otherwise.
    void tell(const std::string& done) { notice_ = done; }

    void set_patience(Timeout patience) { patience_ = patience; }
    // `ready` is called on another thread when update() would receive a result.
    void on_ready(const std::function<void()>& ready);
    // Receives the results that are ready.
    void update() {
        ++simulated_->updates;  // first, so that a run that comes now is on the screen before what follows it begins
        follow_curves(0.0);
        receive_pins(0.0);
        receive(0.0);
        receive_proof(0.0);
        receive_estimate(0.0);
        follow_proof_behind(0.0);
        sweep_job_->update(0.0);
        follow_dependence(0.0);
        receive_orbit(0.0);
    }
    // Waits for all work under way, so that a picture shows final results.
    void settle();
    // Progress of the run requested last; null if it is the one that is shown.
    const RunMonitor* under_way() const { return watch_.get(); }
    // True while the curves of the run that is shown are coarse.
    bool has_coarse_curves() const { return simulated_->is_coarse; }
    // True while the first run of a system is not finished: only its start is shown.
    bool shows_start() const { return trajectory().outcome.kind == Outcome::Kind::cancelled; }
    // Elapsed wall time of the run under way, s.
    double seconds_under_way() const;

    // The text being edited. If it has no problems, it is the system that runs.
    const Document& document() const { return document_; }
    bool shows_editor() const { return scene_.shows("editor"); }
    const Scene& scene() const { return scene_; }
    const std::string& system() const { return system_->name; }  // name as opened
    const std::shared_ptr<const Model>& model() const { return system_->model; }
    const SystemDescription& description() const { return system_->model->description(); }
    // The run requested last. trajectory().run is the one that is shown.
    const Run& run() const { return requested_run_; }
    // Value of a parameter, or of the initial coordinate x or rate x'; empty if there is no such name.
    std::optional<double> value(const std::string& name) const;
    const Trajectory& trajectory() const { return simulated_->trajectory; }
    // Error estimate of the run; null while it is being computed. It takes longer than the run and is never waited for.
    const ErrorEstimate* error_estimate() const { return simulated_->estimate ? &*simulated_->estimate : nullptr; }
    // Significant digits of displayed numbers according to the error estimate. horizon() is the time (s) after which
    // the run is not accurate; empty: accurate to its end.
    const Precision& precision() const { return simulated_->sentences.precision(); }
    std::optional<double> horizon() const { return precision().horizon(); }
    // The mechanism as it is shown: as its file draws it, or in space and turned.
    const Mechanism& mechanism() const { return simulated_->mechanism(); }
    bool is_in_space() const { return SpaceView::shows(*system_->model); }
    // The direction from which a system in space is seen: the one chosen, or that of the drawing in its file.
    ViewAngles direction() const { return scene_.direction().value_or(drawn_angles(mechanism(), *system_->model)); }
    // Pinned runs of this system, in the order in which they were pinned.
    const std::vector<PinnedRun>& pinned() const { return pinned_; }
    // The pinned run at this place; null if there is none.
    const PinnedRun* pinned_at(int place) const;
    // Places of runs that will be pinned when they are finished.
    std::vector<int> pins_under_way() const;
    // State of a pinned run at the current time, or at its end if that is earlier.
    Sample now_of(const PinnedRun& run) const { return run.sampler->at(std::min(time_, run.trajectory->end_time)); }
    // How the current run differs from the pinned ones; empty: no difference.
    const std::string& name_of_run() const { return name_; }
    // Table of the current and the pinned runs; empty if none is pinned.
    const RunTable& run_table() const { return run_table_; }
    // The panel of a plot: the current run over the visible pinned ones, or the difference to them.
    const Panel& drawn(std::size_t plot) const { return drawn_.empty() ? plots()[plot] : drawn_[plot]; }
    // The sweep around the current run, its command arguments, and its results so far.
    SweepSpec sweep() const;
    std::string sweep_text() const;
    const SweepJob& sweep_job() const { return *sweep_job_; }
    // The proof for the run that is shown; null: none yet. A proof for another start, parameter or end does not count.
    const Proof* proof() const;
    // From now on every run is also proved behind the scenes, like its error estimate, if that takes few steps. A window
    // does so. A picture shows a proof only where a command asks for one: otherwise its pixels would depend on more than
    // its commands, and each would take the time of a proof. This proof shows intervals of event times, but no tubes.
    void prove_behind() { proves_behind_ = true; }
    // The proof of the run that is shown, requested or behind it; null: none.
    const Proof* shown_proof() const;
    // The enclosure of an event of the run that is shown; null: none.
    const EnclosedEvent* enclosed(std::size_t event) const {
        return event < enclosed_.size() ? enclosed_[event] : nullptr;
    }
    // Progress of the requested proof; null: none is under way.
    const ProofMonitor* proof_under_way() const;
    // The command that requests this proof; empty if there is none and none is under way.
    std::optional<command::Prove> proof_command() const;
    // The sensitivities shown by "depend": the quantity and its derivatives; null: none yet. Until those of the current
    // run are computed they are those of an earlier run, and sensitivities_are_current() is false.
    std::string depend_text() const;
    const Sensitivities* sensitivities() const { return sensitivities_job_->sensitivities(); }
    bool sensitivities_are_current() const;
    const SensitivitiesJob& sensitivities_job() const { return *sensitivities_job_; }
    // The result of the last orbit search in this system; null: no search, or it is under way.
    std::shared_ptr<const OrbitJobResult> orbit() const;
    const OrbitMonitor* orbit_under_way() const;
    // Index (from 0) of the point on its branch from which the requested run starts; empty: none.
    std::optional<std::size_t> orbit_point() const;
    // The command that leads to it from the current run; empty if there is none.
    std::optional<command::FindOrbit> orbit_command() const;
    // Tangent to the sweep curve at the current run. Available for one axis and a printed quantity with known
    // derivative.
    std::optional<TangentLine> sweep_tangent() const;
    bool can_undo() const { return history_.can_undo(); }
    bool can_redo() const { return history_.can_redo(); }

    // Path of the body along the run that is shown, one point per sample.
    const Trail& trail() const;
    std::span<const Sample> samples() const { return simulated_->samples; }
    const State& scale() const { return simulated_->scale; }  // scale_of() of the run
    double least_gap() const { return simulated_->least_gap; }
    std::span<const RunWarning> remarks() const { return simulated_->remarks; }
    const EventDescriptions& sentences() const { return simulated_->sentences; }  // about its events
    // The world extent that the mechanism needs during the whole run.
    const Drawing& limits() const;
    // The camera and mechanism view along the run that is shown.
    MechanismScene& mechanism_scene() const { return *simulated_->mechanism_scene; }
    // The selected plots, and their panels for the run that is shown.
    const Plots& plotted() const { return plots_; }
    const std::vector<Panel>& plots() const { return simulated_->plots; }
    // The values of a plot at one instant, in display units: x, then every y.
    std::vector<double> values(std::size_t plot, const Sample& sample) const;
    std::vector<double> errors(std::size_t plot, const Sample& sample) const;  // estimated errors of these values
    // The state of the run that is shown at a given time (s).
    Sample at(double time) const { return simulated_->sampler.at(time); }

    double time() const { return time_; }
    const Sample& now() const { return now_; }  // the state at that time
    bool playing() const { return playing_; }
    // The value that is being animated; null: none. animate() moves it by `seconds` of wall time.
    struct Animation {
        std::string name;
        double from = 0.0, to = 0.0, seconds = 1.0, elapsed = 0.0;
    };
    const Animation* animation() const { return animation_ ? &*animation_ : nullptr; }
    void animate(double seconds);
    // True while time or a value changes by itself.
    bool is_moving() const { return playing_ || animation_.has_value(); }
    int selected() const { return selected_; }           // number of an event, from 1; 0: none
    const Event* selected_zeno() const;                  // the selected event if it is a Zeno point, else null
    const std::string& error() const { return error_; }  // why the last command was refused; empty: it was not
    // The run with every value and option of the system's text.
    const Run& file_run() const { return system_->file_run; }
    const Theme& theme() const { return theme_; }
    // What the last command did that is not visible otherwise: wrote a file, copied a line. Empty: nothing.
    const std::string& notice() const { return notice_; }
    // Warnings about the last command, which was performed.
    const std::vector<std::string>& warnings() const { return warnings_; }
    // Clipboard contents, and how often they were set.
    const std::string& copied() const { return copied_; }
    int copies() const { return copies_; }

 private:
    // A system, derived and compiled. Nothing in it depends on parameter values.
    struct OpenSystem {
        OpenSystem(const std::string& name, const SystemDescription& description);
        std::string name;
        std::shared_ptr<const Model> model;
        Mechanism mechanism;
        Run file_run;
    };
    // One run and everything derived from it for display.
    struct FinishedRun {
        FinishedRun(std::shared_ptr<const OpenSystem> of, Trajectory made, const Plots& plotted, const Theme& theme,
                    bool is_coarse_first = false);
        ~FinishedRun();
        FinishedRun(const FinishedRun&) = delete;  // `mechanism_scene` refers to other members
        FinishedRun& operator=(const FinishedRun&) = delete;
        // Makes the mechanism and its scene anew for another direction; empty: the drawing of the file.
        void turn(const std::optional<ViewAngles>& direction);
        const Mechanism& mechanism() const { return turned ? *turned : system->mechanism; }
        Trajectory trajectory;
        std::shared_ptr<const OpenSystem> system;
        bool is_coarse;  // the trail, and the plots as long as they have not been composed anew
        Sampler sampler;
        std::vector<Sample> samples;
        State scale;
        double least_gap;
        std::vector<RunWarning> remarks;
        EventDescriptions sentences;
        std::optional<ErrorEstimate> estimate;  // computed after everything else
        std::string quantity;                   // default_quantity() of the run
        std::optional<ViewAngles> direction;
        std::unique_ptr<Mechanism> turned;  // null: the drawing of the file
        std::unique_ptr<MechanismScene> mechanism_scene;
        int revision = 0;   // revision of the plots shown in `plots`
        bool dark = false;  // theme of `plots`
        bool has_coarse_plots;
        std::vector<Panel> plots;
        int updates = 0;            // how often the session was updated since the run came
        bool is_estimated = false;  // its error estimate has begun
    };
    // The exact curves of a run that was shown with coarse ones.
    struct ExactCurves {
        std::vector<Panel> plots;
        Trail trail;
    };

    void perform(const command::Open& command);
    void perform(const command::Set& command);
    void perform(const command::SetOption& command);
    void perform(const command::Seek& command);
    void perform(const command::Play& command);
    void perform(const command::Pause& command);
    void perform(const command::Select& command);
    void perform(const command::ShowLens& command);
    void perform(const command::Turn& command);
    void perform(const command::ShowPlane& command);
    void perform(const command::ShowSweep& command);
    void perform(const command::ShowSensitivity& command);
    void perform(const command::Prove& command);
    void perform(const command::StopProof& command);
    void perform(const command::FindOrbit& command);
    void perform(const command::StopOrbit& command);
    void perform(const command::SelectBranchPoint& command);
    void perform(const command::New& command);
    void perform(const command::SetText& command);
    void perform(const command::Save& command);
    void perform(const command::Reload& command);
    void perform(const command::SetStart& command);
    void perform(const command::Undo& command);
    void perform(const command::Redo& command);
    void perform(const command::Pin& command);
    void perform(const command::Unpin& command);
    void perform(const command::UnpinAll& command);
    void perform(const command::ShowPinned& command);
    void perform(const command::Recall& command);
    void perform(const command::StepEvents& command);
    void perform(const command::Animate& command);
    void perform(const command::StopAnimation&) { animation_.reset(); }
    void perform(const command::Present& command);
    void perform(const command::Reset& command);
    void perform(const command::EndEdit&) {}  // only the undo history uses it
    void perform(const command::SetTheme& command);
    void perform(const command::Export& command);
    void perform(const command::Copy& command);
    bool copy_content(const command::Copy& command);
    void perform(const command::Wait& command);
    void perform(const command::Replay& command);
    // All other commands change the plots or the view state.
    template <class OtherCommand>
    void perform(const OtherCommand& command);
    // Everything that undo restores.
    struct UndoState {
        Document document;
        std::shared_ptr<const OpenSystem> system;
        Plots plots;
        Run run;
        std::vector<PinnedRun> pinned;  // not undone themselves, but restored with their system
        friend bool operator==(const UndoState& a, const UndoState& b) {
            return a.system == b.system && a.run == b.run && a.document.name == b.document.name &&
                   a.document.text == b.document.text && a.plots == b.plots;
        }
    };
    UndoState undo_state() const { return {document_, system_, plots_, requested_run_, pinned_}; }
    void restore(UndoState back);
    void compose_pinned();
    void pin(int place, int number, const std::shared_ptr<FinishedRun>& run);
    bool waits_at(int place) const;
    void put_aside_pin();
    void cancel_pins();
    void stop_pin(std::size_t i);
    void receive_pins(Timeout patience);
    void drop_pinned_runs();
    void begin_document(Document document);
    void read_document();
    // Each of these throws InputError if this system lacks a name that is used.
    void check_plane(const command::ShowPlane& plane) const;
    void check_sweep(const std::string& text) const;
    void check_quantity(const std::string& quantity) const;
    // After a change of the system: drop settings that use names it lacks.
    void keep_plane();
    void keep_sweep();
    void keep_dependence();
    void follow_direction() { simulated_->turn(scene_.direction()); }
    void follow_studies();
    bool vary(const std::string& name, double value);
    void follow_sweep();
    bool wants_sensitivities() const;
    void follow_dependence(Timeout patience);
    void follow_proof(Timeout patience);
    void receive_proof(Timeout patience);
    void follow_proof_behind(Timeout patience);
    void stop_proof_behind();
    void receive_orbit(Timeout patience);
    void change_system(const std::shared_ptr<const OpenSystem>& system, const Plots& plots, const Run& run);
    void rerun(const Run& run);
    void receive(Timeout patience);
    void follow_curves(Timeout patience);
    bool is_on_screen() const;
    void stop_followers();
    void estimate(Timeout patience);
    void receive_estimate(Timeout patience);
    void use_horizon();
    void compose_plots();
    void place(const Command& command);
    void move_to(double time);
    void choose(int event);
    void step_to_event(int steps, bool is_zeno);
    void keep_choice(bool is_at_event);
    void warn(const std::string& warning);

    SystemSource library_;
    Timeout patience_;
    Theme theme_ = light_theme();
    Document document_;
    std::shared_ptr<const OpenSystem> system_;
    Plots plots_;
    Scene scene_;
    Run requested_run_;
    // A run of this system. It differs from the run requested while that is under way.
    std::shared_ptr<FinishedRun> simulated_;
    std::shared_ptr<const RunMonitor> watch_;      // monitor of the run under way
    std::chrono::steady_clock::time_point began_;  // start of that run
    std::optional<Command> placed_;                // last command that set the playback position meanwhile
    Sample now_;
    double time_ = 0.0;
    bool playing_ = false;
    std::optional<Animation> animation_;
    int selected_ = 0;
    std::optional<EventMeaning> meaning_;  // of the selected event, by which another run finds it again
    std::string error_, notice_;
    std::vector<std::string> warnings_;
    std::string copied_;
    int copies_ = 0, replaying_ = 0;
    History<UndoState> history_;
    std::vector<PinnedRun> pinned_;
    std::string name_;
    RunTable run_table_;
    std::vector<Panel> drawn_;      // empty: the current run's plots
    std::optional<int> pin_waits_;  // place at which the run under way will be pinned
    int pin_requests_ = 0;          // total number of pin requests; that run is the last of them
    // A run computed beside the current one, to be pinned at this place.
    using Runner = Worker<std::shared_ptr<FinishedRun>>;
    struct PendingPin {
        int place, number;
        Run run;
        std::unique_ptr<Runner> worker;
    };
    std::vector<PendingPin> pins_;                  // in order of request
    std::vector<std::unique_ptr<Runner>> stopped_;  // cancelled workers, until they have released their memory
    std::function<void()> ready_;
    struct ProofRequest {
        std::shared_ptr<const OpenSystem> system;
        Run run;
        InitialUncertainty spread;
    };
    std::optional<ProofRequest> proof_request_;   // until it is finished
    std::vector<const EnclosedEvent*> enclosed_;  // one per event; empty: there is no proof
    std::unique_ptr<ProofJob> proof_job_ = std::make_unique<ProofJob>();
    bool proves_behind_ = false;
    std::shared_ptr<const FinishedRun> run_proved_behind_;  // the run of the job below; null: none
    std::unique_ptr<ProofJob> proof_behind_job_ = std::make_unique<ProofJob>();
    std::unique_ptr<SensitivitiesJob> sensitivities_job_ = std::make_unique<SensitivitiesJob>();
    std::shared_ptr<OrbitJob> orbit_job_;
    std::unique_ptr<SweepJob> sweep_job_ = std::make_unique<SweepJob>();
    std::unique_ptr<Runner> worker_ = std::make_unique<Runner>();
    std::shared_ptr<const FinishedRun> run_made_exact_;  // the run of the job below; null: none
    std::unique_ptr<Worker<std::shared_ptr<ExactCurves>>> curves_worker_ =
        std::make_unique<Worker<std::shared_ptr<ExactCurves>>>();
    std::unique_ptr<Worker<ErrorEstimate>> estimator_ = std::make_unique<Worker<ErrorEstimate>>();
};

// The initial sweep of a system: first Zeno time over the range of its restitution or, without one, its first
// parameter.
std::string default_sweep(const SystemDescription& description);

// Advances the playback by `seconds` of wall time at the session's speed. At the end it stops or restarts.
void play_on(Session& session, double seconds);

// Text form of the session, which tests compare.
std::string to_text(const Session& session);

}  // namespace achilles
