// The state of the explorer: one system, one run of it, and where its player stands. apply() is the only door.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "depend/error_estimate.hpp"
#include "figure/body.hpp"
#include "figure/compose.hpp"
#include "figure/mechanism.hpp"
#include "output/output.hpp"
#include "output/sentences.hpp"
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
class Stage;
struct FoundOrbit;
struct OrbitWatch;

// How a session finds the systems that `open` names, and where `save` puts them. All throw InputError.
struct SystemSource {
    std::function<std::filesystem::path(const std::string& system)> find{};  // its file
    std::function<void(Options&)> finish{};  // what the command line puts over those of a file; may be empty
    std::function<Document(const std::string& system)> open{};                                // empty: from its file
    std::function<void(Document& document, const std::string& file, bool overwrite)> save{};  // empty: to the disk
    std::function<std::vector<Command>(const std::string& journal)> journal{};  // what is in one; empty: there are none
    std::string folder{};  // where paths without one begin, for messages of what is written; empty: they do not tell
    bool exports = true;   // false: `export` writes nothing
    // Takes a film that was begun; empty: the session waits for it.
    std::function<void(std::unique_ptr<FilmJob>)> film{};
    std::function<void(const std::string& file)> before_writing{};  // `save` and `export`; may be empty
    bool saves_any_text = true;                                     // false: only one that is a system
    std::shared_ptr<Budget> budget{};                               // of its runs and sweeps; null: no limits
    bool is_from_picture = false;                                   // then the first run is within the budget, too
};

// Runs are made on a thread of their own. A command waits for its run as long as the session has patience; by default
// as long as it takes, so that the same commands lead to the same session. With less patience the last result stays
// until update() takes in the new one; a newer run cancels an older one. The commands that place the present while a
// run is under way are done again when it is there, and so mean what they mean in a replayed journal.
class Session {
 public:
    // Opens `first`, known as `name`, with a run of it. Throws InputError if it cannot be derived or cannot start.
    Session(const std::string& name, const SystemDescription& first, const Run& run, SystemSource library,
            Patience patience = {});
    // With the run that it asks for.
    Session(const std::string& name, const SystemDescription& first, SystemSource library, Patience patience = {})
        : Session(name, first, default_run(first), std::move(library), patience) {}

    // Does what the command says. What cannot be done leaves everything as it was but error(), or problems() where a
    // text is no system; false then, but for a text. Throws Forbidden: a journal wants what it may not, or more work than
    // its budget allows.
    bool apply(const Command& command);

    // A mistake that is no command's: error() tells it until the next command.
    void refuse(const InputError& problem) { error_ = problem.what(); }

    // What was done meanwhile, that cannot be seen otherwise.
    void tell(const std::string& done) { notice_ = done; }

    void set_patience(Patience patience) { patience_ = patience; }
    // Called on another thread when update() would take something in.
    void on_ready(const std::function<void()>& ready);
    // Takes in the runs that were under way, if they are ready.
    void update() {
        receive_pins(0.0);
        receive(0.0);
        receive_proof(0.0);
        receive_estimate(0.0);
        sweep_job_->update(0.0);
        follow_dependence(0.0);
        receive_orbit(0.0);
    }
    // Waits for all that is under way: what a picture shows is finished.
    void settle();
    // How far the run is that was asked for last; null if it is the one that is shown.
    const Watch* under_way() const { return watch_.get(); }
    // Until then nothing is shown but its start: it is the first of its system.
    bool shows_start() const { return trajectory().outcome.kind == Outcome::Kind::cancelled; }
    // s, for how long that has been made; by the clock.
    double seconds_under_way() const;

