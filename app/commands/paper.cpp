#include "figure/paper.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "assets.hpp"
#include "commands/commands.hpp"
#include "commands/common.hpp"
#include "image/image.hpp"
#include "model/model.hpp"
#include "paint/paint.hpp"
#include "simulate/simulate.hpp"
#include "surface/offscreen.hpp"
#include "write_files.hpp"

namespace achilles {

namespace {

namespace fs = std::filesystem;

Trajectory run(const std::string& system) {
    const auto model = std::make_shared<const Model>(open_system(find_system(system), {}, {}));
    Run paper = model->default_run();
    paper.options.truncation.conditions = Conditions::paper;  // its figures show its truncation
    return simulate(model, paper);
}

std::string png(const NamedFigure& named, double scale) {
    SurfaceOptions options;
    options.width = static_cast<int>(std::lround(named.width * scale));
    options.height = static_cast<int>(std::lround(named.height * scale));
    options.scale = scale;
    options.figure_text_size = named.figure.text_size;
    options.curve_fineness = 2;
    options.fonts = assets() / "fonts";
    Offscreen surface(options);
    const Rectangle area{0.0F, 0.0F, static_cast<float>(options.width), static_cast<float>(options.height)};
    return png_bytes(surface.frame([&] { paint(named.figure, ImGui::GetBackgroundDrawList(), area, scale); }));
}

int draw_paper(const fs::path& folder, double scale) {
    std::error_code problem;
    fs::create_directories(folder, problem);
    if (!fs::is_directory(folder))
        throw InputError(folder.string(), {}, fmt::format("the folder cannot be made: {}", problem.message()));

    const Trajectory ball = run("ball_on_sine"), pendulum = run("double_pendulum");
    const std::vector<NamedFigure> figures = paper_figures(ball, pendulum);
    const std::string table = paper_table(ball, pendulum), table_file = folder / "table.txt";
    OutputFiles files;
    const auto file_of = [&](const NamedFigure& figure) { return (folder / (figure.name + ".png")).string(); };
    for (const NamedFigure& figure : figures) files.add(file_of(figure));
    files.add(table_file);
    for (const NamedFigure& figure : figures) files.put(file_of(figure), png(figure, scale));
    files.put(table_file, table);
    files.commit();

    fmt::print("{}\n", table);
    for (const NamedFigure& figure : figures) fmt::print("{}\n", fs::absolute(file_of(figure)).string());
    fmt::print("{}\n", fs::absolute(table_file).string());
    for (const Trajectory* trajectory : {&ball, &pendulum}) {
        if (trajectory->outcome.kind == Outcome::Kind::end_time) continue;
        fmt::print(stderr, "achilles: a run stopped early: {}\n", trajectory->outcome.message);
        return stopped_early;
    }
    return reached_end;
}

}  // namespace

void add_paper(CLI::App& program, int& status) {
    struct Arguments {
        std::string out = "achilles-paper";
        double scale = 1.0;
    };
    const auto arguments = std::make_shared<Arguments>();
    CLI::App* command = program.add_subcommand("paper", "Figure 4 (a)-(f) of the paper, and its numbers beside ours");
    command->add_option("--out", arguments->out, "the folder for the PNG files (default ./achilles-paper)")
        ->type_name("DIR");
    add_scale_option(*command, arguments->scale);
    command->callback([arguments, &status] { status = draw_paper(arguments->out, arguments->scale); });
}

}  // namespace achilles
