#include "golden/pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "app/program.hpp"
#include "cli/assets.hpp"
#include "cli/commands/commands.hpp"
#include "cli/overrides.hpp"
#include "figure/animation.hpp"
#include "figure/compose.hpp"
#include "figure/proof.hpp"
#include "figure/sweep_figure.hpp"
#include "journal/journal.hpp"
#include "model/read_system.hpp"
#include "output/output.hpp"
#include "pictures/paper.hpp"
#include "pictures/picture_job.hpp"
#include "session/session.hpp"
#include "simulate/simulate.hpp"

namespace achilles::golden {

namespace {

namespace fs = std::filesystem;

// Runs a command of the program in an empty folder and lists the files that it writes, texts first.
class CommandOutput {
 public:
    explicit CommandOutput(const std::string& command, const std::string& environment = {}) {
        const test::Answer answer = folder_.run(command, "MESA_SHADER_CACHE_DISABLE=true " + environment);
        if (answer.status != reached_end && answer.status != stopped_early)
            throw std::runtime_error(fmt::format("achilles {}\n{}", command, answer.err));
    }
    Image image(const std::string& file) const { return read_png(folder_.path() / file); }
    std::vector<Layer> layers() const {
        std::vector<std::string> files = folder_.files();
        std::sort(files.begin(), files.end());
        std::vector<Layer> texts, images;
        for (const std::string& file : files) {
            if (fs::path(file).extension() == ".png")
                images.push_back({file, image(file)});
            else
                texts.push_back({file, test::content(folder_.path() / file)});
        }
        texts.insert(texts.end(), images.begin(), images.end());
        return texts;
    }