    // The text that is edited; without problems it is the system that runs.
    const Document& document() const { return document_; }
    bool shows_editor() const { return scene_.shows("editor"); }
    const Scene& scene() const { return scene_; }
    const std::string& system() const { return system_->name; }  // as opened
    const std::shared_ptr<const Model>& model() const { return system_->model; }
    const SystemDescription& description() const { return system_->model->description(); }
    // What was asked for last. trajectory().run is what is shown.
    const Run& run() const { return asked_; }
    // Of a parameter, a coordinate's start x or its rate x'; nothing if there is no such name.
    std::optional<double> value(const std::string& name) const;
    const Trajectory& trajectory() const { return simulated_->trajectory; }
    // What is estimated of its error; null while that is under way: it takes longer than the run, and nobody waits for it.
    const ErrorEstimate* error_estimate() const { return simulated_->estimate ? &*simulated_->estimate : nullptr; }
    // Which digits of its numbers mean something, by that as soon as it is there; where it is not trusted to its end, until when.
    const Precision& precision() const { return simulated_->sentences.precision(); }
    std::optional<double> horizon() const { return precision().horizon(); }
    const Mechanism& mechanism() const { return system_->mechanism; }
    // Runs of this system that were pinned, to compare with, in the order in which they were.
    const std::vector<PinnedRun>& pinned() const { return pinned_; }
    // One that is at this place; null where there is none.
    const PinnedRun* pinned_at(int place) const;
    // Places of runs that are pinned when they are there: nothing is said of them until then.
    std::vector<int> pins_under_way() const;
    // Where it is at the present time, or at its end.
    Sample now_of(const PinnedRun& run) const { return run.sampler->at(std::min(time_, run.trajectory->end_time)); }
    // How the present run differs from the pinned ones; empty: not at all.
    const std::string& name_of_run() const { return name_; }
    // The present run and the pinned ones, in a table; empty where none is pinned.
    const RunTable& run_table() const { return run_table_; }
    // What a plot draws: the present run over the pinned ones that are shown, or the difference to them.
    const Panel& drawn(std::size_t plot) const { return drawn_.empty() ? plots()[plot] : drawn_[plot]; }
    // What the sweep varies and asks about the present run, and as its command has it; and its runs, as far as they are made.
    Sweep sweep() const;
    std::string sweep_text() const;
    const SweepJob& sweep_job() const { return *sweep_job_; }
    // What is proved of the run that is shown; null: nothing yet. Another start, parameter or end has no part in it.
    const Proof* proof() const;
    // Of an event of the run that is shown, what the proof encloses it in; null: nothing.
    const EnclosedEvent* enclosed(std::size_t event) const {
        return event < enclosed_.size() ? enclosed_[event] : nullptr;
    }
    // How far the proof is that was asked for; null: none is under way.
    const ProofWatch* proof_under_way() const;
    // The command that leads to it; nothing where there is none, nor one under way.
    std::optional<command::Prove> proof_command() const;
    // The quantity that is asked for what it depends on, and what is known of that, while "depend" is shown; null: nothing yet. Of
    // the run before, while those of the present one are not there: then they are not current.
    std::string depend_text() const;
    const Influences* influences() const { return influences_job_->influences(); }
    bool influences_are_current() const;
    const InfluencesJob& influences_job() const { return *influences_job_; }
    // The periodic run that was searched for last, in this system, and its branch; null: none was, or the search is under way.
    std::shared_ptr<const FoundOrbit> orbit() const;
    const OrbitWatch* orbit_under_way() const;
    // The point of it, from 0, that the run which was asked for last begins on; nothing: it does not.
    std::optional<std::size_t> orbit_point() const;
    // The command that leads to it from the present run; nothing where none does.
    std::optional<command::FindOrbit> orbit_command() const;
    // Where the sweep has one axis, a value whose influence on what is printed is known.
    std::optional<TangentLine> sweep_tangent() const;
    bool can_undo() const { return history_.can_undo(); }
    bool can_redo() const { return history_.can_redo(); }

    // Its body along the run that is shown, a point a sample.
    const Trail& trail() const;
    std::span<const Sample> samples() const { return simulated_->samples; }
    const State& scale() const { return simulated_->scale; }  // scale_of() the run
    double least_gap() const { return simulated_->least_gap; }
    std::span<const Remark> remarks() const { return simulated_->remarks; }
    const Sentences& sentences() const { return simulated_->sentences; }  // of its events
    // The world the mechanism needs during the whole run.
    const Drawing& limits() const;
    // How the mechanism is looked at along the run that is shown.
    Stage& stage() const { return *simulated_->stage; }
    // What is plotted, and the plots, composed.
    const Plots& plotted() const { return plots_; }
    const std::vector<Panel>& plots() const { return simulated_->plots; }
    // What a plot shows of an instant, in its units: x, then every y.
    std::vector<double> values(std::size_t plot, const Sample& sample) const;
    std::vector<double> errors(std::size_t plot, const Sample& sample) const;  // of these
    // The state at a time of the run that is shown.
    Sample at(double time) const { return simulated_->sampler.at(time); }

