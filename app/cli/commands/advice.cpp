#include "cli/commands/commands.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <optional>
#include <sstream>
#include <string_view>

#include "cli/assets.hpp"
#include "expression/name_suggestions.hpp"
#include "expression/parse.hpp"
#include "pictures/origin.hpp"
#include "pictures/picture_format.hpp"
#include "system/input_error.hpp"
#include "system/read_tables.hpp"

namespace achilles {

namespace {

using Words = std::vector<std::string>;

// An option or command of achilles and its names in other programs.
struct OtherWords {
    std::string_view known, typed;
};

constexpr OtherWords other_commands[] = {
    {"simulate", "run sim solve integrate execute compute start export"},
    {"figure", "plot draw fig graph picture image render"},
    {"frames", "animate animation movie film video"},
    {"explore", "gui open view window show edit demo interactive"},
    {"prove", "verify certify proof enclose"},
    {"check", "validate lint equations info"},
    {"list", "ls systems gallery examples models"},
    {"new", "init create template"},
    {"help", "man manual docs usage"},
    {"sweep", "scan batch vary bifurcation poincare montecarlo"},
    {"orbit", "periodic limit-cycle continuation continue"},
    {"screenshot", "capture snapshot"},
    {"reproduce", "redo"},
    {"compare", "diff difference imgdiff pixelmatch odiff"},
    {"--version", "version -v --ver"},
    {"--help", "-help -? /? /help"},
};

// The first entry that the command has is suggested.
constexpr OtherWords other_options[] = {
    {"out", "output outfile o file filename save savefig export png svg pdf figure film movie mp4 dir"},
    {"json", "output"},
    {"csv", "o"},
    {"hdf5", "hdf h5"},
    {"end", "t-end tend tmax t-max t-final tfinal tf t1 duration time t stop stop-time until tspan t-span timespan"},
    {"start-time", "t0 tstart start t-start"},
    {"tolerance", "tol rtol atol reltol abstol accuracy precision"},
    {"method", "solver integrator scheme taylor dopri5 rk45 ode45"},
    {"set", "param parameter params p d var initial init ic x0 q0 value range interval box"},
    {"max-impacts", "max-events nmax"},
    {"max-steps", "max-iter maxiter"},
    {"memory", "mem"},
    {"size", "figsize geometry resolution pixels width height"},
    {"font-pt", "fontsize font font-size"},
    {"scale", "zoom"},
    {"jobs", "threads j nproc workers cores"},
    {"threads", "jobs j np nproc parallel workers cores"},
    {"random", "samples"},
    {"samples", "n points nsamples npoints num steps"},
    {"view", "plot plots views panel"},
    {"over", "vary range scan sweep grid axis"},
    {"print", "measure quantity observe metric echo"},
    {"resume", "restart continue"},
    {"fps", "frame-rate framerate"},
    {"speed", "slowmotion slow"},
    {"dark", "black dark-mode theme"},
    {"transparent", "alpha no-background"},
    {"split", "subdivide parts"},
    {"eps-q", "eps-x"},
    {"eps", "epsilon"},
    {"derivatives", "sensitivities gradient jacobian"},
    {"latex", "tex"},
    {"overwrite", "force f"},
    {"at", "section event"},
    {"do", "command"},
    {"journal", "replay"},
    {"verbose", "v timing"},
    {"threshold", "tolerance tol fuzz max-difference max-diff limit"},
    {"conditions", "sharp paper"},
    {"simultaneous", "moreau"},
    {"energy-gain", "cap"},
    {"max-events", "max-sticks max-slips"},
};

// Options of other programs that achilles does not need, with an explanation.
constexpr OtherWords no_options[] = {
    {"the step size follows from --tolerance; --samples N sets the number of rows in a file",
     "dt step stepsize step-size timestep"},
    {"the system needs no option: achilles COMMAND SYSTEM", "system model input i"},
    {"the options of a run are set in [run] of the system file", "config"},
    {"write an angle in degrees as --set \"theta1=30 deg\"", "degrees deg"},
    {"leave it out, and send the output to /dev/null", "quiet q silent"},
};

// "--T_end=5": the name t-end and the value 5.
struct TypedOption {
    explicit TypedOption(const std::string& word) {
        const std::size_t equals = std::min(word.find('='), word.size());
        if (equals < word.size()) value = word.substr(equals + 1);
        typed = word.substr(0, equals);
        exact = typed.substr(std::min(typed.find_first_not_of('-'), typed.size()));
        name = exact;
        for (char& c : name) c = c == '_' ? '-' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    std::string typed, exact, name, value;
};

bool is_option(const std::string& word) { return word.size() > 1 && word[0] == '-' && word.find(' ') == word.npos; }

// "--out F.png": the option with the word typed as its value, if any.
std::string with_value(const CLI::Option& option, const std::string& value) {
    if (option.get_items_expected_max() == 0) return option.get_name();
    std::string type = option.get_type_name();
    type = type.substr(0, type.find('|'));
    return fmt::format("{} {}", option.get_name(), value.empty() ? type : shell_word(value));
}

bool is_number(const std::string& word) {
    return !word.empty() && word.find_first_not_of("+-.0123456789eE") == word.npos;
}

// "write --start-time 0 --end 5" for 0:5, [0, 5] or 0:0.01:5; "" for a single value.
std::string span_of(std::string value) {
    for (char& c : value)
        if (std::string_view("[](),:").find(c) != std::string_view::npos) c = ' ';
    std::istringstream stream(value);
    const Words times{std::istream_iterator<std::string>(stream), {}};
    if (times.size() < 2) return "";
    return fmt::format("write --start-time {} --end {}", shell_word(times.front()), shell_word(times.back()));
}

class CommandLine {
 public:
    CommandLine(const CLI::App& program, const Words& words) : program_(program), words_(words) {
        const auto chosen = program.get_subcommands();
        command_ = chosen.empty() ? &program : chosen.front();
        name_ = chosen.empty() ? "" : command_->get_name();
    }