 private:
    test::Folder folder_;
};

constexpr const char* image_name = "picture.png";

Trajectory run_of(const std::string& system, std::optional<Conditions> conditions) {
    const auto model = std::make_shared<const Model>(read_system(find_system(system)));
    Run run = model->default_run();
    if (conditions) run.options.truncation.conditions = *conditions;
    return simulate(model, run);
}

std::vector<Layer> figure_layers(const std::string& system) {
    const Trajectory trajectory = gallery_run(system);
    return {{"trajectory.txt", to_text(trajectory)},
            {"figure.txt", to_text(gallery_figure(trajectory, {}))},
            {image_name, image_of(figure_command(system))}};
}

// All files that `achilles paper` writes.
std::vector<Layer> paper_layers() {
    const Trajectory ball = run_of("ball_on_sine", Conditions::paper);
    const Trajectory pendulum = run_of("double_pendulum", Conditions::paper);
    std::string figures;
    for (const NamedFigure& figure : paper_figures(ball, pendulum))
        figures += fmt::format("{} {} x {}\n{}", figure.name, figure.width, figure.height, to_text(figure.figure));
    std::vector<Layer> layers{{"trajectory.txt", to_text(ball) + to_text(pendulum)}, {"figure.txt", figures}};
    for (Layer& layer : CommandOutput("paper --scale 0.5 --out .").layers()) layers.push_back(std::move(layer));
    return layers;
}

// The text without the path of the systems folder, which differs between machines.
std::string anywhere(std::string text) {
    const std::string folder = find_system("ball_on_sine").parent_path().string() + "/";
    for (std::size_t at = text.find(folder); at != std::string::npos; at = text.find(folder))
        text.erase(at, folder.size());
    return text;
}

std::vector<Layer> explorer_layers(const fs::path& journal) {
    SystemSource library;
    library.find = find_system;
    library.save = [](Document& document, const std::string& file, bool) { mark_saved(document, file); };
    library.exports = false;
    const std::string first = "ball_on_sine";  // the system that the program opens without arguments
    Session session(first, read_system(find_system(first)), std::move(library));
    for (const Command& command : read_journal(journal)) session.apply(command);
    const std::string trajectory = to_text(session.trajectory()), state = anywhere(to_text(session));
    Figure plots;
    plots.panels = session.plots();
    for (std::size_t i = 0; i < plots.panels.size() && session.proof() != nullptr; ++i)
        plots.panels[i] = session.drawn(i);
    return {{"trajectory.txt", trajectory},
            {"figure.txt", state.substr(0, state.size() - trajectory.size()) + to_text(plots)},
            {image_name, image_of(explorer_command(journal))}};
}

// The frame at the fourth step of 4 s of a system of tests/golden/frame, which has elements that no gallery system has.
std::vector<Layer> frame_layers(const fs::path& system) {
    constexpr double step = 4.0;
    const auto model = std::make_shared<const Model>(read_system(system));
    const Trajectory trajectory = simulate(model, model->default_run());
    Animation animation(trajectory, model->description().views, {frame_width, frame_height}, step);
    const CommandOutput frames(fmt::format("frames '{}' --fps {} --size {}x{} --jobs 1 --out .", system.string(),
                                           1.0 / step, frame_width, frame_height));
    return {{"figure.txt", to_text(animation.at(3.0 * step))}, {image_name, frames.image("frame_00003.png")}};
}

// The line of the file has the system and the options for `achilles sweep`.
std::vector<Layer> sweep_layers(const fs::path& file) {
    std::string line = test::content(file);
    line.erase(line.find_last_not_of('\n') + 1);
    const std::size_t space = line.find(' ');
    const auto model = std::make_shared<const Model>(read_system(find_system(line.substr(0, space))));
    const SweepTable table(model, read_sweep(line.substr(space + 1), model->description()));
    SweepData data(table);
    data.add(table.rows(0, table.sweep().count()));
    const CommandOutput made(fmt::format("sweep {} --size {}x{} --scale {} --out {}", line, figure_width, figure_height,
                                         figure_size, image_name));
    return {{"figure.txt", to_text(compose_sweep(data))}, {image_name, made.image(image_name)}};
}

// The line of the file has the system and the options with values for `achilles figure --proof`.
std::vector<Layer> proof_layers(const fs::path& file) {
    const std::string line = test::content(file).substr(0, test::content(file).find('\n'));
    std::istringstream words(line);
    std::string system, option, value;
    words >> system;
    const SystemDescription description = read_system(find_system(system));
    std::vector<std::string> settings, views, points;
    double width = 0.0, end = default_run(description).options.end_time;
    while (words >> option >> value) {
        if (option == "--set") settings.push_back(value);
        if (option == "--view") views.push_back(value);
        if (option == "--width") width = std::stod(value);
        if (option == "--end") end = std::stod(value);
    }
    const InitialUncertainty spread = parse_uncertainty(settings, width, description, points);
    Run run = requested_run(description, points, {});
    run.options.end_time = end;
    const Trajectory trajectory = simulate(std::make_shared<const Model>(description), run);
    const Proof proof = proof_of(trajectory, spread);
    PublicationStyle style;
    style.ordered = !views.empty();
    style.shape = double{figure_width} / figure_height;
    return {{"figure.txt", to_text(publication(trajectory, views_of(description, views), style, &proof))},
            {image_name, image_of(fmt::format("figure {} --proof --size {}x{} --scale {}", line, figure_width,
                                              figure_height, figure_size))}};
}

template <class Make>
void add_files(std::vector<GoldenPicture>& pictures, const std::string& kind, const fs::path& folder,
               const char* extension, Make make) {
    if (!fs::is_directory(folder)) return;
    for (const auto& entry : fs::directory_iterator(folder))
        if (const fs::path file = entry.path(); file.extension() == extension)
            pictures.push_back({kind + "/" + file.stem().string(), [file, make] { return make(file); }});
}

}  // namespace

std::vector<GoldenPicture> pictures() {
    std::vector<GoldenPicture> all;
    for (const std::string& system : system_names())
        all.push_back({"figure/" + system, [system] { return figure_layers(system); }});
    all.push_back({"paper", paper_layers});
    add_files(all, "frame", place().goldens / "frame", ".toml", frame_layers);
    add_files(all, "sweep", place().goldens / "sweep", ".sweep", sweep_layers);
    add_files(all, "proof", place().goldens / "proof", ".proof", proof_layers);
    add_files(all, "explorer", place().goldens / "explorer", ".journal", explorer_layers);
    add_files(all, "tour", ACHILLES_SOURCE_DIR "/assets/journals", ".journal", explorer_layers);
    std::sort(all.begin(), all.end(), [](const GoldenPicture& a, const GoldenPicture& b) { return a.name < b.name; });
    return all;
}

Trajectory gallery_run(const std::string& system) { return run_of(system, {}); }

// All views, those over time first, in the order of `achilles figure`.
Figure gallery_figure(const Trajectory& trajectory, const PublicationStyle& style) {
    std::vector<ViewDescription> views = trajectory.model->description().views;
    std::stable_partition(views.begin(), views.end(), [](const ViewDescription& view) { return view.x.text == "t"; });
    return publication(trajectory, views, style);
}

Image image_of(const std::string& command, const std::string& environment) {
    return CommandOutput(fmt::format("{} --out {}", command, image_name), environment).image(image_name);
}

std::string figure_command(const std::string& system) {
    return fmt::format("figure {} --size {}x{} --scale {}", system, figure_width, figure_height, figure_size);
}

std::string explorer_command(const fs::path& journal) {
    const std::string text = journal_file(journal), sign = "# achilles ";
    const std::string command = text.rfind(sign, 0) == 0 ? text.substr(sign.size(), text.find('\n') - sign.size())
                                                         : "screenshot --size 1200x750";
    return fmt::format("{} --journal '{}'", command, journal.string());
}

}  // namespace achilles::golden