    double time() const { return time_; }
    const Sample& now() const { return now_; }  // the state at that time
    bool playing() const { return playing_; }
    int selected() const { return selected_; }           // an event's number, from 1; 0: none
    const Event* selected_zeno() const;                  // that event where it is a Zeno point, else null
    const std::string& error() const { return error_; }  // why the last command was refused; empty: it was not
    // Every value and option as the text of the system has them.
    const Run& file_run() const { return system_->file_run; }
    const Theme& theme() const { return theme_; }
    // What the last command did that cannot be seen otherwise: a file written, a line copied. Empty: nothing.
    const std::string& notice() const { return notice_; }
    // What a person should know of the last command, though it was done.
    const std::vector<std::string>& warnings() const { return warnings_; }
    // What is to be on the clipboard, and how often something was put there.
    const std::string& copied() const { return copied_; }
    int copies() const { return copies_; }

 private:
    // A system derived and compiled: nothing here depends on a parameter's value.
    struct System {
        System(const std::string& name, const SystemDescription& description);
        std::string name;
        std::shared_ptr<const Model> model;
        Mechanism mechanism;
        Run file_run;
    };
    // One run and what is shown of it.
    struct Simulated {
        Simulated(std::shared_ptr<const System> of, Trajectory made, const Plots& plotted, const Theme& theme);
        ~Simulated();
        Simulated(const Simulated&) = delete;  // the stage refers to the others
        Simulated& operator=(const Simulated&) = delete;
        Trajectory trajectory;
        std::shared_ptr<const System> system;
        Sampler sampler;
        std::vector<Sample> samples;
        State scale;
        double least_gap;
        std::vector<Remark> remarks;
        Sentences sentences;
        std::optional<ErrorEstimate> estimate;  // made when all else is there
        std::string quantity;                   // default_quantity() of it
        std::unique_ptr<Stage> stage;
        int revision = 0;   // of what is plotted
        bool dark = false;  // in which theme
        std::vector<Panel> plots;
    };

    void perform(const command::Open& command);
    void perform(const command::Set& command);
    void perform(const command::UseOption& command);
    void perform(const command::Seek& command);
    void perform(const command::Play& command);
    void perform(const command::Pause& command);
    void perform(const command::Select& command);
    void perform(const command::Lens& command);
    void perform(const command::ShowPlane& command);
    void perform(const command::ShowSweep& command);
    void perform(const command::ShowDependence& command);
    void perform(const command::Prove& command);
    void perform(const command::StopProof& command);
    void perform(const command::FindOrbit& command);
    void perform(const command::StopOrbit& command);
    void perform(const command::GoOnOrbit& command);
    void perform(const command::New& command);
    void perform(const command::Text& command);
    void perform(const command::Save& command);
    void perform(const command::Start& command);
    void perform(const command::Undo& command);
    void perform(const command::Redo& command);
    void perform(const command::Pin& command);
    void perform(const command::Unpin& command);
    void perform(const command::UnpinAll& command);
    void perform(const command::ShowPinned& command);
    void perform(const command::Recall& command);
    void perform(const command::Step& command);
    void perform(const command::Reset& command);
    void perform(const command::Done&) {}  // the history heard it
    void perform(const command::UseTheme& command);
    void perform(const command::Export& command);
    void perform(const command::Copy& command);
    void perform(const command::Wait& command);
    void perform(const command::Replay& command);
    // Everything else is about how the run is looked at.
    template <class Other>
    void perform(const Other& command);
    // What a change may change.
    struct Moment {
        Document document;
        std::shared_ptr<const System> system;
        Plots plots;
        Run run;
        std::vector<PinnedRun> pinned;  // which are nothing to undo, but come back with their system
        friend bool operator==(const Moment& a, const Moment& b) {
            return a.system == b.system && a.run == b.run && a.document.name == b.document.name &&
                   a.document.text == b.document.text && a.plots == b.plots;
        }
    };
    Moment moment() const { return {document_, system_, plots_, asked_, pinned_}; }
    void restore(Moment back);
    void compose_pinned();
    void pin(int place, int number, const std::shared_ptr<Simulated>& run);
    bool waits_at(int place) const;
    void put_aside_pin();
    void let_pins_go();
    void stop_pin(std::size_t i);
    void receive_pins(Patience patience);
    void let_go();
    void begin_document(Document document);
    void read_document();
    // Each of these throws InputError if this system lacks what is named.
    void check_plane(const command::ShowPlane& plane) const;
    void check_sweep(const std::string& text) const;
    void check_quantity(const std::string& quantity) const;
    // After a change of the system: what it lacks is no longer shown.
    void keep_plane();
    void keep_sweep();
    void keep_dependence();
    void follow_sweep();
    void follow_dependence(Patience patience);
    void follow_proof(Patience patience);
    void receive_proof(Patience patience);
    void receive_orbit(Patience patience);
    void change_system(const std::shared_ptr<const System>& system, const Plots& plots, const Run& run);
    void rerun(const Run& run);
    void receive(Patience patience);
    void estimate();
    void receive_estimate(Patience patience);
    void use_horizon();
    void compose_plots();
    void place(const Command& command);
    void move_to(double time);
    void warn(const std::string& warning);