    // Report the first unknown option before any other mistake: its value would be reported as one.
    InputError explain(const CLI::ParseError& error) const {
        const Words rest = program_.remaining(true);
        const auto unknown = std::find_if(rest.begin(), rest.end(), is_option);
        if (unknown != rest.end()) return of_option(*unknown);
        if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) return missing_option_error(error.what());
        if (!rest.empty()) return unexpected_word_error(rest.front());
        if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) return mismatch_error(error.what());
        const std::string what = error.what();
        const CLI::Option* option = named_in(what);
        if (dynamic_cast<const CLI::ValidationError*>(&error) != nullptr && option != nullptr) {
            std::string choices = option->get_type_name();
            choices.resize(std::min(choices.find(":{"), choices.size()));  // CLI11 lists them twice
            for (std::size_t bar = choices.find('|'); bar != choices.npos; bar = choices.find('|'))
                choices.replace(bar, 1, choices.find('|', bar + 1) == choices.npos ? " or " : ", ");
            return message(fmt::format("{} is {}", option->get_name(), choices), "");
        }
        if (option != nullptr && option->get_items_expected_max() == 0)
            return message(fmt::format("{0} takes no value; write {0} alone", option->get_name()), "");
        return message(what, help());
    }

 private:
    static InputError message(const std::string& what, const std::string& advice) {
        return {{}, {}, advice.empty() ? what : what + "; " + advice};
    }

    std::string help() const {
        return fmt::format("'achilles {}{}--help' lists the options", name_, name_.empty() ? "" : " ");
    }

    // The option at the start or the end of CLI11's message.
    const CLI::Option* named_in(const std::string& what) const {
        for (const CLI::Option* option : command_->get_options())
            if (const std::string name = option->get_name();
                what.starts_with(name + ":") || what.starts_with(name + " ") || what.ends_with(" " + name))
                return option;
        return nullptr;
    }

    // The word after an option, unless it is an option itself.
    std::string value_behind(const std::string& typed) const {
        const auto at = std::find(words_.begin(), words_.end(), typed);
        return at == words_.end() || at + 1 == words_.end() || is_option(*(at + 1)) ? "" : *(at + 1);
    }

    std::optional<SystemDescription> system() const { return named_system(words_); }

    // "--set e=0.3" or, for several values, --over e=0:0.9:100.
    std::string setting(const std::string& name, const std::string& value) const {
        const bool is_range = value.find(':') != value.npos;
        const char* const flag = is_range && option_of(*command_, "over") != nullptr ? "--over" : "--set";
        return fmt::format("write {} {}", flag, shell_word(name + "=" + (value.empty() ? "VALUE" : value)));
    }

