#include "session/replay_script.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "cli/assets.hpp"
#include "cli/overrides.hpp"
#include "cli/terminal.hpp"
#include "figure/label.hpp"
#include "model/model.hpp"
#include "number/angle.hpp"
#include "pictures/picture_job.hpp"

namespace achilles {

namespace {

namespace fs = std::filesystem;

// All values that differ, by name: a parameter, an initial coordinate x or rate x'.
std::vector<std::pair<std::string, command::ValueArgument>> changed_values(const SystemDescription& description,
                                                                           const Run& from, const Run& to) {
    std::vector<std::pair<std::string, command::ValueArgument>> changed;
    for (std::size_t i = 0; i < to.parameters.size(); ++i)
        if (from.parameters[i] != to.parameters[i])
            changed.emplace_back(description.parameters[i].name, to.parameters[i]);
    for (std::size_t i = 0; i < description.coordinates.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        const std::string& name = description.coordinates[i].name;
        if (from.q[at] != to.q[at]) changed.emplace_back(name, to.q[at]);
        if (from.v[at] != to.v[at]) changed.emplace_back(name + "'", to.v[at]);
    }
    return changed;
}

// Commands that turn run `from` of a system into run `to`.
std::vector<Command> steps_between(const SystemDescription& description, const Run& from, const Run& to) {
    std::vector<Command> steps;
    // Set all values at once: an intermediate state might be infeasible.
    const auto values = changed_values(description, from, to);
    if (values.size() == 1) steps.emplace_back(command::Set{values[0].first, values[0].second});
    if (values.size() > 1) steps.emplace_back(command::SetStart{values});
    for (const auto group : options_by_command(from.options, to.options)) {
        const command::SetOption step(group[0], to.options);
        if (step != command::SetOption(group[0], from.options)) steps.emplace_back(step);
    }
    return steps;
}

// "30°", "2 m".
std::string with_unit_of(const ShownUnit& unit, double value) {
    std::string text = fmt::format("{:.6g}", unit.factor * value);
    if (text[0] == '-') text.replace(0, 1, "\u2212");
    return text + (unit.text.empty() || unit.text.starts_with("\u00b0") ? unit.text : "\u00a0" + unit.text);
}

void append(std::vector<Command>& steps, const std::vector<Command>& more) {
    steps.insert(steps.end(), more.begin(), more.end());
}

// Commands that open a system with this text.
std::vector<Command> steps_to_text(const std::string& name, bool is_new, const std::string& saved,
                                   const std::string& text) {
    std::vector<Command> steps;
    if (is_new)
        steps.emplace_back(command::New{});
    else
        steps.emplace_back(command::Open{name_anywhere(name)});
    if (text != saved) steps.emplace_back(command::SetText{text});
    return steps;
}

// Contents of a file; empty if it cannot be read.
std::string held_by(const std::string& file) {
    try {
        return read_text(file);
    } catch (const InputError&) {
        return {};
    }
}

bool is_untitled(const std::string& name) { return name == new_document().name; }

std::string saved_text(const Session& session) {
    const Document& document = session.document();
    if (document.name == session.system()) return document.saved;
    return held_by(session.description().file);  // the editor then holds another text, which is not a valid system
}

// Commands to the current run, including those that pin the pinned runs on the way.
std::vector<Command> run_steps(const Session& session, Run from) {
    std::vector<Command> steps, hidden;
    std::set<int> taken;
    for (const PinnedRun& pinned : session.pinned()) {
        append(steps, steps_between(session.description(), from, pinned.trajectory->run));
        from = pinned.trajectory->run;
        int first_free = 1;
        while (taken.contains(first_free)) ++first_free;
        steps.emplace_back(command::Pin{pinned.place == first_free ? 0 : pinned.place});
        taken.insert(pinned.place);
        if (!pinned.shown) hidden.emplace_back(command::ShowPinned{pinned.place, false});
    }
    append(steps, steps_between(session.description(), from, session.run()));
    append(steps, hidden);
    return steps;
}

// Commands to its proof, finished or under way.
std::vector<Command> proof_steps(const Session& session) {
    const auto proof = session.proof_command();
    return proof ? std::vector<Command>{*proof} : std::vector<Command>();
}

// Commands to the periodic orbit that it is on or that is being searched for.
std::vector<Command> orbit_steps(const Session& session) {
    const auto orbit = session.orbit_command();
    return orbit ? std::vector<Command>{*orbit} : std::vector<Command>();
}

// Commands to the playback position.
std::vector<Command> time_steps(const Session& session) {
    std::vector<Command> steps;
    const int selected = session.selected();
    double time = 0.0;
    if (selected > 0) {
        steps.emplace_back(command::Select{selected});
        time = session.trajectory().events[static_cast<std::size_t>(selected - 1)].t;
    }
    if (session.time() != time) steps.emplace_back(command::Seek{session.time()});
    if (session.playing()) steps.emplace_back(command::Play{});
    return steps;
}

// Commands to the view state and the playback position.
std::vector<Command> view_steps(const Session& session) {
    std::vector<Command> steps = steps_to(session.plotted());
    if (session.theme().dark) steps.emplace_back(command::SetTheme{true});
    append(steps, steps_to(session.scene()));
    append(steps, time_steps(session));
    if (session.scene().shows("lens") && session.scene().lens() && session.selected_zeno() != nullptr)
        steps.emplace_back(command::ShowLens{*session.scene().lens()});
    return steps;
}

}  // namespace

std::string name_anywhere(const std::string& system) {
    if (!is_system_path(system)) return system;  // an asset
    std::error_code problem;
    const fs::path absolute = fs::absolute(system, problem);
    return problem ? system : absolute.lexically_normal().string();
}

std::vector<Command> recipe(const Session& session) {
    const SystemDescription& description = session.description();
    std::vector<Command> steps;
    append(steps, steps_to_text(session.system(), is_untitled(session.system()), saved_text(session),
                                description.source_text));
    append(steps, run_steps(session, session.file_run()));
    append(steps, proof_steps(session));
    append(steps, orbit_steps(session));
    append(steps, view_steps(session));
    // A text that is not a valid system yet, edited over one that runs.
    const Document& document = session.document();
    if (document.name != session.system()) steps.emplace_back(command::Open{name_anywhere(document.name)});
    if (document.text != description.source_text && document.is_changed())
        steps.emplace_back(command::SetText{document.text});
    return steps;
}

std::vector<std::string> run_options(const Session& session) {
    return run_options(session.description(), session.file_run(), session.run());
}

std::vector<std::string> run_options(const SystemDescription& description, const Run& text, const Run& run) {
    std::vector<std::string> words;
    for (const auto& [name, value] : changed_values(description, text, run))
        words.insert(words.end(), {"--set", fmt::format("{}={}", name, value.value)});
    for (const auto group : options_by_command()) {
        const command::SetOption before(group[0], text.options), now(group[0], run.options);
        if (now.values != before.values && now.sets_single_value()) {
            words.insert(words.end(), {common_flag(group[0]), to_text(now.values[0])});
            continue;
        }
        for (std::size_t i = 0; i < group.size(); ++i)
            if (now.values[i] != before.values[i])
                words.insert(words.end(), {std::string(group[i].flag), to_text(now.values[i])});
    }
    return words;
}

std::vector<RunDifference> differences(const SystemDescription& description, const Run& run, const Run& other) {
    std::vector<RunDifference> all;
    const auto now = changed_values(description, other, run), before = changed_values(description, run, other);
    for (std::size_t i = 0; i < now.size(); ++i) {
        const std::string& name = now[i].first;
        const bool is_start = std::none_of(description.parameters.begin(), description.parameters.end(),
                                           [&](const ParameterDescription& p) { return p.name == name; });
        const ShownUnit unit = shown_unit_of_setting(description, name);
        all.push_back({typeset(name) + (is_start ? "(0)" : ""), with_unit_of(unit, now[i].second.value),
                       with_unit_of(unit, before[i].second.value), false, command::Set{name, before[i].second}});
    }
    for (const auto group : options_by_command(run.options, other.options)) {
        const command::SetOption step(group[0], run.options), back(group[0], other.options);
        if (step == back) continue;
        const auto values = [&](const command::SetOption& use) {
            return to_text(Command(use)).substr(use.name.size() + 1);
        };
        all.push_back({step.name, values(step), values(back), true, back});
    }
    return all;
}

std::vector<Command> figure_steps(const Session& session, const Plots& plots) {
    std::vector<Command> steps = run_steps(session, session.run());
    if (session.proof() != nullptr) append(steps, proof_steps(session));  // a figure does not wait for a proof
    append(steps, steps_to(plots, true));
    return steps;
}

// To follow the options of run_options(). Includes a proof or an orbit that is still being computed.
std::vector<Command> explorer_steps(const Session& session) {
    std::vector<Command> steps = run_steps(session, session.run());
    append(steps, proof_steps(session));
    append(steps, orbit_steps(session));
    append(steps, view_steps(session));
    return steps;
}

// ---- the session of a command line ----

std::string first_system() {
    const std::vector<std::string> names = system_names();
    if (names.empty()) throw InputError(assets().string(), {}, "there are no systems here");
    const std::string usual = "ball_on_sine";
    return std::find(names.begin(), names.end(), usual) != names.end() ? usual : names.front();
}

Session open_session(const std::string& name, const SystemDescription& first, const std::vector<std::string>& settings,
                     const OptionOverrides& overrides, SystemSource library, Timeout patience) {
    library.finish = [overrides](Options& options) { apply(overrides, options); };
    const Run run = requested_run(first, settings, overrides);
    if (library.budget && !library.is_from_picture) library.budget->allow(run.options);
    warn(first, run);
    try {
        return {name, first, run, std::move(library), patience};
    } catch (const InputError&) {
        if (!settings.empty()) validate_overrides(Model(first), run, settings);
        throw;
    }
}

void apply_all(Session& session, const std::vector<Command>& commands) {
    std::set<std::string> printed;
    for (const Command& command : commands) {
        session.apply(command);
        if (!session.error().empty()) throw InputError(to_text(command), {}, session.error());
        for (const std::string& warning : session.warnings())
            if (printed.insert(warning).second) print_clean(stderr, "achilles: warning: {}\n", warning);
    }
}

SystemSource source_of(PictureJob& job) {
    SystemSource library;
    library.open = [&job](const std::string& name) {
        const std::filesystem::path path(name);
        const bool is_path = path.has_parent_path() || path.extension() == ".toml";
        const std::string text = job.inputs().text(name);
        return Document{name, is_path ? name : "", name, text, text, {}};
    };
    library.journal = [&job](const std::string& name) { return job.inputs().journal(name); };
    library.exports = !job.reproduces();
    library.budget = job.inputs().budget();
    library.is_from_picture = job.reproduces();
    library.saves_any_text = false;
    library.before_writing = [&job](const std::string& file) { job.refuse_output(file); };
    if (job.reproduces())
        library.save = [](Document& document, const std::string& file, bool) { mark_saved(document, file); };
    return library;
}

}  // namespace achilles
