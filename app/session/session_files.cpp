// Export, copying of command lines, tables and pictures, replay of journals, and the session as text.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "figure/label.hpp"
#include "journal/link.hpp"
#include "model/model.hpp"
#include "number/angle.hpp"
#include "output/contacts.hpp"
#include "output/output.hpp"
#include "output/proof.hpp"
#include "pictures/export.hpp"
#include "pictures/film.hpp"
#include "session/command.hpp"
#include "session/session.hpp"
#include "session/study_jobs.hpp"
#include "system/units.hpp"

namespace achilles {

namespace {

// Tables for the clipboard and a spreadsheet: separated by tabs, with all digits, in displayed units.

// Factor for gap rates of angles: degrees per second, like the other rates.
double speed_factor(const Session& session, const Event& event) {
    const std::vector<std::string> rates = output_names(session.description(), "gap'");
    std::size_t first = 0;
    while (first + 1 < rates.size() && !event.contacts.contains(first)) ++first;
    return shown_unit(unit_of_expression(session.description(), rates[first])).factor;
}

std::string plot_table(const Session& session, const Plot& plot) {
    std::string text;
    for (const auto& quantity : plot.prepared->quantities())
        text += fmt::format("{}{}{}", text.empty() ? "" : "\t", quantity.text,
                            quantity.unit.empty() ? "" : fmt::format(" [{}]", quantity.unit));
    text += '\n';
    for (const Sample& sample : session.samples()) {
        const std::vector<double> values = values_at(session.trajectory(), sample, *plot.prepared);
        text += fmt::format("{}\n", fmt::join(values, "\t"));
    }
    return text;
}

// The selected event or, without one, all events: contacts, time, state after the event, energy lost, sentence and, if
// the run is proved, the proved interval of the time.
std::string events_table(const Session& session) {
    const auto& coordinates = session.description().coordinates;
    const bool several = session.model()->contacts() > 1, is_proved = session.shown_proof() != nullptr;
    std::string text = several ? "#\tevent\tcontacts\topened\theld\tt\timpact speed" : "#\tevent\tt\timpact speed";
    for (const char* prime : {"", "'"})
        for (const CoordinateDescription& coordinate : coordinates) text += "\t" + coordinate.name + prime;
    text += "\tenergy lost\tsentence";
    if (is_proved) text += "\tt proved from\tt proved to";
    const auto& events = session.trajectory().events;
    for (std::size_t i = 0; i < events.size(); ++i) {
        if (session.selected() > 0 && i + 1 != static_cast<std::size_t>(session.selected())) continue;
        const Event& event = events[i];
        text += fmt::format("\n{}\t{}", i + 1, names_of(event).name);
        for (const ContactSet& set : {event.contacts, event.opened, event.mode.held()})
            if (several) text += "\t" + joined_names(*session.model(), set, "+");
        text +=
            fmt::format("\t{}\t{}", event.t,
                        event.is_impact() ? fmt::format("{}", event.impact_speed * speed_factor(session, event)) : "");
        for (const Vector* const values : {&event.q, &event.v_after})
            for (std::size_t k = 0; k < coordinates.size(); ++k)
                text += fmt::format("\t{}", (*values)[static_cast<Eigen::Index>(k)] *
                                                (coordinates[k].unit == "rad" ? degrees(1.0) : 1.0));
        text += fmt::format("\t{}\t{}", energy_lost(session.trajectory(), i), session.sentences().of(i));
        const EnclosedEvent* const enclosed = session.enclosed(i);
        if (is_proved) text += enclosed ? fmt::format("\t{}\t{}", enclosed->t.lo(), enclosed->t.hi()) : "\t\t";
    }
    return text + "\n";
}

// The quantities of one plot at the instants of the run, or of all plots (number 0), one table after the other.
std::string plots_table(const Session& session, int number) {
    const Plots plots = number == 0 ? session.plotted() : session.plotted().only(number);
    std::string text;
    for (const Plot& plot : plots.list()) text += (text.empty() ? "" : "\n") + plot_table(session, plot);
    return text;
}

// The text that a command line would find under a system's name; empty if there is no such file.
std::optional<std::string> held_by_file(const SystemSource& library, const std::string& system) {
    try {
        return (library.open ? library.open(system) : open_document(system, library.find(system))).text;
    } catch (const InputError&) {
        return std::nullopt;
    }
}

constexpr int deepest = 8;  // maximum nesting of journals, which stops a journal that replays itself

}  // namespace

void Session::perform(const command::Export& command) {
    // Until then the result on the screen belongs to other values than the sliders show, or there is none.
    if (under_way() != nullptr || trajectory().outcome.kind == Outcome::Kind::cancelled)
        throw refusal("the run is still under way", "export again when it has finished");
    if (library_.before_writing) library_.before_writing(command.file);
    const std::filesystem::path file(command.file);
    const std::string path = (file.is_absolute() ? file : library_.folder / file).lexically_normal().string();
    notice_ = "wrote " + path;
    if (!library_.exports) return;
    if (!is_film(command.file)) {
        write_export(*this, command);
        if (library_.after_writing) library_.after_writing(command.file);
        return;
    }
    std::unique_ptr<FilmJob> film = begin_film(*this, command);
    if (library_.film) {
        notice_.clear();
        return library_.film(std::move(film));
    }
    film->wait();
    if (film->is_made()) return;
    if (film->has_frames()) return warn(film->output());  // ffmpeg failed
    throw InputError(command.file, {}, film->output());
}

// Copies a table or a picture of the run that is shown. Returns false if the command copies a command line instead.
bool Session::copy_content(const command::Copy& command) {
    const bool is_table = command.what == "data" || command.what == "events" || command.what == "plots";
    const bool is_picture = command.what == "picture", has_plots = is_picture || command.what == "plots";
    if (command.plot > 0 && !has_plots) throw refusal(fmt::format("there is no {} of a single plot", command.what));
    if (!is_table && !is_picture) return false;
    if (under_way() != nullptr || shows_start())
        throw refusal("the run is still under way", "copy when it has finished");
    if (command.plot > 0) plots_.only(command.plot);  // throws if there is no such plot
    const std::string plots = command.plot > 0 ? fmt::format("plot {}", command.plot) : "the plots";
    if (is_picture) {
        const command::Export picture{"picture.png", false, command.plot};
        if (library_.copy_picture) library_.copy_picture(exported(*this, picture));
        notice_ = fmt::format("copied {} as a picture", plots);
        return true;
    }
    copied_ = command.what == "data"     ? exported(*this, command::Export{"data.csv"})
              : command.what == "events" ? events_table(*this)
                                         : plots_table(*this, command.plot);
    ++copies_;
    const std::string what = command.what == "data"    ? "the run"
                             : command.what == "plots" ? plots
                             : selected_ > 0           ? fmt::format("event {}", selected_)
                                                       : "the events";
    notice_ = fmt::format("copied {} as a table", what);
    return true;
}

void Session::perform(const command::Copy& command) {
    if (copy_content(command)) return;
    if (command.what == "link") {
        copied_ = link_of(*this);
        ++copies_;
        notice_ = fmt::format("copied a link of {} characters", copied_.size());
        return;
    }
    // The command line names a file, which must contain the system that runs here.
    if (held_by_file(library_, system()) != description().source_text || !document_.problems.empty())
        throw refusal("this text is not saved in a file, and a command line needs a file", "save it first, then copy");
    copied_ = command_for(*this, command.what);
    ++copies_;
    notice_ = "copied: " + copied_;
}

void Session::perform(const command::Wait& command) { play_on(*this, command.seconds); }

void Session::perform(const command::Replay& command) {
    if (!library_.journal) throw refusal("there are no journals here");
    if (replaying_ >= deepest) throw refusal("too many journals replay each other");
    const std::vector<Command> journal = library_.journal(command.journal);
    ++replaying_;
    std::string first_error;
    std::vector<std::string> warnings;
    for (const Command& step : journal) {
        apply(step);
        if (first_error.empty()) first_error = error_;
        warnings.insert(warnings.end(), warnings_.begin(), warnings_.end());
    }
    warnings_ = std::move(warnings);
    --replaying_;
    if (!first_error.empty()) throw refusal(first_error);
}

// ---- as text ----

namespace {

// "zeno_time(1) = 2.7, by g -0.4, ...", for the current run.
std::string to_text(const Sensitivities& known) {
    std::string text = fmt::format("{} = {:.9g}", known.quantity.expression, known.quantity.value);
    for (const Sensitivities::Sensitivity& by : known.all)
        text += by.reason.empty() ? fmt::format(", by {} {:.6g}", by.name, by.derivative)
                                  : fmt::format(", by {} none: {}", by.name, by.reason);
    return text + "\n";
}

// "orbit --from start: period 3.5, 17 points, on point 3"
std::string to_text(const OrbitJobResult& found, std::optional<std::size_t> on) {
    const auto& orbit = found.answer.orbit;
    if (!orbit) return fmt::format("orbit {}: none, {}\n", found.text, found.answer.reason);
    return fmt::format("orbit {}: period {:.9g}, {} points{}\n", found.text, orbit->period, found.count(),
                       on ? fmt::format(", on point {}", *on + 1) : "");
}

}  // namespace

std::string to_text(const Session& session) {
    std::string text = fmt::format("system {}\n", session.system());
    const SystemDescription& description = session.description();
    const Run& run = session.run();
    for (std::size_t i = 0; i < description.parameters.size(); ++i)
        text += fmt::format("{} = {:.9g}\n", description.parameters[i].name, run.parameters[i]);
    for (std::size_t i = 0; i < description.coordinates.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        text += fmt::format("{0} = {1:.9g}, {0}' = {2:.9g}\n", description.coordinates[i].name, run.q[at], run.v[at]);
    }
    text += fmt::format("time {:.9g}{}, event {}\n", session.time(), session.playing() ? " playing" : "",
                        session.selected());
    if (const Session::Animation* moving = session.animation())
        text += fmt::format("animate {} to {:.9g}\n", moving->name, moving->to);
    for (const PinnedRun& pinned : session.pinned())
        text += fmt::format("pinned {}{}: {}\n", pinned.place, pinned.shown ? "" : " (hidden)",
                            pinned.name.empty() ? "the same" : pinned.name);
    if (const Proof* proof = session.proof())
        text += fmt::format("{}: {} until {}\n", to_text(*session.proof_command()),
                            to_text(proof->enclosure.outcome.kind), reach_text(proof->enclosure, 9));
    if (session.orbit() != nullptr) text += to_text(*session.orbit(), session.orbit_point());
    if (session.sensitivities_are_current()) text += to_text(*session.sensitivities());
    text += to_text(session.plotted()) + to_text(session.scene());
    if (session.theme().dark) text += "theme dark\n";
    if (const auto horizon = session.horizon()) text += fmt::format("trusted until {:.9g}\n", *horizon);
    if (!session.error().empty()) text += "error " + session.error() + "\n";
    if (session.document().is_changed()) text += "the text is not saved\n";
    for (const InputError& problem : session.document().problems) text += fmt::format("problem {}\n", problem.what());
    return text + to_text(session.trajectory());
}

}  // namespace achilles