    // Suggests another command that has the option.
    std::string elsewhere(const TypedOption& option) const {
        for (const CLI::App* other : program_.get_subcommands({}))
            if (const CLI::Option* known = option_of(*other, option.name); other != command_ && known != nullptr)
                return fmt::format("{} is an option of achilles {}", known->get_name(), other->get_name());
        return "";
    }

    // Suggests the command that writes this kind of file: `figure` for .png.
    std::string writer_of(const std::string& file) const {
        const std::string ending = ending_of(file);
        const auto has = [&](const char* flag) { return option_of(*command_, flag) != nullptr; };
        const bool is_picture = !ending_of_picture(file).empty();
        if ((is_picture || ending == "mp4" || ending == "gif") && has("out")) return "write --out " + shell_word(file);
        const std::optional<SystemDescription> described = system();
        const std::string typed = described ? shell_word(described->file) : "SYSTEM";
        if (is_picture) return fmt::format("write achilles figure {} --out {}", typed, shell_word(file));
        if (ending == "mp4" || ending == "gif")
            return fmt::format("write achilles frames {} --out {}", typed, shell_word(file));
        for (const auto& [known, flag] : {std::pair{"csv", "csv"}, std::pair{"json", "json"}, std::pair{"h5", "hdf5"},
                                          std::pair{"hdf5", "hdf5"}, std::pair{"journal", "journal"}})
            if (ending == known && has(flag)) return fmt::format("write --{} {}", flag, shell_word(file));
        return "";
    }

    std::string advice_for(const TypedOption& option, const std::string& value) const {
        const std::optional<SystemDescription> known = system();
        const Words settable = known ? settable_names(*known) : Words();
        if (std::find(settable.begin(), settable.end(), option.exact) != settable.end())
            return setting(option.exact, value);
        if (const CLI::Option* same = option_of(*command_, option.name))  // -end, --END, --start_time
            return "write " + with_value(*same, value);
        if (option.name == "out" || option.name == "o" || option.name == "output")
            if (const std::string writer = writer_of(value); !writer.empty()) return writer;
        for (const OtherWords& other : no_options)
            if (has_word(other.typed, option.name)) return std::string(other.known);
        for (const OtherWords& other : other_options) {
            const CLI::Option* meant = has_word(other.typed, option.name) ? option_of(*command_, other.known) : nullptr;
            if (meant == nullptr) continue;
            if (const std::string both = option.name.ends_with("span") ? span_of(value) : ""; !both.empty())
                return both;
            const bool is_word = other.known == "method" || other.known == "conditions" ||
                                 other.known == "simultaneous" || other.known == "energy-gain";
            const bool is_setting = other.known == "set" && value.find('=') == value.npos;
            return "write " + with_value(*meant, is_word && value.empty() ? option.name : is_setting ? "" : value);
        }
        if (const std::string other = elsewhere(option); !other.empty()) return other;
        Words names;
        for (const CLI::Option* one : command_->get_options())
            for (const std::string& name : one->get_lnames()) names.push_back(name);
        if (const std::string best = nearest(option.name, names); !best.empty())
            return fmt::format("did you mean '--{}'?", best);
        const std::string best = option.exact.size() > 1 ? nearest(option.exact, settable) : "";
        return best.empty() ? help() : setting(best, value);
    }

    InputError of_option(const std::string& word) const {
        TypedOption option(word);
        std::string value = option.value.empty() ? value_behind(word) : option.value;
        if (const std::string end = value_behind(value); option.name.ends_with("span") && is_number(end))
            value += ":" + end;
        return message(name_.empty() ? fmt::format("there is no option {}", shown(option.typed))
                                     : fmt::format("{} has no option {}", name_, shown(option.typed)),
                       advice_for(option, value));
    }

    InputError missing_option_error(const std::string& what) const {
        const std::string missing = what.substr(0, what.find(' '));
        const CLI::Option* option = named_in(what);
        if (missing == "SYSTEM")
            return message("a system is missing",
                           fmt::format("write achilles {} NAME: a name from 'achilles list', or a .toml file", name_));
        if (missing == "PICTURE")
            return message("a picture is missing", "write achilles reproduce F.png, with a picture that Achilles made");
        if (missing == "BEFORE" || missing == "AFTER")
            return message("a picture is missing", "write achilles compare BEFORE.png AFTER.png, or two folders");
        if (missing == "NAME") return message("a name is missing", "for example, achilles new mine writes mine.toml");
        if (option == nullptr) return message(what, help());
        for (const std::string& extra : program_.remaining(true))
            if (const std::string writer = writer_of(extra); !writer.empty())
                return message(fmt::format("{} is missing", missing), writer);
        return message(fmt::format("{} is missing", missing), "write " + with_value(*option, ""));
    }

