#include "session/command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "expression/nearest.hpp"
#include "journal/words.hpp"

namespace achilles {

Command::Command(const Command& other) = default;
Command::Command(Command&& other) noexcept = default;
Command& Command::operator=(const Command& other) = default;
Command& Command::operator=(Command&& other) noexcept = default;
Command::~Command() = default;

command::UseOption::UseOption(std::string_view command, std::vector<OptionValue> for_each)
    : name(command), values(std::move(for_each)) {}

command::UseOption::UseOption(const Option& option, const Options& as_there) : name(option.command) {
    for (const Option& o : options_set_by(name)) values.push_back(o.get(as_there));
}

bool command::UseOption::is_of_one_value() const {
    return std::all_of(values.begin(), values.end(), [&](const OptionValue& value) { return value == values[0]; });
}

namespace {

OptionValue read_value(const Option& option, const Line& line, std::size_t i) {
    if (std::holds_alternative<double>(option.get({}))) return line.number(i);
    if (std::holds_alternative<int>(option.get({}))) return line.whole_number(i);
    const std::string& text = line.word(i).text;
    const auto found = std::find(option.words.begin(), option.words.end(), text);
    if (found != option.words.end()) return *found;
    throw line.error(line.word(i).column, fmt::format(fmt::runtime(option.wrong), text), std::string(option.usage));
}

// One value, for all options that the command sets, or one for each of them.
Command read_option(const Line& line, std::span<const Option> options) {
    const std::string& name = line.word(0).text;
    line.expect_arguments(1, options.size(), std::string(options[0].usage));
    if (line.count() != 2 && line.count() != options.size() + 1)
        throw line.error(line.word(2).column, fmt::format("{} takes one number or three", name),
                         fmt::format("write: {} 1e-6", name));
    std::vector<OptionValue> values;
    for (std::size_t i = 0; i < options.size(); ++i)
        values.push_back(read_value(options[i], line, line.count() == 2 ? 1 : i + 1));
    return command::UseOption(name, values);
}

Command read_set(const Line& line) {
    line.expect_arguments(2, 2, "write: set NAME VALUE");
    return command::Set{line.word(1).text, line.number(2)};
}

// The first word of a line, and how the rest is read.
struct Verb {
    std::string_view name;
    Command (*read)(const Line&);
};

template <class Kind>
Command read_alone(const Line& line) {
    line.expect_arguments(0, 0, "it stands alone");
    return Kind{};
}

template <class Kind>
Command read_number(const Line& line) {
    line.expect_arguments(1, 1, fmt::format("write: {} NUMBER", line.word(0).text));
    return Kind{line.number(1)};
}

Command read_open(const Line& line) {
    line.expect_arguments(1, 1, "write: open SYSTEM; a path with spaces stands in double quotes");
    return command::Open{line.word(1).text};
}

Command read_select(const Line& line) {
    line.expect_arguments(1, 1, "write: select NUMBER, counting the events from 1");
    return command::Select{line.whole_number(1)};
}

Command read_text_of_system(const Line& line) {
    line.expect_arguments(1, 1, "write: text \"the whole file\", with \\n for every new line");
    return command::Text{line.word(1).text};
}

// Save or Export: a file, and perhaps that it may be there already.
template <class Kind>
Command read_file_to_write(const Line& line) {
    const std::string usage = fmt::format("write: {0} FILE, or: {0} FILE overwrite", line.word(0).text);
    line.expect_arguments(1, 2, usage);
    if (line.count() == 3 && line.word(2).text != "overwrite")
        throw line.error(line.word(2).column, fmt::format("'{}' is not expected here", line.word(2).text), usage);
    return Kind{line.word(1).text, line.count() == 3};
}

Command read_copy(const Line& line) {
    const auto& things = command::copied_things;
    const std::string usage = fmt::format("write: copy {}", fmt::join(things, ", or: copy "));
    line.expect_arguments(1, 1, usage);
    const std::string& what = line.word(1).text;
    if (std::find(things.begin(), things.end(), what) == things.end())
        throw line.error(line.word(1).column, fmt::format("'{}' has no command{}", what, did_you_mean(what, things)),
                         usage);
    return command::Copy{what};
}

Command read_wait(const Line& line) {
    line.expect_arguments(1, 1, "write: wait SECONDS");
    const double seconds = line.number(1);
    if (seconds < 0.0) throw line.error(line.word(1).column, "nobody can wait for the past", "write: wait SECONDS");
    return command::Wait{seconds};
}

Command read_say(const Line& line) {
    line.expect_arguments(1, 1, "write: say \"a sentence\", or: say \"\"");
    return command::Say{line.word(1).text};
}

Command read_replay(const Line& line) {
    line.expect_arguments(1, 1, "write: replay JOURNAL; a path with spaces stands in double quotes");
    return command::Replay{line.word(1).text};
}

template <bool pinned>
Command read_pin(const Line& line) {
    line.expect_arguments(0, 0, "it stands alone");
    return command::Pin{pinned};
}

template <bool shown>
Command read_show(const Line& line) {
    line.expect_arguments(1, 1, fmt::format("write: {} editor", line.word(0).text));
    const auto& things = command::shown_things;
    const std::string& what = line.word(1).text;
    if (std::find(things.begin(), things.end(), what) == things.end())
        throw line.error(line.word(1).column,
                         fmt::format("there is no '{}' to show{}", what, did_you_mean(what, things)),
                         fmt::format("these can be shown: {}", fmt::join(things, ", ")));
    return command::Show{what, shown};
}

Command read_start(const Line& line) {
    const std::string usage = "write: start NAME VALUE NAME VALUE ...";
    line.expect_arguments(2, 64, usage);
    command::Start start;
    for (std::size_t i = 1; i < line.count(); i += 2) {
        if (i + 1 == line.count()) throw line.error(line.word(i).column, "this name has no value", usage);
        start.values.emplace_back(line.word(i).text, line.number(i + 1));
    }
    return start;
}

Command read_look(const Line& line) {
    const std::string usage = "write: look X Y WIDTH, or: look all";
    if (line.count() == 2 && line.word(1).text == "all") return command::LookAll{};
    line.expect_arguments(3, 3, usage);
    return command::Look{line.number(1), line.number(2), line.number(3)};
}

Command read_step(const Line& line) {
    line.expect_arguments(1, 1, "write: step 1, or: step -1");
    return command::Step{line.whole_number(1)};
}

Command read_grid(const Line& line) {
    line.expect_arguments(2, 2, "write: grid COLUMNS ROWS");
    return command::Grid{line.whole_number(1), line.whole_number(2)};
}

Command read_plot(const Line& line) {
    line.expect_arguments(3, 12, "write: plot NUMBER X Y..., expressions with spaces in double quotes");
    return command::PlotView{line.whole_number(1), line.word(2).text, line.words_from(3)};
}

Command read_zoom(const Line& line) {
    line.expect_arguments(5, 5, "write: zoom NUMBER X_LOW X_HIGH Y_LOW Y_HIGH");
    return command::Zoom{line.whole_number(1), line.number(2), line.number(3), line.number(4), line.number(5)};
}

Command read_fit(const Line& line) {
    line.expect_arguments(1, 1, "write: fit NUMBER");
    return command::Fit{line.whole_number(1)};
}

// Whether the second argument is x, and not y.
bool read_axis(const Line& line, const std::string& usage) {
    const std::string& axis = line.word(2).text;
    if (axis != "x" && axis != "y") throw line.error(line.word(2).column, "an axis is x or y", usage);
    return axis == "x";
}

Command read_log(const Line& line) {
    const std::string usage = "write: log NUMBER x on, or: log NUMBER y off";
    line.expect_arguments(3, 3, usage);
    return command::AxisScale{line.whole_number(1), read_axis(line, usage), line.is_on(3, usage)};
}

Command read_range(const Line& line) {
    const std::string usage = "write: range NUMBER x LOW HIGH, or: range NUMBER y LOW HIGH";
    line.expect_arguments(4, 4, usage);
    return command::Range{line.whole_number(1), read_axis(line, usage), line.number(3), line.number(4)};
}

Command read_curve(const Line& line) {
    const std::string usage = "write: curve PLOT NUMBER on, or: curve PLOT NUMBER off";
    line.expect_arguments(3, 3, usage);
    return command::ShowCurve{line.whole_number(1), line.whole_number(2), line.is_on(3, usage)};
}

template <class Kind>
Command read_on_off(const Line& line) {
    const std::string usage = fmt::format("write: {0} on, or: {0} off", line.word(0).text);
    line.expect_arguments(1, 1, usage);
    return Kind{line.is_on(1, usage)};
}

Command read_theme(const Line& line) {
    const std::string usage = "write: theme light, or: theme dark";
    line.expect_arguments(1, 1, usage);
    const std::string& name = line.word(1).text;
    if (name != "light" && name != "dark")
        throw line.error(line.word(1).column, fmt::format("there is no theme '{}'", name), usage);
    return command::UseTheme{name == "dark"};
}

Command read_size(const Line& line) {
    const std::string usage = "write: size controls 0.3 (a share of the window), or: size plots auto";
    line.expect_arguments(2, 2, usage);
    const std::string& panel = line.word(1).text;
    const auto& panels = command::sized_panels;
    if (std::find(panels.begin(), panels.end(), panel) == panels.end())
        throw line.error(line.word(1).column,
                         fmt::format("there is no panel '{}'{}", panel, did_you_mean(panel, panels)), usage);
    if (line.word(2).text == "auto") return command::Size{panel, 0.0};
    const double share = line.number(2);
    if (!(share > 0.0 && share < 1.0))
        throw line.error(line.word(2).column, fmt::format("a panel cannot take {} of the window", share), usage);
    return command::Size{panel, share};
}

constexpr std::array<Verb, 38> verbs{{{"open", read_open},
                                      {"set", read_set},
                                      {"seek", read_number<command::Seek>},
                                      {"play", read_alone<command::Play>},
                                      {"pause", read_alone<command::Pause>},
                                      {"select", read_select},
                                      {"new", read_alone<command::New>},
                                      {"text", read_text_of_system},
                                      {"save", read_file_to_write<command::Save>},
                                      {"show", read_show<true>},
                                      {"hide", read_show<false>},
                                      {"grid", read_grid},
                                      {"plot", read_plot},
                                      {"zoom", read_zoom},
                                      {"fit", read_fit},
                                      {"range", read_range},
                                      {"log", read_log},
                                      {"curve", read_curve},
                                      {"link", read_on_off<command::Link>},
                                      {"start", read_start},
                                      {"look", read_look},
                                      {"speed", read_number<command::Speed>},
                                      {"loop", read_on_off<command::Loop>},
                                      {"step", read_step},
                                      {"undo", read_alone<command::Undo>},
                                      {"redo", read_alone<command::Redo>},
                                      {"pin", read_pin<true>},
                                      {"unpin", read_pin<false>},
                                      {"lens", read_number<command::Lens>},
                                      {"theme", read_theme},
                                      {"size", read_size},
                                      {"reset", read_alone<command::Reset>},
                                      {"done", read_alone<command::Done>},
                                      {"export", read_file_to_write<command::Export>},
                                      {"copy", read_copy},
                                      {"wait", read_wait},
                                      {"say", read_say},
                                      {"replay", read_replay}}};

}  // namespace

Command parse_command(std::string_view text, const std::string& file, int line_number) {
    const Line line(text, file, line_number);
    if (line.count() == 0) throw line.error(1, "there is no command here");
    if (const auto options = options_set_by(line.word(0).text); !options.empty()) return read_option(line, options);
    std::vector<std::string> names;
    for (const auto group : options_by_command()) names.emplace_back(group[0].command);
    for (const Verb& verb : verbs) {
        if (verb.name == line.word(0).text) return verb.read(line);
        names.emplace_back(verb.name);
    }
    throw line.error(
        line.word(0).column,
        fmt::format("there is no command '{}'{}", line.word(0).text, did_you_mean(line.word(0).text, names)),
        fmt::format("the commands are: {}", fmt::join(names, ", ")));
}

}  // namespace achilles
