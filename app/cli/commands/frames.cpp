#include <fmt/format.h>
#include <imgui.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <thread>

#include "cli/commands/commands.hpp"
#include "cli/commands/common.hpp"
#include "cli/terminal.hpp"
#include "figure/animation.hpp"
#include "model/model.hpp"
#include "paint/mechanism.hpp"
#include "pictures/frame_folder.hpp"
#include "pictures/picture_job.hpp"
#include "pictures/process_pool.hpp"
#include "pictures/progress.hpp"
#include "simulate/simulate.hpp"

namespace achilles {

namespace {

struct FramesArguments {
    std::string system, out;
    std::vector<std::string> views, settings;
    OptionOverrides overrides;
    StillSize size;
    double fps = 30.0, speed = 1.0;
    CameraMode camera = CameraMode::fit;
    int jobs = 1;
    bool overwrite = false;
};

// The instants of the frames.
struct Clock {
    double fps, speed, start, end;
    double last() const { return (end - start) * fps / speed; }
    std::size_t count() const { return static_cast<std::size_t>(std::floor(last() * (1.0 + 1e-12))) + 1; }
    double time(std::size_t frame) const { return std::min(start + static_cast<double>(frame) * speed / fps, end); }
};

void check_count(const Clock& clock) {
    if (clock.last() < static_cast<double>(most_frames)) return;
    throw InputError({}, {}, fmt::format("these would be more than {} frames", most_frames),
                     "fewer a second (--fps), a higher --speed or an earlier --end make it less");
}

// Without names, the first that are over time: they fit beside a mechanism.
std::vector<ViewDescription> views_for(const SystemDescription& description, const std::vector<std::string>& names) {
    std::vector<ViewDescription> views = views_of(description, names);
    constexpr std::size_t few = 3;
    if (names.empty() && views.size() > few) views.resize(few);
    return views;
}

class Painter {
 public:
    explicit Painter(const StillSize& size) : surface_(options(size)) {}
    std::string png(const Still& still, const Notes& notes) {
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

// A folder that ffmpeg, a shell and a person can read.
void tell(const FramesArguments& arguments, std::size_t count, std::size_t kept) {
    const std::filesystem::path folder = std::filesystem::absolute(arguments.out);
    const StillSize& size = arguments.size;
    print_clean(stdout, "{} frames of {}x{} in {}{}\n", count, size.width, size.height, folder.string(),
                kept > 0 ? fmt::format(" ({} were there)", kept) : "");
    // Players want even numbers of pixels.
    const bool odd = size.width % 2 != 0 || size.height % 2 != 0;
    print_clean(stdout, "ffmpeg -framerate {} -i {} {}-pix_fmt yuv420p {}.mp4\n", arguments.fps,
                shell_word((folder / "frame_%05d.png").string()), odd ? "-vf 'pad=ceil(iw/2)*2:ceil(ih/2)*2' " : "",
                shell_word(std::filesystem::path(arguments.system).stem().string()));
}

// Draws what is not there yet. Returns the exit status.
int draw_into(const FrameFolder& folder, const FramesArguments& arguments, const Clock& clock, Animation& animation,
              const std::function<Notes(const std::string&)>& notes_of) {
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
        Progress progress(numbers.size(), "frames");
        outcome = share_work(numbers.size(), arguments.jobs, begin, [&](std::size_t done) { progress.show(done); });
    }
    if (outcome.done < numbers.size()) {
        print_clean(stderr,
                    "achilles: a process that drew was ended by signal {}: {} of {} frames are missing\n"
                    "the same command draws those that are\n",
                    outcome.signal, numbers.size() - outcome.done, count);
        return stopped_early;
    }
    tell(arguments, count, count - numbers.size());
    return reached_end;
}

int draw_frames(const FramesArguments& arguments, PictureJob& job) {
    job.check_size(arguments.size.width, arguments.size.height);
    const SystemDescription description = job.inputs().system(arguments.system);
    const Run run = asked_run(description, arguments.settings, arguments.overrides);
    const auto model = std::make_shared<const Model>(description);
    const std::vector<ViewDescription> views = views_for(description, arguments.views);
    check_asked(*model, run, arguments.settings);
    warn(description, run);
    check_count({arguments.fps, arguments.speed, run.options.start_time, run.options.end_time});

    const Trajectory trajectory = simulate(model, run);
    const Clock clock{arguments.fps, arguments.speed, trajectory.run.options.start_time, trajectory.end_time};
    Animation animation(trajectory, views, arguments.size, arguments.speed / arguments.fps, arguments.camera);
    const std::vector<Shown> shown{{arguments.system, &trajectory}};
    int status = reached_end;
    if (job.reproduces()) {
        for (std::size_t i = 0; i < clock.count(); ++i)
            job.put("", frame_name(i), shown, [&](const Notes& notes) {
                return Painter(arguments.size).png(animation.at(clock.time(i)), notes);
            });
    } else {
        const FrameFolder folder(arguments.out);
        status = draw_into(folder, arguments, clock, animation,
                           [&](const std::string& name) { return job.notes_of(name, shown); });
    }
    return status == reached_end ? told_of(trajectory) : status;
}

CameraMode camera_from(const std::string& text) {
    const auto mode = camera_mode_from(text);
    if (!mode || *mode == CameraMode::fixed)
        throw InputError("--camera " + text, {}, "a camera is fit, follow or zeno");
    return *mode;
}

int jobs_from(const std::string& text) {
    const double number = number_from("--jobs", text);
    if (!(number >= 1.0 && number <= 256.0 && number == std::floor(number)))
        throw InputError("--jobs " + text, {}, "1 to 256 processes can draw");
    return static_cast<int>(number);
}

// Within limits that no film leaves, and where times are still told apart.
double within(const std::string& option, const std::string& text, double low, double high) {
    const double number = number_from(option, text);
    if (!(number >= low && number <= high))
        throw InputError(fmt::format("{} {}", option, text), {}, fmt::format("this must lie in [{}, {}]", low, high));
    return number;
}

}  // namespace

void add_frames(CLI::App& program, int& status, PictureJob& job) {
    const auto arguments = std::make_shared<FramesArguments>();
    arguments->jobs = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 256U));
    CLI::App* command = program.add_subcommand("frames", "Numbered PNGs of the mechanism in motion beside its plots");
    add_system_argument(*command, arguments->system);
    command->add_option("--out", arguments->out, "the folder; frames of the same command that are in it stay")
        ->required()
        ->type_name("DIR");
    const auto add_number = [&](const char* option, double& target, double low, double high, const char* about) {
        command
            ->add_option_function<std::string>(
                option,
                [&target, option, low, high](const std::string& text) { target = within(option, text, low, high); },
                about)
            ->type_name("X");
    };
    add_number("--fps", arguments->fps, 0.001, 1000.0, "frames for a second of the film (default 30)");
    add_number("--speed", arguments->speed, 1e-9, 1e9, "seconds of the run in a second of the film (default 1)");
    add_view_option(*command, arguments->views, "a view of the system; may be given again (default: the first three)");
    command
        ->add_option_function<std::string>(
            "--camera", [arguments](const std::string& text) { arguments->camera = camera_from(text); },
            "where the mechanism's picture looks: fit (all of the run, the default), follow (the body), zeno (closer "
            "and "
            "closer towards a Zeno point)")
        ->type_name("fit|follow|zeno");
    command
        ->add_option_function<std::string>(
            "--jobs", [arguments](const std::string& text) { arguments->jobs = jobs_from(text); },
            "processes that draw (default: as many as the machine has processors)")
        ->type_name("N");
    command->add_flag("--overwrite", arguments->overwrite, "replace frames of other commands");
    add_size_options(*command, arguments->size.width, arguments->size.height, arguments->size.scale);
    add_run_options(*command, arguments->settings, arguments->overrides);
    command->callback([arguments, &status, &job] { status = draw_frames(*arguments, job); });
}

}  // namespace achilles
