#include <fmt/format.h>
#include <imgui.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <optional>
#include <thread>

#include "cli/commands/commands.hpp"
#include "cli/commands/common.hpp"
#include "cli/terminal.hpp"
#include "figure/animation.hpp"
#include "model/model.hpp"
#include "paint/paint.hpp"
#include "pictures/film.hpp"
#include "pictures/frame_folder.hpp"
#include "pictures/picture_job.hpp"
#include "pictures/process_pool.hpp"
#include "session/replay_script.hpp"
#include "simulate/simulate.hpp"

namespace achilles {

namespace fs = std::filesystem;

namespace {

struct FramesArguments {
    std::string system, out;
    std::vector<std::string> views, settings, steps;
    bool allow_files = false, progress = false;
    OptionOverrides overrides;
    StillSize size;
    double fps = 30.0, speed = 1.0;
    CameraMode camera = CameraMode::fit;
    std::optional<ViewAngles> direction;
    int jobs = 1;
    bool overwrite = false;
};

// The times of the frames.
struct FrameTimes {
    double fps, speed, start, end;
    double last() const { return (end - start) * fps / speed; }
    std::size_t count() const { return static_cast<std::size_t>(std::floor(last() * (1.0 + 1e-12))) + 1; }
    double time(std::size_t frame) const { return std::min(start + static_cast<double>(frame) * speed / fps, end); }
};

void check_count(const FrameTimes& clock) {
    if (clock.last() < static_cast<double>(max_frames)) return;
    throw InputError({}, {}, fmt::format("this would take more than {} frames", max_frames),
                     "use a lower --fps, a higher --speed or an earlier --end");
}

// Default views: the first ones over time, which fit beside a mechanism.
std::vector<ViewDescription> views_for(const SystemDescription& description, const std::vector<std::string>& names) {
    std::vector<ViewDescription> views = views_of(description, names);
    constexpr std::size_t few = 3;
    if (names.empty() && views.size() > few) views.resize(few);
    return views;
}

class Painter {
 public:
    explicit Painter(const StillSize& size) : surface_(options(size)) {}
    std::string png(const AnimationFrame& still, const Notes& notes) {
        return surface_.png([&] { paint(still, ImGui::GetBackgroundDrawList()); }, notes);
    }