    InputError mismatch_error(const std::string& what) const {
        const CLI::Option* option = named_in(what);
        if (option == nullptr) return message(what, help());
        const std::string name = option->get_name();
        if (what.find("At Most") != what.npos) return message(fmt::format("{} is given twice", name), "leave one out");
        if (option->get_items_expected_max() == 0) return message(name + " takes no value", "write it alone");
        const bool is_stream = name == "--csv" || name == "--json";
        return message(name + " needs a value",
                       fmt::format("write {}{}", with_value(*option, ""),
                                   is_stream ? fmt::format(", or {} - for standard output", name) : ""));
    }

    InputError unexpected_word_error(const std::string& word) const {
        const std::string what = fmt::format("'{}' is not expected here", shown(word));
        const Words commands = command_names(program_);
        if (std::find(commands.begin(), commands.end(), word) != commands.end()) {
            Words right = words_;
            right.erase(std::find(right.begin(), right.end(), word));
            right.insert(right.begin(), word);
            return message(what, "the command comes first: " + shown(shell_line(right)));
        }
        if (const std::string writer = writer_of(word); !writer.empty()) return message(what, writer);
        const auto at = std::find(words_.begin(), words_.end(), word);
        if (at != words_.begin() && at != words_.end() && at - 1 != words_.begin() && *(at - 2) == "--set")
            return message(what, fmt::format("write --set {}", shell_word(*(at - 1) + "=" + word)));
        if (const std::size_t equals = word.find('='); equals != word.npos && equals > 0)
            return message(what, setting(word.substr(0, equals), word.substr(equals + 1)));
        if (option_of(*command_, word) != nullptr) return message(what, fmt::format("write --{}", word));
        const auto options = command_->get_options();
        const bool has_system = std::any_of(options.begin(), options.end(), [](const CLI::Option* option) {
            return option->get_name() == "SYSTEM" && option->count() > 0;
        });
        if (!has_system) return message(what, help());
        std::string system;
        command_->get_option("SYSTEM")->results(system);
        return message(what, fmt::format("the system is {}; {}", shown(system), help()));
    }

    const CLI::App& program_;
    const Words& words_;
    const CLI::App* command_;
    std::string name_;
};

}  // namespace

std::vector<std::string> command_names(const CLI::App& program) {
    Words names;
    for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
    return names;
}

const CLI::Option* option_of(const CLI::App& command, std::string_view name) {
    for (const CLI::Option* option : command.get_options())
        for (const std::string& known : option->get_lnames())
            if (known == name) return option;
    return nullptr;
}

std::optional<SystemDescription> named_system(const std::vector<std::string>& words) {
    for (const std::string& word : words) {
        if (is_option(word)) continue;
        try {
            const std::filesystem::path file = find_system(word);
            if (std::filesystem::is_regular_file(file)) return read_tables(read_text(file), word).system;
        } catch (const InputError&) {
        }
    }
    return std::nullopt;
}

InputError unknown_command(const CLI::App& program, const std::vector<std::string>& words) {
    const std::string& first = words.front();
    const std::string what = fmt::format("there is no command or system '{}'", shown(first));
    std::string lower = first;
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const auto with_first = [&](std::string_view word) {
        Words right = words;
        right.front() = word;
        return InputError({}, {}, fmt::format("{}; write {}", what, shown(shell_line(right))));
    };
    for (const OtherWords& other : other_commands)
        if (has_word(other.typed, lower)) return with_first(other.known);
    const Words commands = command_names(program);
    if (const std::string command = nearest(first, commands); !command.empty()) return with_first(command);
    Words known = system_names();
    const std::string system = did_you_mean(first, known);
    return {{},
            {},
            what + (system.empty() ? "; 'achilles --help' lists the commands, 'achilles list' the systems" : system)};
}

InputError unreadable_command_line(const CLI::ParseError& error, const CLI::App& program,
                                   const std::vector<std::string>& words) {
    return CommandLine(program, words).explain(error);
}

}  // namespace achilles
