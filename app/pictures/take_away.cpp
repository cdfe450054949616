#include "pictures/take_away.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "figure/difference.hpp"
#include "journal/journal.hpp"
#include "output/output.hpp"
#include "pictures/origin.hpp"
#include "pictures/pdf.hpp"
#include "pictures/picture_ending.hpp"
#include "pictures/picture_job.hpp"
#include "session/recipe.hpp"

namespace achilles {

namespace {

namespace fs = std::filesystem;

using Words = std::vector<std::string>;

void add_steps(Words& words, const std::vector<Command>& steps) {
    for (const Command& step : steps) words.insert(words.end(), {"--do", to_text(step)});
}

// The plots as views of the system's file, where they are nothing else and no pinned run stands behind them.
std::optional<Words> views_of(const Session& session, const Plots& plots) {
    if (!session.pinned().empty()) return std::nullopt;
    const auto& views = session.description().views;
    Words words;
    for (const Plot& plot : plots.list()) {
        const auto named = [&](const ViewDescription& view) { return view.name == plot.view.name; };
        const auto own = std::find_if(views.begin(), views.end(), named);
        const bool is_own = own != views.end() && own->x.text == plot.view.x.text &&
                            std::equal(own->y.begin(), own->y.end(), plot.view.y.begin(), plot.view.y.end(),
                                       [](const Text& a, const Text& b) { return a.text == b.text; });
        if (!is_own || plot.framing != Framing()) return std::nullopt;
        words.insert(words.end(), {"--view", plot.view.name});
    }
    return words;
}

Words figure_words(const Session& session, const Plots& plots, const std::string& name) {
    Words words{"figure", name};
    const Words options = run_options(session);
    words.insert(words.end(), options.begin(), options.end());
    if (const auto views = views_of(session, plots))
        words.insert(words.end(), views->begin(), views->end());
    else
        add_steps(words, figure_steps(session, plots));
    words.insert(words.end(), {"--columns", std::to_string(plots.columns())});
    return words;
}

std::string figure_bytes(const Session& session, const Plots& plots, const std::string& format) {
    const std::string& name = session.system();
    const Origin origin{"Achilles " + version(),
                        command_line(figure_words(session, plots, name)),
                        "",
                        {{Source::Kind::system, name, session.description().source_text}}};
    PublicationStyle style;
    style.columns = plots.columns();
    const Figure figure = figure_of(session, plots, style);
    PictureSize size;
    size.scale *= publication_scale;
    const Notes carried = notes(origin, {{name, &session.trajectory()}});
    return picture_of(figure, size, carried, format);
}

// Of what cannot be drawn here (a library that is missing) only the message matters.
std::string drawn(const Session& session, const Plots& plots, const std::string& file, const std::string& format) {
    if (format == "pdf") need_pdf_writer(file);
    try {
        return figure_bytes(session, plots, format);
    } catch (const InputError&) {
        throw;
    } catch (const std::runtime_error& problem) {
        throw InputError(file, {}, problem.what());
    }
}

std::string bytes_of(const Session& session, const std::string& file, int plot) {
    std::string ending = fs::path(file).extension().string();
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const Plots plots = plot > 0 ? session.plotted().only(plot) : session.plotted();
    if (const std::string format = ending_of_picture(file); !format.empty()) return drawn(session, plots, file, format);
    if (plot > 0) throw InputError(file, {}, "one plot is a figure", "end it in .svg, .png or .pdf");
    if (ending == ".json") return to_json(session.trajectory());
    if (ending == ".csv") return to_csv(session.trajectory());
    if (ending == ".journal") return journal_text(recipe(session));
    throw InputError(file, {}, "this name does not say what to export",
                     "end it in .svg, .png or .pdf (the plots), .json or .csv (the run), or .journal (the session)");
}

// Which run is which: the present one is in ink, the others in their hues; so a dash alone tells a phase.
void name_runs(Figure& figure, const Session& session, const std::vector<const PinnedRun*>& pinned) {
    const Theme theme = light_theme();
    const std::vector<std::string> phases{legend_text(Phase::Kind::hybrid), legend_text(Phase::Kind::constrained)};
    for (Key& key : figure.keys)
        if (auto* const stroke = std::get_if<Stroke>(&key.sign);
            stroke != nullptr && std::any_of(phases.begin(), phases.end(),
                                             [&](const std::string& phase) { return key.label.starts_with(phase); }))
            stroke->color = theme.ink;
    const Stroke own{theme.ink, 2.0, {}};
    figure.keys.push_back({session.name_of_run().empty() ? "present run" : session.name_of_run(), own});
    for (const PinnedRun* run : pinned)
        figure.keys.push_back({run->name.empty() ? "pinned run" : run->name, pinned_stroke(theme, {}, run->place, 0)});
}

}  // namespace

Figure figure_of(const Session& session, const PublicationStyle& style) {
    return figure_of(session, session.plotted(), style);
}

Figure figure_of(const Session& session, const Plots& plots, const PublicationStyle& style) {
    const Theme theme = light_theme();
    std::vector<Panel> panels = plots.compose(session.trajectory(), session.samples(), theme, Plots::Medium::print);
    std::vector<const PinnedRun*> pinned;
    for (const PinnedRun& run : session.pinned())
        if (run.shown) pinned.push_back(&run);
    std::vector<ComparedRun> compared;
    std::vector<std::vector<Panel>> others;
    for (const PinnedRun* run : pinned) {
        compared.push_back({run->trajectory.get(), run->name, run_color(theme, run->place)});
        others.push_back(plots.compose(*run->trajectory, *run->samples, theme, Plots::Medium::print));
    }
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const Plot& plot = plots.list()[i];
        std::vector<PinnedPanel> behind;
        for (std::size_t k = 0; k < pinned.size(); ++k)
            behind.push_back({&others[k][i], pinned[k]->name, pinned[k]->place});
        Framing framing = plot.framing;
        framing.for_print = true;
        panels[i] = framing.difference ? difference(session.trajectory(), compared, *plot.prepared, framing)
                                       : with_pinned(std::move(panels[i]), behind, framing, theme);
    }
    Figure figure = publication(session.trajectory(), std::move(panels), style);
    if (!pinned.empty()) name_runs(figure, session, pinned);
    return figure;
}

void take_away(const Session& session, const command::Export& what) {
    const std::string& file = what.file;
    if (file.empty() || file == "-") throw InputError({}, {}, "a file to export to is missing");
    std::error_code ignored;
    if (!what.overwrite && fs::exists(file, ignored))
        throw InputError(file, {}, "there is a file already",
                         "export under another name, or overwrite it: export FILE overwrite");
    OutputFiles files;
    files.add(file);  // before the work
    files.put(file, bytes_of(session, file, what.plot));
    files.commit();
}

std::string command_for(const Session& session, const std::string& what) {
    const std::string name = name_anywhere(session.system()), stem = fs::path(name).stem().string();
    if (what == "figure") {
        Words words = figure_words(session, session.plotted(), name);
        words.insert(words.end(), {"--out", stem + ".svg"});
        return shell_line(words);
    }
    Words words{what == "run" ? "simulate" : "explore", name};
    const Words options = run_options(session);
    words.insert(words.end(), options.begin(), options.end());
    if (what == "run")
        words.insert(words.end(), {"--json", stem + ".json"});
    else
        add_steps(words, explorer_steps(session));
    return shell_line(words);
}

}  // namespace achilles