    SystemSource library_;
    Patience patience_;
    Theme theme_ = light_theme();
    Document document_;
    std::shared_ptr<const System> system_;
    Plots plots_;
    Scene scene_;
    Run asked_;
    std::shared_ptr<Simulated>
        simulated_;  // of this system; of another run than the one asked for while that is under way
    std::shared_ptr<const Watch> watch_;           // of the run under way
    std::chrono::steady_clock::time_point began_;  // that run
    std::optional<Command> placed_;                // what placed the present meanwhile
    Sample now_;
    double time_ = 0.0;
    bool playing_ = false;
    int selected_ = 0;
    std::string error_, notice_;
    std::vector<std::string> warnings_;
    std::string copied_;
    int copies_ = 0, replaying_ = 0;
    History<Moment> history_;
    std::vector<PinnedRun> pinned_;
    std::string name_;
    RunTable run_table_;
    std::vector<Panel> drawn_;      // empty: the present run's plots
    std::optional<int> pin_waits_;  // the place that the run under way is to be pinned at
    int pins_asked_ = 0;            // in all: that one is the last of them
    // A run that is made beside the present one, to be pinned at this place.
    using Runner = Worker<std::shared_ptr<Simulated>>;
    struct PinUnderWay {
        int place, number;
        Run run;
        std::unique_ptr<Runner> worker;
    };
    std::vector<PinUnderWay> pins_;                 // the first was asked for first
    std::vector<std::unique_ptr<Runner>> stopped_;  // until they have forgotten what nobody wants any more
    std::function<void()> ready_;
    struct AskedProof {
        std::shared_ptr<const System> system;
        Run run;
        Spread spread;
    };
    std::optional<AskedProof> proof_asked_;       // until it is there
    std::vector<const EnclosedEvent*> enclosed_;  // for every event; empty: there is no proof
    std::unique_ptr<ProofJob> proof_job_ = std::make_unique<ProofJob>();
    std::unique_ptr<InfluencesJob> influences_job_ = std::make_unique<InfluencesJob>();
    std::shared_ptr<OrbitJob> orbit_job_;
    std::unique_ptr<SweepJob> sweep_job_ = std::make_unique<SweepJob>();
    std::unique_ptr<Runner> worker_ = std::make_unique<Runner>();
    std::unique_ptr<Worker<ErrorEstimate>> estimator_ = std::make_unique<Worker<ErrorEstimate>>();
};

// What a sweep of a system is at first: its restitution, or else the first parameter, over its range, and the first Zeno time.
std::string default_sweep(const SystemDescription& description);

// Lets so much time pass for a session that plays, at its speed. At the end it stops or begins again.
void play_on(Session& session, double seconds);

// The session as text: what tests compare.
std::string to_text(const Session& session);

}  // namespace achilles
