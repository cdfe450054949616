#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/commands/commands.hpp"
#include "cli/terminal.hpp"
#include "output/output.hpp"
#include "pictures/picture_format.hpp"
#include "pictures/picture_job.hpp"
#include "system/description.hpp"

namespace achilles {

namespace {

constexpr std::size_t largest_to_reproduce = std::size_t{1} << 30;  // bytes
constexpr std::size_t max_words = 2000;                             // the longest stored command line that is read

// Adds the name of the picture to errors.
template <class Work>
auto with_name(const std::string& picture, const Work& work) {
    try {
        return work();
    } catch (const InputError&) {
        throw;
    } catch (const std::runtime_error& error) {
        throw InputError(picture, {}, error.what());
    }
}

// Runs the command of an origin; its output is left in the job. Only commands that make pictures are available.
int run_again(const std::string& picture, const Origin& origin, const std::string& format, PictureJob& job) {
    CLI::App program("what makes pictures", "achilles");
    program.require_subcommand(1);
    int status = bad_input;
    add_pictures(program, status, job);
    std::vector<std::string> words = words_of(origin.command);
    if (words.size() > max_words)
        throw InputError(picture, {},
                         fmt::format("its command has {} words; at most {} are allowed here", words.size(), max_words));
    words.insert(words.end(), {"--out", "picture." + format});
    std::reverse(words.begin(), words.end());  // CLI11 expects reverse order
    try {
        program.parse(words);
    } catch (const CLI::ParseError& error) {
        throw InputError(picture, {}, fmt::format("its command cannot be run here: {}", error.what()), origin.command);
    }
    if (!job.made())
        throw InputError(picture, {},
                         fmt::format("the command stored in this file makes no picture named '{}'", origin.picture),
                         origin.command);
    return status;
}

int reproduce(const std::string& picture, const std::string& out) {
    OutputFiles files;
    files.protect_input(picture);
    if (!out.empty()) files.add(out);
    const std::string before = read_text(picture, largest_to_reproduce);
    if (before.size() > largest_to_reproduce) throw InputError(picture, {}, "this file is too large for a picture");
    const Origin origin = with_name(picture, [&] { return origin_of(before); });
    if (!out.empty()) format_for(out, picture_format(before));
    PictureJob job(origin);
    const int status = with_name(picture, [&] { return run_again(picture, origin, picture_format(before), job); });
    job.inputs().end_time_limit();
    const std::string& after = *job.made();
    if (!out.empty()) files.put(out, after);
    files.commit();
    if (out != "-") print_clean(stdout, "{}\n", origin.command);
    if (after == before) {
        print_clean(stderr, "achilles: {}: reproduced with the same bytes\n", picture);
        return status;
    }
    const std::string here = "Achilles " + version();
    print_clean(stderr, "achilles: {}: reproduced with different bytes{}\n", picture,
                origin.software == here ? "" : fmt::format(" (it was made by {}, this is {})", origin.software, here));
    return made_differently;
}

}  // namespace

void add_pictures(CLI::App& program, int& status, PictureJob& job, Messages* ranks) {
    add_sweep(program, status, job, ranks);
    add_orbit(program, status, job);
    add_figure(program, status, job);
    add_frames(program, status, job);
    add_paper(program, status, job);
    add_screenshot(program, status, job);
}

void add_reproduce(CLI::App& program, int& status) {
    struct ReproduceArguments {
        std::string picture, out;
    };
    const auto arguments = std::make_shared<ReproduceArguments>();
    CLI::App* command = program.add_subcommand(
        "reproduce", "Prints the command that made a picture, and reproduces its bytes from the picture alone");
    command
        ->add_option("PICTURE", arguments->picture,
                     "PNG, SVG or PDF made by figure, sweep, orbit, frames, paper or screenshot")
        ->required()
        ->type_name("");
    command->add_option("--out", arguments->out, "picture to write (default: only compare the bytes)")->type_name("F");
    command->callback([arguments, &status] { status = reproduce(arguments->picture, arguments->out); });
}

}  // namespace achilles