 private:
    static SurfaceOptions options(const StillSize& size) {
        SurfaceOptions options;
        options.width = size.width;
        options.height = size.height;
        options.scale = still_scale(size);
        options.text_size = still_title_size;
        return options;
    }
    PictureSurface surface_;
};

fs::path folder_of(const FramesArguments& arguments) {
    return is_film(arguments.out) ? frames_folder(arguments.out) : fs::path(arguments.out);
}

// Prints the folder and the command that joins its frames.
void tell(const FramesArguments& arguments, std::size_t count, std::size_t kept) {
    const fs::path folder = fs::absolute(folder_of(arguments));
    const StillSize& size = arguments.size;
    print_clean(stdout, "{} frames of {}x{} in {}{}\n", count, size.width, size.height, folder.string(),
                kept > 0 ? fmt::format(" ({} already existed)", kept) : "");
    const std::string film = is_film(arguments.out) ? fs::absolute(arguments.out).string()
                                                    : fs::path(arguments.system).stem().string() + ".mp4";
    std::string line;
    for (const std::string& word : join_words({folder, arguments.fps, size.width, size.height}, film))
        line += (line.empty() ? "" : " ") + shell_word(word);
    print_clean(stdout, "{}\n", line);
}

// Replaces the frames by the joined animation; keeps them if ffmpeg fails. Returns the exit status.
int join(const FramesArguments& arguments, std::size_t count, PictureJob& job) {
    const fs::path folder = folder_of(arguments);
    if (arguments.progress) print_clean(stderr, "[joining {} frames\n", count);
    try {
        // With --progress lines are printed only while frames are drawn.
        std::optional<Progress> progress;
        if (!arguments.progress) progress.emplace(count, "frames joined");
        job.put_text(arguments.out, joined({folder, arguments.fps, arguments.size.width, arguments.size.height},
                                           arguments.out, [&](std::size_t frames) {
                                               if (progress && frames <= count) progress->show(frames);
                                           }));
    } catch (const std::runtime_error& problem) {
        print_clean(stderr, "achilles: {}\n", problem.what());
        tell(arguments, count, 0);
        return stopped_early;
    }
    job.commit();
    remove_frames(folder, count);
    print_clean(stdout, "{}: {} frames of {}x{}, {:g} per second\n", fs::absolute(arguments.out).string(), count,
                arguments.size.width, arguments.size.height, arguments.fps);
    return reached_end;
}

// Draws the missing frames. Returns the exit status.
int draw_into(const FrameFolder& folder, const FramesArguments& arguments, const FrameTimes& clock,
              Animation& animation, const std::function<Notes(const std::string&)>& notes_of) {
    const std::size_t count = clock.count();
    const std::vector<std::size_t> numbers = folder.missing(count, notes_of, arguments.overwrite);
    if (!numbers.empty()) folder.try_to_write(numbers.front());
    const auto begin = [&]() -> std::function<void(std::size_t)> {
        const auto painter = std::make_shared<Painter>(arguments.size);
        return [&, painter](std::size_t task) {
            const std::size_t number = numbers[task];
            folder.write(number, painter->png(animation.at(clock.time(number)), notes_of(frame_name(number))));
        };
    };
    CrewOutcome outcome;
    {
        Progress progress(numbers.size(), "frames", arguments.progress);
        outcome = share_work(numbers.size(), arguments.jobs, begin, [&](std::size_t done) { progress.show(done); });
    }
    if (outcome.done < numbers.size()) {
        print_clean(stderr,
                    "achilles: a drawing process was ended by signal {}: {} of {} frames are missing\nrun the same "
                    "command again to draw them\n",
                    outcome.signal, numbers.size() - outcome.done, count);
        return stopped_early;
    }
    if (!is_film(arguments.out)) tell(arguments, count, count - numbers.size());
    return reached_end;
}

// What is animated: a run, and the plots beside it.
struct Scenario {
    Trajectory trajectory;
    std::vector<ViewDescription> views;
};

Scenario plain(const FramesArguments& arguments, PictureJob& job) {
    const SystemDescription description = job.inputs().system(arguments.system);
    const Run run = requested_run(description, arguments.settings, arguments.overrides);
    job.check(run.options);
    const auto model = std::make_shared<const Model>(description);
    std::vector<ViewDescription> views = views_for(description, arguments.views);
    validate_overrides(*model, run, arguments.settings);
    warn(description, run);
    check_count({arguments.fps, arguments.speed, run.options.start_time, run.options.end_time});
    return {simulate(model, run), std::move(views)};
}

// The run and the plots of an explorer session after --do commands. The session's threads end here, since processes are
// started later.
Scenario after_steps(const FramesArguments& arguments, PictureJob& job) {
    if (!arguments.views.empty())
        throw InputError("--view " + arguments.views[0], {}, "--do already sets the plots",
                         "leave --view out, or --do");
    job.inputs().trust(trust_of(arguments.allow_files, {arguments.system}, work_options(arguments.overrides)));
    Session session = open_session(arguments.system, job.inputs().system(arguments.system), arguments.settings,
                                   arguments.overrides, source_of(job), {});
    apply_all(session, job.inputs().steps(arguments.steps));
    std::vector<ViewDescription> views;
    for (const Plot& plot : session.plotted().list()) views.push_back(plot.view);
    return {session.trajectory(), std::move(views)};
}

int draw_frames(const FramesArguments& arguments, PictureJob& job) {
    job.check_size(arguments.size.width, arguments.size.height);
    if (!job.reproduces()) check_frames_out(arguments.out, arguments.system);
    const Scenario scenario = arguments.steps.empty() ? plain(arguments, job) : after_steps(arguments, job);
    const Trajectory& trajectory = scenario.trajectory;
    const FrameTimes clock{arguments.fps, arguments.speed, trajectory.run.options.start_time, trajectory.end_time};
    check_count(clock);
    if (arguments.direction && !SpaceView::shows(*trajectory.model))
        throw InputError("--turn", {}, "the mechanism of this system lies in a plane and cannot be turned",
                         "leave --turn out");
    Animation animation(trajectory, scenario.views, arguments.size, arguments.speed / arguments.fps, arguments.camera,
                        arguments.direction);
    const std::vector<PictureRun> shown{{arguments.system, &trajectory}};
    int status = reached_end;
    if (job.reproduces()) {
        for (std::size_t i = 0; i < clock.count(); ++i)
            job.put("", frame_name(i), shown, [&](const Notes& notes) {
                return Painter(arguments.size).png(animation.at(clock.time(i)), notes);
            });
    } else {
        if (is_film(arguments.out)) job.add(arguments.out);
        const FrameFolder folder(folder_of(arguments));
        status = draw_into(folder, arguments, clock, animation,
                           [&](const std::string& name) { return job.notes_of(name, shown); });
        if (status == reached_end && is_film(arguments.out)) status = join(arguments, clock.count(), job);
    }
    return status == reached_end ? print_notes(trajectory) : status;
}

CameraMode camera_from(const std::string& text) {
    const auto mode = camera_mode_from(text);
    if (!mode || *mode == CameraMode::fixed)
        throw InputError("--camera " + text, {}, "the camera must be fit, follow or zeno");
    return *mode;
}

int jobs_from(const std::string& text) {
    const double number = number_from("--jobs", text);
    if (!(number >= 1.0 && number <= 256.0 && number == std::floor(number)))
        throw InputError("--jobs " + text, {}, "the number of processes must be a whole number from 1 to 256");
    return static_cast<int>(number);
}

// Parses a number within limits far beyond practical animations, for which frame times are still distinct.
double within(const std::string& option, const std::string& text, double low, double high) {
    const double number = number_from(option, text);
    if (!(number >= low && number <= high))
        throw InputError(fmt::format("{} {}", option, text), {},
                         fmt::format("the value must lie in [{}, {}]", low, high));
    return number;
}

ViewAngles direction_from(const std::string& text) {
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos)
        throw InputError("--turn " + text, {}, "two angles are needed, in degrees", "write --turn 30,45");
    return {within("--turn", text.substr(0, comma), -360.0, 360.0),
            within("--turn", text.substr(comma + 1), -90.0, 90.0)};
}

}  // namespace

