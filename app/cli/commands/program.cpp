// Parses the command line, runs a command, and prints errors as one message with exit status 2.

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <system_error>
#include <thread>

#include "cli/assets.hpp"
#include "cli/commands/commands.hpp"
#include "cli/commands/common.hpp"
#include "cli/explore.hpp"
#include "cli/sweep_work.hpp"
#include "cli/terminal.hpp"
#include "journal/link.hpp"
#include "mpi/ranks.hpp"
#include "output/output.hpp"
#include "pictures/picture_job.hpp"
#include "surface/offscreen.hpp"
#include "system/description.hpp"

namespace achilles {

namespace {

// The first word may be a command, or a system to explore, or missing.
void put_default_command(const CLI::App& program, std::vector<std::string>& words) {
    if (words.empty()) words.emplace_back(default_command);
    const std::string first = words.front();
    if (first == "--help" || first == "-h" || first == "--version") return;
    const std::vector<std::string> commands = command_names(program);
    if (std::find(commands.begin(), commands.end(), first) != commands.end()) return;
    if (first.empty() || first[0] != '-') {
        const std::vector<std::string> known = system_names();
        const bool is_system = std::find(known.begin(), known.end(), first) != known.end();
        std::error_code too_long;  // a link may be longer than a file name
        if (!is_system && !is_link(first) && std::filesystem::path(first).extension() != ".toml" &&
            !std::filesystem::exists(first, too_long))
            throw unknown_command(program, words);
    }
    words.insert(words.begin(), default_command);
}

// Throws InputError if standard output did not accept everything that was printed.
void finish_output() {
    errno = 0;
    std::cout.flush();
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout) return;
    throw InputError("standard output", {},
                     fmt::format("the output could not be written completely{}{}", errno == 0 ? "" : ": ",
                                 errno == 0 ? "" : std::strerror(errno)));
}

// Terminate handler for exceptions on a library's thread: prints a message, in particular for lack of memory.
[[noreturn]] void end_in_words() {
    try {
        if (const std::exception_ptr problem = std::current_exception()) std::rethrow_exception(problem);
    } catch (const std::bad_alloc&) {
        std::fputs("achilles: there is not enough memory for this\n", stderr);
        std::_Exit(stopped_early);
    } catch (const std::exception& error) {
        print_clean(stderr, "achilles: {}\n", error.what());
    } catch (...) {
    }
    std::abort();
}

int run(const std::vector<std::string>& words, const std::string& commit, Messages* ranks) {
    CLI::App program("Simulates mechanical systems with impacts past their Zeno points", "achilles");
    program.set_version_flag("--version", fmt::format("achilles {} ({})", version(), commit));
    program.require_subcommand(1);
    int status = reached_end;
    add_explore(program, status);
    add_simulate(program, status);
    add_prove(program, status);
    PictureJob job(words);
    add_pictures(program, status, job, ranks);
    add_html(program, status);
    add_reproduce(program, status);
    add_compare(program, status);
    add_check(program, status);
    add_list(program, status);
    add_manual(program, status);
    add_completion(program, status);
    add_icon(program, status);
    std::vector<std::string> with_command = words;
    put_default_command(program, with_command);
    try {
        program.parse(
            std::vector<std::string>(with_command.rbegin(), with_command.rend()));  // CLI11 expects reverse order
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
            const int printed = program.exit(error);  // --help or --version
            finish_output();
            return printed;
        }
        throw unreadable_command_line(error, program, words);
    }
    finish_output();
    return status;
}

// Runs as one of several processes started by mpirun. Only sweeps are shared: rank 0 runs the program, the others
// follow its orders and print nothing. All other commands run in every process.
int run_as_rank(const Launch& launch, const std::vector<std::string>& words, const std::string& commit) {
    std::optional<Ranks> ranks;
    try {
        ranks.emplace(launch);
    } catch (const InputError&) {
        // Rank 0 reports the error if it has the same one. The first process to fail ends all, so wait for rank 0.
        if (launch.rank > 0) std::this_thread::sleep_for(std::chrono::seconds(2));
        throw;
    }
    if (ranks->rank() == 0) return run(words, commit, &*ranks);
    help_with_sweep(*ranks);
    return reached_end;
}

int run_or_throw(const std::vector<std::string>& words, const std::string& commit) {
    const bool is_sweep = !words.empty() && words.front() == "sweep";
    const std::optional<Launch> launch = is_sweep ? find_launch() : std::nullopt;
    return launch ? run_as_rank(*launch, words, commit) : run(words, commit, nullptr);
}

}  // namespace

int run_program(const std::vector<std::string>& words, const std::string& commit) {
    std::set_terminate(end_in_words);
    try {
        return run_or_throw(words, commit);
    } catch (const InputError& error) {
        // A message about a place in a file starts with the place, so that editors find it.
        print_clean(stderr, "{}{}\n", error.file.empty() ? "achilles: " : "", error.what());
    } catch (const NotEnoughMemory& error) {
        print_clean(stderr, "achilles: {}\n", error.what());
        return stopped_early;
    } catch (const std::bad_alloc&) {
        std::fputs("achilles: there is not enough memory for this\n", stderr);
        return stopped_early;
    } catch (const std::system_error& error) {
        print_clean(stderr, "achilles: {}\n", error.what());
        if (error.code() == std::errc::resource_unavailable_try_again ||  // no thread or process available
            error.code() == std::errc::not_enough_memory)
            return stopped_early;
    } catch (const std::exception& error) {
        print_clean(stderr, "achilles: {}\n", error.what());
    }
    return bad_input;
}

namespace {

void add_options(CLI::App& command, ExploreOptions& options) {
    command.add_option("SYSTEM", options.system, "the path of a .toml file, a name from 'achilles list', or a link")
        ->type_name("");
    command.add_option("--journal", options.journal, "journal to replay first: a path, or the name of a tour")
        ->type_name("TOUR|F.journal");
    add_step_option(command, options.steps, options.allow_files);
    command.add_option("--record", options.record, "record this session as a journal")->type_name("F");
    add_size_options(command, options.width, options.height, options.scale);
    add_run_options(command, options.settings, options.overrides);
}

}  // namespace

void add_explore(CLI::App& program, int& status) {
    const auto options = std::make_shared<ExploreOptions>();
    CLI::App* command = program.add_subcommand("explore", "Opens the explorer window (the default command)");
    add_options(*command, *options);
    command->callback([options, &status] { status = explore(*options); });
}

void add_screenshot(CLI::App& program, int& status, PictureJob& job) {
    const auto options = std::make_shared<ScreenshotOptions>();
    CLI::App* command = program.add_subcommand("screenshot", "Draws the whole explorer as a PNG, without a display");
    add_options(*command, *options);
    command->add_option("--out", options->out, "the PNG to write")->required()->type_name("F.png");
    command->callback([options, &status, &job] { status = screenshot(*options, job); });
}

}  // namespace achilles
