#include "pictures/export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "analysis/sweep.hpp"
#include "figure/difference.hpp"
#include "figure/mechanism_scene.hpp"
#include "journal/journal.hpp"
#include "output/output.hpp"
#include "paint/paint.hpp"
#include "pictures/film.hpp"
#include "pictures/origin.hpp"
#include "pictures/picture_format.hpp"
#include "pictures/picture_job.hpp"
#include "session/replay_script.hpp"

namespace achilles {

namespace {

namespace fs = std::filesystem;

using Words = std::vector<std::string>;

void add_steps(Words& words, const std::vector<Command>& steps) {
    for (const Command& step : steps) words.insert(words.end(), {"--do", to_text(step)});
}

// The options --view NAME that reproduce the plots, if every plot is an unchanged view of the system file. nullopt
// otherwise, and with pinned runs or a proof.
std::optional<Words> views_of(const Session& session, const Plots& plots) {
    if (!session.pinned().empty() || session.proof() != nullptr) return std::nullopt;
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

Words mechanism_words(const Session& session, const std::string& name) {
    Words words{"figure", name};
    const Words options = run_options(session);
    words.insert(words.end(), options.begin(), options.end());
    words.insert(words.end(), {"--mechanism", "--at", fmt::format("{}", session.time())});
    if (const auto& look = session.scene().look()) add_steps(words, {*look});
    if (!session.scene().shows("trail")) add_steps(words, {command::Show{"trail", false}});
    return words;
}

PaperSize page_of(const command::Export& what) { return {what.width, what.height, what.font, what.dpi}; }

void add_page(Words& words, const command::Export& what) {
    for (const auto& [option, value] : {std::pair{"--width-mm", what.width}, std::pair{"--height-mm", what.height},
                                        std::pair{"--font-pt", what.font}, std::pair{"--dpi", what.dpi}})
        if (value > 0.0) words.insert(words.end(), {option, fmt::format("{}", value)});
    if (what.dark) words.emplace_back("--dark");
}

// The notes of a picture that these words produce from this session.
Notes notes_of(const Session& session, Words words, const command::Export& what) {
    add_page(words, what);
    const std::string& name = session.system();
    const Origin origin{"Achilles " + version(),
                        command_line(words),
                        "",
                        {{InputSource::Kind::system, name, session.description().source_text}}};
    return notes(origin, {{name, &session.trajectory()}});
}

std::string figure_bytes(const Session& session, const Plots& plots, const command::Export& what,
                         const std::string& format) {
    PublicationStyle style;
    style.columns = plots.columns();
    style.dark = what.dark;
    style.size = resolution_of(page_of(what), {}, format);
    const Figure figure = figure_of(session, plots, style);
    const PictureSize size = size_of(page_of(what), {}, figure, format);
    return picture_of(figure, size, notes_of(session, figure_words(session, plots, session.system()), what), format);
}

std::string mechanism_bytes(const Session& session, const command::Export& what, const std::string& format) {
    const Theme theme = what.dark ? dark_theme() : light_theme();
    const Drawing world = mechanism_of(session, theme);
    return picture_of(world, theme.background, size_of(page_of(what), {}, world, format),
                      notes_of(session, mechanism_words(session, session.system()), what), format);
}

// If drawing is not possible here (e.g. a missing library), only the message of the exception is kept.
std::string drawn(const Session& session, const command::Export& what, const std::string& format) {
    check(page_of(what), what.file);
    if (format == "pdf") need_pdf_writer(what.file);
    const Plots plots = what.plot > 0 ? session.plotted().only(what.plot) : session.plotted();
    try {
        return what.mechanism ? mechanism_bytes(session, what, format) : figure_bytes(session, plots, what, format);
    } catch (const InputError&) {
        throw;
    } catch (const std::runtime_error& problem) {
        throw InputError(what.file, {}, problem.what());
    }
}

}  // namespace

std::string exported(const Session& session, const command::Export& what) {
    if (const std::string format = ending_of_picture(what.file); !format.empty()) return drawn(session, what, format);
    if (what.plot > 0 || what.mechanism || what.width > 0.0)
        throw InputError(what.file, {}, "plot, mechanism and width apply only to figures",
                         "end it in .svg, .png or .pdf");
    const std::string ending = ending_of(what.file);
    if (ending == "json") return to_json(session.trajectory());
    if (ending == "csv") return to_csv(session.trajectory());
    if (ending == "journal") return journal_text(recipe(session));
    throw InputError(what.file, {}, "this name does not say what to export",
                     "end it in .svg, .png or .pdf (the plots), .mp4 or .gif (a film), .json or .csv (the run), or "
                     ".journal (the session)");
}

namespace {

// Distinguishes the runs: the current one in ink, the others thinner in their hues. Within a run only the dash pattern
// marks the phase, so the phases have their dashes in gray: no two signs are the same.
void name_runs(Figure& figure, const Session& session, const std::vector<const PinnedRun*>& pinned,
               const Theme& theme) {
    std::vector<std::string> phases;
    for (const PhaseLook look : phase_looks) phases.push_back(legend_text(look));
    for (Key& key : figure.keys)
        if (auto* const stroke = std::get_if<Stroke>(&key.sign);
            stroke != nullptr && std::any_of(phases.begin(), phases.end(),
                                             [&](const std::string& phase) { return key.label.starts_with(phase); }))
            stroke->color = theme.faint;
    const Stroke own{theme.ink, 2.0, {}};
    figure.keys.push_back({session.name_of_run().empty() ? "present run" : session.name_of_run(), own});
    for (const PinnedRun* run : pinned)
        figure.keys.push_back({run->name.empty() ? "pinned run" : run->name, pinned_stroke(theme, {}, run->place)});
}

}  // namespace

PictureSize size_of(const PaperSize& page, PictureSize in_pixels, const Figure& figure, const std::string& format) {
    if (page.width > 0.0) return on_page(page, format, figure.text_size, shape_of(figure));
    in_pixels.scale *= publication_scale;
    return in_pixels;
}

PictureSize size_of(const PaperSize& page, PictureSize in_pixels, const Drawing& world, const std::string& format) {
    if (page.width > 0.0) return on_page(page, format, world_text_size, shape_of(world));
    in_pixels.scale *= publication_scale;
    return in_pixels;
}

Resolution resolution_of(const PaperSize& page, const PictureSize& in_pixels, const std::string& format) {
    const bool is_page = page.width > 0.0;
    const PictureSize size = is_page ? on_page(page_for(page, format), format, 1.0, tallest_shape) : in_pixels;
    const double fineness = is_page && format != "png" ? 4.0 : 1.0;
    return {fineness * size.width, fineness * size.height};
}

Drawing mechanism_of(const Session& session, const Theme& theme) {
    if (session.mechanism().is_empty())
        throw InputError({}, {}, "this system has no drawing of a mechanism", "add [[drawing]] to its file");
    const Scene& scene = session.scene();
    const Sample& now = session.now();
    Drawing seen = session.limits();
    const double width = 1000.0, shape = shape_of(seen);  // pixels of the picture, for the camera
    if (const auto look = scene.look()) {
        seen.x_low = look->x - 0.5 * look->width, seen.x_high = look->x + 0.5 * look->width;
        seen.y_low = look->y - 0.5 * look->width / shape, seen.y_high = look->y + 0.5 * look->width / shape;
    } else {
        seen = session.mechanism_scene().camera().at(scene.camera(), now, {width, width / shape});
    }
    return session.mechanism_scene().draw(now, seen, theme,
                                          {scene.shows("trail"), scene.shows("strobe"), scene.shows("force")});
}

Figure figure_of(const Session& session, const PublicationStyle& style) {
    return figure_of(session, session.plotted(), style);
}

Figure figure_of(const Session& session, const Plots& plots, const PublicationStyle& style) {
    const Theme theme = style.dark ? dark_theme() : light_theme();
    std::vector<Panel> panels =
        plots.compose(session.trajectory(), session.samples(), theme, session.horizon(), style.size);
    std::vector<const PinnedRun*> pinned;
    for (const PinnedRun& run : session.pinned())
        if (run.shown) pinned.push_back(&run);
    std::vector<ComparedRun> compared;
    std::vector<std::vector<Panel>> others;
    for (const PinnedRun* run : pinned) {
        compared.push_back({run->trajectory.get(), run->name, run_color(theme, run->place), run->horizon()});
        others.push_back(plots.compose(*run->trajectory, *run->samples, theme, run->horizon(), style.size));
    }
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const Plot& plot = plots.list()[i];
        std::vector<PinnedPanel> behind;
        for (std::size_t k = 0; k < pinned.size(); ++k)
            behind.push_back({&others[k][i], pinned[k]->name, pinned[k]->place});
        Framing framing = plot.framing;
        framing.for_print = true;
        framing.size = style.size;
        if (const Proof* proof = session.proof())
            panels[i] = with_proof(std::move(panels[i]), session.trajectory(), *proof, *plot.prepared, framing, theme);
        panels[i] = framing.difference
                        ? difference(session.trajectory(), compared, *plot.prepared, framing, session.horizon())
                        : with_pinned(std::move(panels[i]), behind, framing, theme);
    }
    Figure figure = publication(session.trajectory(), std::move(panels), style);
    if (!pinned.empty()) name_runs(figure, session, pinned, theme);
    if (const Proof* proof = session.proof()) name_proof(figure, *proof, theme);
    return figure;
}

namespace {

void check_file(const command::Export& what) {
    const std::string& file = what.file;
    if (file.empty() || file == "-") throw InputError({}, {}, "the file to export to is missing");
    std::error_code ignored;
    if (!what.overwrite && fs::exists(file, ignored))
        throw InputError(file, {}, "the file already exists",
                         "export under another name, or overwrite it: export FILE overwrite");
}

// Contents of a file; empty if it cannot be read.
std::string held_by(const std::string& file) {
    try {
        return read_text(file);
    } catch (const InputError&) {
        return {};
    }
}

double fps_of(const command::Export& what) { return what.fps > 0.0 ? what.fps : 30.0; }
double speed_of(const Session& session, const command::Export& what) {
    return what.speed > 0.0 ? what.speed : session.scene().speed();
}

}  // namespace

FilmExtent extent_of(const Session& session, const command::Export& what) {
    const Trajectory& trajectory = session.trajectory();
    const int width = std::max(what.pixels > 0 ? what.pixels : 1280, 2) / 2 * 2;
    const double seconds = (trajectory.end_time - trajectory.run.options.start_time) / speed_of(session, what);
    return {std::floor(seconds * fps_of(what)) + 1.0, width, width * 5 / 16 * 2};
}

std::unique_ptr<FilmJob> begin_film(const Session& session, const command::Export& what) {
    check_file(what);
    if (what.plot > 0 || what.mechanism || what.width > 0.0)
        throw InputError(what.file, {}, "a film shows the mechanism beside the plots, and its width is in pixels",
                         "export F.mp4 pixels 1280 fps 30 speed 1");
    const FilmExtent extent = extent_of(session, what);
    if (extent.width < 320 || extent.width > 3840)
        throw InputError(what.file, {}, fmt::format("a film cannot be {} pixels wide", extent.width),
                         "use 320 to 3840");
    if (!(extent.frames <= max_film_frames))
        throw InputError(what.file, {}, fmt::format("this would take more than {:.0f} frames", max_film_frames),
                         "use a higher speed or fewer frames per second");
    const std::string system = name_anywhere(session.system());
    need_film_joiner(what.file, system, what.file);
    Words words{"frames", system};
    const Words options = run_options(session);
    words.insert(words.end(), options.begin(), options.end());
    if (const auto views = views_of(session, session.plotted()))
        words.insert(words.end(), views->begin(), views->end());
    else
        add_steps(words, figure_steps(session, session.plotted()));
    words.insert(words.end(),
                 {"--fps", fmt::format("{}", fps_of(what)), "--speed", fmt::format("{}", speed_of(session, what)),
                  "--size", fmt::format("{}x{}", extent.width, extent.height), "--out", what.file, "--progress"});
    if (const auto& from = session.scene().direction())
        words.insert(words.end(), {"--turn", fmt::format("{},{}", from->about, from->tilt)});
    if (what.dark) words.emplace_back("--dark");
    if (what.overwrite) words.emplace_back("--overwrite");
    // A text that differs from its file is passed in a temporary file.
    const std::string& text = session.description().source_text;
    return std::make_unique<FilmJob>(what.file, std::move(words),
                                     held_by(session.description().file) == text ? "" : text);
}

void write_export(const Session& session, const command::Export& what) {
    const std::string& file = what.file;
    check_file(what);
    OutputFiles files;
    files.add(file);  // checked before the work
    files.put(file, exported(session, what));
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
    if (what == "sweep") {
        words = {"sweep", name};
        for (const Flag& flag : read_flags(session.sweep_text(), "sweep"))
            words.insert(words.end(), {flag.name, flag.value});
        const Run& file = session.file_run();
        const Run base = without_axes(session.run(), session.sweep().axes, file, session.description());
        const Words fixed = run_options(session.description(), file, base);
        words.insert(words.end(), fixed.begin(), fixed.end());
        words.insert(words.end(), {"--out", stem + "-sweep.svg"});
        return shell_line(words);
    }
    words.insert(words.end(), options.begin(), options.end());
    if (what == "run")
        words.insert(words.end(), {"--json", stem + ".json"});
    else
        add_steps(words, explorer_steps(session));
    return shell_line(words);
}

}  // namespace achilles