void add_frames(CLI::App& program, int& status, PictureJob& job) {
    const auto arguments = std::make_shared<FramesArguments>();
    arguments->jobs = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 256U));
    CLI::App* command =
        program.add_subcommand("frames", "Draws the mechanism in motion beside its plots: a film, or numbered PNGs");
    add_system_argument(*command, arguments->system);
    command
        ->add_option("--out", arguments->out,
                     "film to write (needs ffmpeg), or folder for the frames; frames that the same command already "
                     "drew are kept")
        ->required()
        ->type_name("F.mp4|F.gif|DIR");
    const auto add_number = [&](const char* option, double& target, double low, double high, const char* about) {
        command
            ->add_option_function<std::string>(
                option,
                [&target, option, low, high](const std::string& text) { target = within(option, text, low, high); },
                about)
            ->type_name("X");
    };
    add_number("--fps", arguments->fps, 0.001, 1000.0, "frames per second of the film (default 30)");
    add_number("--speed", arguments->speed, 1e-9, 1e9, "seconds of the run per second of the film (default 1)");
    add_view_option(*command, arguments->views, "view of the system; repeatable (default: the first three)");
    command
        ->add_option_function<std::string>(
            "--camera", [arguments](const std::string& text) { arguments->camera = camera_from(text); },
            "camera: fit (the whole run, the default), follow (the body), zeno (zooms in on a Zeno point)")
        ->type_name("fit|follow|zeno");
    command
        ->add_option_function<std::string>(
            "--turn", [arguments](const std::string& text) { arguments->direction = direction_from(text); },
            "direction from which a system in space is seen, degrees: about the vertical, and its tilt")
        ->type_name("ABOUT,TILT");
    command
        ->add_option_function<std::string>(
            "--jobs", [arguments](const std::string& text) { arguments->jobs = jobs_from(text); },
            "number of drawing processes (default: one per core)")
        ->type_name("N");
    add_step_option(*command, arguments->steps, arguments->allow_files);
    command->add_flag("--dark", arguments->size.dark, "draw light on dark");
    command->add_flag("--overwrite", arguments->overwrite, "replace frames of other commands");
    command->add_flag("--progress", arguments->progress,
                      "print progress lines on standard error, for a program to read");
    add_size_options(*command, arguments->size.width, arguments->size.height, arguments->size.scale);
    add_run_options(*command, arguments->settings, arguments->overrides);
    command->callback([arguments, &status, &job] { status = draw_frames(*arguments, job); });
}

}  // namespace achilles
