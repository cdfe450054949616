#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <optional>

#include "cli/commands/commands.hpp"
#include "cli/commands/common.hpp"
#include "cli/terminal.hpp"
#include "figure/proof.hpp"
#include "figure/publication.hpp"
#include "journal/journal.hpp"
#include "model/model.hpp"
#include "pictures/export.hpp"
#include "pictures/picture_format.hpp"
#include "pictures/picture_job.hpp"
#include "sensitivity/error_estimate.hpp"
#include "session/replay_script.hpp"
#include "simulate/simulate.hpp"

namespace achilles {

namespace {

struct FigureArguments {
    std::string system, out, format;
    std::vector<std::string> views, settings, steps;
    std::string journal;
    bool allow_files = false;
    OptionOverrides overrides;
    PublicationStyle style;
    PictureSize size;
    PaperSize page;
    bool mechanism = false;
    std::string at;  // "": the start
    bool proof = false;
    double width = 0.0;  // half-width of the start interval, for --proof
};

// Adds the picture of a finished run to the output. Returns the exit status.
int put(const FigureArguments& arguments, const Trajectory& trajectory, const ErrorEstimate* estimate,
        const std::string& format, PictureJob& job,
        const std::function<std::string(const PaperSize& page, const Notes&)>& draw) {
    job.put(arguments.out, "", {{arguments.system, &trajectory}},
            [&](const Notes& notes) { return draw(page_for(arguments.page, format), notes); });
    job.commit();
    return print_notes(trajectory, true, estimate);
}

int put(const FigureArguments& arguments, const Trajectory& trajectory, const ErrorEstimate* estimate,
        const Figure& figure, const Proof* proof, const std::string& format, PictureJob& job) {
    const int status =
        put(arguments, trajectory, estimate, format, job, [&](const PaperSize& page, const Notes& notes) {
            const PictureSize size = size_of(page, arguments.size, figure, format);
            job.check_size(size.width, size.height);
            return picture_of(figure, size, notes, format);
        });
    return proof == nullptr ? status : std::max(status, print_notes(proof->enclosure));
}

int put_mechanism(const FigureArguments& arguments, const Session& session, const std::string& format,
                  PictureJob& job) {
    const Theme theme = arguments.style.dark ? dark_theme() : light_theme();
    const Drawing world = mechanism_of(session, theme);
    Color background = theme.background;
    if (arguments.style.transparent) background.a = 0;
    return put(arguments, session.trajectory(), session.error_estimate(), format, job,
               [&](const PaperSize& page, const Notes& notes) {
                   const PictureSize size = size_of(page, arguments.size, world, format);
                   job.check_size(size.width, size.height);
                   return picture_of(world, background, size, notes, format);
               });
}

// The boxes to prove, if a proof is requested. `points` receives the settings with the midpoint of each interval.
std::optional<InitialUncertainty> spread_of(const FigureArguments& arguments, const SystemDescription& description,
                                            std::vector<std::string>& points) {
    points = arguments.settings;
    if (!arguments.proof) return std::nullopt;
    points.clear();
    return parse_uncertainty(arguments.settings, arguments.width, description, points);
}

// Draws the plots of the explorer after a journal and further commands.
int draw_session(const FigureArguments& arguments, const std::string& format, PictureJob& job) {
    if (!arguments.views.empty())
        throw arguments.mechanism
            ? InputError("--view " + arguments.views[0], {}, "--mechanism draws no plots", "leave --view out")
            : InputError("--view " + arguments.views[0], {}, "the journal or --do already sets the plots",
                         "leave --view out, or --journal and --do");
    std::vector<Command> steps;
    job.inputs().trust(
        trust_of(arguments.allow_files, {arguments.system, arguments.journal}, work_options(arguments.overrides)));
    if (!arguments.journal.empty()) steps = job.inputs().journal(arguments.journal);
    const std::vector<Command> more = job.inputs().steps(arguments.steps);
    steps.insert(steps.end(), more.begin(), more.end());
    const SystemDescription description = job.inputs().system(arguments.system);
    std::vector<std::string> points;
    const std::optional<InitialUncertainty> spread = spread_of(arguments, description, points);
    Session session = open_session(arguments.system, description, points, arguments.overrides, source_of(job), {});
    job.add(arguments.out);
    if (spread) steps.emplace_back(prove_command(*spread));
    if (!arguments.at.empty()) steps.insert(steps.begin(), parse_command("seek " + arguments.at, "--at"));
    apply_all(session, steps);
    if (!session.document().problems.empty()) throw InputError(session.document().problems.front());
    if (arguments.mechanism) return put_mechanism(arguments, session, format, job);
    PublicationStyle style = arguments.style;
    if (style.columns == 0) style.columns = session.plotted().columns();
    style.size = resolution_of(arguments.page, arguments.size, format);
    return put(arguments, session.trajectory(), session.error_estimate(), figure_of(session, style), session.proof(),
               format, job);
}

int draw(const FigureArguments& arguments, PictureJob& job) {
    const std::string format =
        format_for(arguments.out, arguments.format, ", or leave --format out: the name gives the format");
    if (format == "pdf") need_pdf_writer("--out " + arguments.out);
    check(arguments.page, "--width-mm");
    if (!arguments.at.empty() && !arguments.mechanism)
        throw InputError("--at " + arguments.at, {}, "an instant applies only to the mechanism", "add --mechanism");
    if (arguments.width > 0.0 && !arguments.proof)
        throw InputError(fmt::format("--width {}", arguments.width), {}, "a half-width applies only to a proof",
                         "add --proof; --width-mm is the width of the picture");
    if (arguments.proof && arguments.mechanism)
        throw InputError("--proof", {}, "a proof is drawn in plots over time, not in the mechanism",
                         "leave --mechanism out");
    if (format == "png") job.check_size(arguments.size.width, arguments.size.height);
    if (!arguments.steps.empty() || !arguments.journal.empty() || arguments.mechanism)
        return draw_session(arguments, format, job);
    const SystemDescription description = job.inputs().system(arguments.system);
    std::vector<std::string> points;
    const std::optional<InitialUncertainty> spread = spread_of(arguments, description, points);
    const Run run = requested_run(description, points, arguments.overrides);
    job.check(run.options);
    const auto model = std::make_shared<const Model>(description);
    const std::vector<ViewDescription> views = views_of(description, arguments.views);
    validate_overrides(*model, run, points);
    warn(description, run);
    job.add(arguments.out);

    const Trajectory trajectory = simulate(model, run);
    PublicationStyle style = arguments.style;
    style.ordered = !arguments.views.empty();
    style.size = resolution_of(arguments.page, arguments.size, format);
    style.shape = double{1} * arguments.size.width / arguments.size.height;
    std::optional<Proof> proof;
    if (spread) proof = proof_of(trajectory, *spread);
    const Proof* const drawn = proof ? &*proof : nullptr;
    const ErrorEstimate estimate = estimate_error(trajectory);
    return put(arguments, trajectory, &estimate,
               publication(trajectory, views, style, drawn, horizon_before_end(trajectory, estimate)), drawn, format,
               job);
}

void take_columns(const std::string& text, int& columns) {
    const double number = number_from("--columns", text);
    if (!(number >= 1.0 && number <= 20.0 && number == static_cast<int>(number)))
        throw InputError("--columns " + text, {}, "the number of columns must be a whole number from 1 to 20");
    columns = static_cast<int>(number);
}

}  // namespace

void add_figure(CLI::App& program, int& status, PictureJob& job) {
    const auto arguments = std::make_shared<FigureArguments>();
    CLI::App* command = program.add_subcommand("figure", "Draws plots of a run for print, as PNG, SVG or PDF");
    add_system_argument(*command, arguments->system);
    command->add_option("--out", arguments->out, "picture to write; - is standard output")
        ->required()
        ->type_name("F.png|F.svg|F.pdf");
    add_view_option(*command, arguments->views, "view of the system; repeatable (default: all)");
    command->add_option("--journal", arguments->journal, "journal to replay first; its plots are drawn")
        ->type_name("TOUR|F.journal");
    add_step_option(*command, arguments->steps, arguments->allow_files);
    add_format_option(*command, arguments->format, "format, if the name of --out does not give it");
    command
        ->add_option_function<std::string>(
            "--columns", [arguments](const std::string& text) { take_columns(text, arguments->style.columns); },
            "number of columns of panels (default: by the number of panels)")
        ->type_name("N");
    command->add_flag("--transparent", arguments->style.transparent, "leave out the background");
    command->add_flag("--dark", arguments->style.dark, "draw light on dark, for a screen");
    command->add_flag("--mechanism", arguments->mechanism, "draw the mechanism instead of plots");
    command->add_flag("--proof", arguments->proof,
                      "prove the run as `achilles prove` does and draw the proved tube in plots over time; --set "
                      "NAME=LOW..HIGH gives an interval");
    add_width_option(*command, arguments->width, "with --proof: ");
    command->add_option("--at", arguments->at, "with --mechanism: instant to draw, s (default: the start)")
        ->type_name("T");
    add_page_options(*command, arguments->page);
    add_size_options(*command, arguments->size.width, arguments->size.height, arguments->size.scale);
    add_run_options(*command, arguments->settings, arguments->overrides);
    command->callback([arguments, &status, &job] { status = draw(*arguments, job); });
}

}  // namespace achilles
