#include "cli/commands/common.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>

#include "cli/commands/commands.hpp"
#include "cli/terminal.hpp"
#include "enclose/enclosure.hpp"
#include "output/output.hpp"
#include "output/proof.hpp"
#include "sensitivity/error_estimate.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

// Headings of --help.
constexpr const char* advanced_options = "Advanced";
constexpr const char* paper_options = "Size on paper";

template <class Number>
std::optional<Number> parse(std::string_view text) {
    Number value{};
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

// Help lists the options needed most often first, the others under a separate heading.
const char* group_of(const Option& option) {
    const bool is_usual = option.key == "end_time" || option.key == "tolerance";
    return is_usual ? "Options" : advanced_options;
}

void add_option(CLI::App& command, const Option& option, const std::string& flag, const std::string& about,
                OptionOverrides& overrides) {
    const auto take = [&option, flag, &overrides](const std::string& text) {
        overrides.by_flag.insert_or_assign(flag, value_from(option, flag, text));
    };
    const std::string value = !option.words.empty() ? fmt::format("{}", fmt::join(option.words, "|"))
                              : std::holds_alternative<int>(option.get({})) ? "N"
                                                                            : "X";
    command.add_option_function<std::string>(flag, take, about)->type_name(value)->group(group_of(option));
}

}  // namespace

int print_notes(const Trajectory& trajectory, bool with_reasons, const ErrorEstimate* estimate) {
    const bool is_whole = trajectory.outcome.kind == Outcome::Kind::end_time;
    if (!is_whole)
        print_clean(stderr, "achilles: the run stopped early: {}\n",
                    with_reasons ? trajectory.outcome.message : std::string(to_text(trajectory.outcome.kind)));
    if (with_reasons)
        for (const RunWarning& remark : estimate != nullptr ? remarks(trajectory, *estimate) : remarks(trajectory))
            print_clean(stderr, "achilles: warning: {}\n", remark.sentence);
    return is_whole ? reached_end : stopped_early;
}

int print_notes(const Enclosure& proof, bool with_reason) {
    if (proof.end) return reached_end;
    print_clean(stderr, "achilles: undecided at t = {}{}\n", reach_text(proof, 10),
                with_reason ? ": " + proof.outcome.message : "");
    return stopped_early;
}

void add_system_argument(CLI::App& command, std::string& system) {
    command.add_option("SYSTEM", system, "the path of a .toml file, or a name from 'achilles list'")
        ->required()
        ->type_name("");
}

void add_format_option(CLI::App& command, std::string& format, const std::string& about) {
    command.add_option("--format", format, about)
        ->type_name("png|svg|pdf")
        ->check(CLI::IsMember({"png", "svg", "pdf"}).description(""));
}

void add_view_option(CLI::App& command, std::vector<std::string>& views, const std::string& about) {
    command.add_option("--view", views, about)
        ->type_name("NAME")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_run_options(CLI::App& command, std::vector<std::string>& settings, OptionOverrides& overrides) {
    command
        .add_option(
            "--set", settings,
            "value of a parameter, a start x=0.3 or a rate x'=1.5; pi/6 and \"30 deg\" are also accepted; repeatable")
        ->type_name("NAME=VALUE")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    for (const Option* option : options_in_report_order()) {
        const std::string flag(option->flag), common = common_flag(*option);
        if (common != flag && option == &options_set_by(option->command)[0])
            add_option(command, *option, common, "set --eps-q, --eps-v and --eps-t together", overrides);
        const std::string unit = option->unit.empty() ? "" : fmt::format(", {}", option->unit);
        add_option(command, *option, flag,
                   fmt::format("{}{} (default: from the file, else {})", option->help, unit, to_text(option->get({}))),
                   overrides);
    }
}

void add_width_option(CLI::App& command, double& width, const std::string& about) {
    command
        .add_option_function<std::string>(
            "--width",
            [&width](const std::string& text) {
                width = number_from("--width", text);
                if (!(width >= 0.0)) throw InputError("--width " + text, {}, "the half-width must be 0 or more");
            },
            about + "half-width of the initial box in every coordinate and rate (default 0)")
        ->type_name("W");
}

void add_step_option(CLI::App& command, std::vector<std::string>& steps, bool& allow_files) {
    command.add_flag(
        "--allow-files", allow_files,
        "trust the journal: it may write files, read the files it names, and use time and memory without limit");
    command.add_option("--do", steps, "command of the explorer, such as \"seek 3.2\"; repeatable")
        ->type_name("COMMAND")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_scale_option(CLI::App& command, double& scale, const std::string& about) {
    const auto take_scale = [&scale](const std::string& text) {
        scale = number_from("--scale", text);
        if (!(scale >= 0.25 && scale <= 8.0))
            throw InputError("--scale " + text, {}, "the scale must lie in [0.25, 8]");
    };
    command.add_option_function<std::string>("--scale", take_scale, about)->type_name("S");
}

void add_size_options(CLI::App& command, int& width, int& height, double& scale, const std::string& about) {
    const auto take_size = [&width, &height](const std::string& text) {
        const std::size_t x = text.find('x');
        const auto w = parse<int>(std::string_view(text).substr(0, x));
        const auto h = x == std::string::npos ? std::nullopt : parse<int>(std::string_view(text).substr(x + 1));
        if (!w || !h || *w < 64 || *h < 64 || *w > 16384 || *h > 16384)
            throw InputError("--size " + text, {}, "this is not a size in pixels",
                             "write WIDTHxHEIGHT, as in --size 1600x1000; each from 64 to 16384");
        width = *w;
        height = *h;
    };
    const std::string size = fmt::format("pixels (default {}x{})", width, height);
    command.add_option_function<std::string>("--size", take_size, about.empty() ? size : about)->type_name("WxH");
    if (about.empty())
        add_scale_option(command, scale);
    else
        add_scale_option(command, scale, about);
}

void add_page_options(CLI::App& command, PaperSize& page) {
    const auto add = [&](const char* option, double& target, const char* type, const std::string& about) {
        command
            .add_option_function<std::string>(
                option,
                [&target, option, unit = std::string_view(type) == "MM" ? "mm" : ""](const std::string& text) {
                    target = number_from(option, text, unit);
                },
                about)
            ->type_name(type)
            ->group(paper_options);
    };
    add("--width-mm", page.width, "MM", "width on paper instead of --size, mm: 85 is a column, 170 a page");
    add("--height-mm", page.height, "MM", "with --width-mm: height, mm (default: what the plots need)");
    add("--font-pt", page.font, "PT",
        fmt::format("with --width-mm: size of the text, pt (default {:g})", default_font));
    add("--dpi", page.dpi, "N",
        fmt::format("with --width-mm: resolution of a PNG, dots per inch (default {:g})", default_dpi));
}

}  // namespace achilles
