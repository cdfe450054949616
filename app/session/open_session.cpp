#include "session/open_session.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "cli/assets.hpp"
#include "cli/overrides.hpp"
#include "cli/terminal.hpp"
#include "model/model.hpp"

namespace achilles {

std::string first_system() {
    const std::vector<std::string> names = system_names();
    if (names.empty()) throw InputError(assets().string(), {}, "there are no systems here");
    const std::string usual = "ball_on_sine";
    return std::find(names.begin(), names.end(), usual) != names.end() ? usual : names.front();
}

Session open_session(const std::string& name, const SystemDescription& first, const std::vector<std::string>& settings,
                     const OptionOverrides& overrides, SystemSource library, Patience patience) {
    library.finish = [overrides](Options& options) { apply(overrides, options); };
    const Run run = asked_run(first, settings, overrides);
    if (library.budget && !library.is_from_picture) library.budget->allow(run.options);
    warn(first, run);
    try {
        return {name, first, run, std::move(library), patience};
    } catch (const InputError&) {
        if (!settings.empty()) check_asked(Model(first), run, settings);
        throw;
    }
}

void apply_all(Session& session, const std::vector<Command>& commands) {
    std::set<std::string> told;
    for (const Command& command : commands) {
        session.apply(command);
        if (!session.error().empty()) throw InputError(to_text(command), {}, session.error());
        for (const std::string& warning : session.warnings())
            if (told.insert(warning).second) print_clean(stderr, "achilles: warning: {}\n", warning);
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
