#include "pictures/paper.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/common.hpp"
#include "cli/terminal.hpp"
#include "figure/publication.hpp"
#include "model/model.hpp"
#include "pictures/frame_folder.hpp"
#include "pictures/picture_format.hpp"
#include "pictures/picture_job.hpp"
#include "simulate/simulate.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <optional>

namespace achilles {

namespace {

namespace fs = std::filesystem;

Trajectory run(PictureJob& job, const std::string& system) {
    const auto model = std::make_shared<const Model>(job.inputs().system(system));
    Run paper = model->default_run();
    job.check(paper.options);
    paper.options.truncation.conditions = Conditions::paper;  // the paper's figures use its truncation
    return simulate(model, paper);
}

int draw_paper(const fs::path& folder, const std::string& format, double scale, PictureJob& job) {
    if (format == "pdf") need_pdf_writer("--format pdf");
    std::optional<OutputFolder> output_folder;
    if (!job.reproduces()) output_folder.emplace(folder);
    const Trajectory ball = run(job, "ball_on_sine"), pendulum = run(job, "double_pendulum");
    const std::vector<NamedFigure> figures = paper_figures(ball, pendulum);
    const std::string table = paper_table(ball, pendulum), table_file = folder / "table.txt";
    const auto file_of = [&](const NamedFigure& figure) { return (folder / (figure.name + "." + format)).string(); };
    for (const NamedFigure& figure : figures) job.add(file_of(figure));
    job.add(table_file);
    for (const NamedFigure& figure : figures) {
        const PictureSize size{static_cast<int>(std::lround(figure.width * scale)),
                               static_cast<int>(std::lround(figure.height * scale)), scale * publication_scale};
        if (format == "png") job.check_size(size.width, size.height);
        job.put(file_of(figure), figure.name, {{"ball_on_sine", &ball}, {"double_pendulum", &pendulum}},
                [&](const Notes& notes) { return picture_of(figure.figure, size, notes, format); });
    }
    job.put_text(table_file, table);
    job.commit();
    if (job.reproduces()) return reached_end;

    print_clean(stdout, "{}\n", table);
    for (const NamedFigure& figure : figures) print_clean(stdout, "{}\n", fs::absolute(file_of(figure)).string());
    print_clean(stdout, "{}\n", fs::absolute(table_file).string());
    for (const Trajectory* trajectory : {&ball, &pendulum}) {
        if (trajectory->outcome.kind == Outcome::Kind::end_time) continue;
        print_clean(stderr, "achilles: a run stopped early: {}\n", trajectory->outcome.message);
        return stopped_early;
    }
    return reached_end;
}

}  // namespace

void add_paper(CLI::App& program, int& status, PictureJob& job) {
    struct PaperArguments {
        std::string out = "achilles-paper", format = "png";
        double scale = 1.0;
    };
    const auto arguments = std::make_shared<PaperArguments>();
    CLI::App* command =
        program.add_subcommand("paper", "Draws Fig. 4 (a)-(f) of the paper and compares its numbers with ours");
    command->add_option("--out", arguments->out, "folder for the pictures (default ./achilles-paper)")
        ->type_name("DIR");
    add_format_option(*command, arguments->format, "format of the pictures (default png)");
    add_scale_option(*command, arguments->scale);
    command->callback(
        [arguments, &status, &job] { status = draw_paper(arguments->out, arguments->format, arguments->scale, job); });
}

}  // namespace achilles
