#include "pictures/origin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "cli/overrides.hpp"
#include "figure/palette.hpp"
#include "image/notes.hpp"
#include "model/model.hpp"
#include "output/output.hpp"
#include "paint/svg.hpp"

namespace achilles {

namespace {

constexpr std::string_view bare_letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%^";

// Removes the first word, as written by shell_word(), from the text.
std::string take_word(std::string_view& text) {
    const auto refuse = [] { return std::runtime_error("the command stored in it is damaged: an incomplete word"); };
    std::string word;
    const std::size_t bare = std::min(text.find_first_not_of(bare_letters), text.size());
    if (bare > 0) {
        word = text.substr(0, bare);
        text.remove_prefix(bare);
        return word;
    }
    if (text.substr(0, 1) != "'") throw refuse();
    for (;;) {
        text.remove_prefix(1);
        const std::size_t end = text.find('\'');
        if (end == std::string_view::npos) throw refuse();
        word += text.substr(0, end);
        text.remove_prefix(end + 1);
        if (text.substr(0, 3) != "\\''") return word;
        word += '\'';
        text.remove_prefix(2);
    }
}

constexpr std::string_view software_key = "Software", title_key = "Title";  // standard PNG keywords
constexpr std::string_view command_key = "Achilles Command", picture_key = "Achilles Picture";

std::string key_of(InputSource::Kind kind) {
    switch (kind) {
        case InputSource::Kind::system:
            return "Achilles System";
        case InputSource::Kind::journal:
            return "Achilles Journal";
    }
    return {};
}

// "m = 1, g = 9.81, e = 0.5", in the shortest form that reads back to the same values.
std::string parameters_text(const Trajectory& trajectory) {
    const SystemDescription& description = trajectory.model->description();
    const Run& run = trajectory.run;
    std::string text;
    for (std::size_t i = 0; i < description.parameters.size(); ++i)
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", description.parameters[i].name, run.parameters[i]);
    for (std::size_t i = 0; i < description.coordinates.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        text += fmt::format("{0}{1}(0) = {2}, {1}'(0) = {3}", text.empty() ? "" : ", ", description.coordinates[i].name,
                            run.q[at], run.v[at]);
    }
    return text;
}

std::string options_text(const Options& options) {
    std::string text;
    for (const Option* option : options_in_report_order({"tolerance", "method"}))
        if (!option->omit_if_default || option->get(options) != option->get({}))
            text += (text.empty() ? "" : ", ") + summary_text(*option, options);
    return text;
}

std::string certificates_text(const Trajectory& trajectory) {
    std::string text;
    for (const RunWarning& remark : remarks(trajectory)) text += remark.sentence + "\n";
    for (const Event& event : trajectory.events)
        if (event.certificate)
            text += fmt::format("{} at t = {}: {}\n", names_of(event).name, event.t,
                                sentence(*event.certificate, trajectory.model->description()));
    return text + fmt::format("outcome: {} ({})", to_text(trajectory.outcome.kind), trajectory.outcome.message);
}

}  // namespace

std::string shell_word(const std::string& word) {
    if (!word.empty() && word.find_first_not_of(bare_letters) == std::string::npos) return word;
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
    return text + "'";
}

namespace {

// Options for output files and execution that do not change the picture.
bool is_output_option(const std::string& option) {
    return option == "--out" || option == "--jobs" || option == "--record" || option == "--overwrite" ||
           option == "--progress" || option == "--csv" || option == "--json" || option == "--hdf5" ||
           option == "--units" || option == "--resume" || option == "--threads";
}

bool is_flag(const std::string& option) {
    return option == "--overwrite" || option == "--progress" || option == "--units" || option == "--resume";
}

}  // namespace

std::string shell_line(const std::vector<std::string>& words) {
    std::string text = "achilles";
    for (const std::string& word : words) text += " " + shell_word(word);
    return text;
}

std::string prove_line(const std::string& system, const std::vector<std::string>& settings,
                       const OptionOverrides& overrides) {
    std::vector<std::string> words{"prove", system};
    for (const std::string& setting : settings) words.insert(words.end(), {"--set", setting});
    for (const char* key : {"start_time", "end_time"})
        if (const auto* given = overrides.find(option(key)))
            words.insert(words.end(), {given->first, to_text(given->second)});
    return shell_line(words);
}

std::string command_line(const std::vector<std::string>& words) {
    std::vector<std::string> kept;
    bool options_end = false;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string name = words[i].substr(0, words[i].find('='));
        options_end = options_end || words[i] == "--";
        if (!options_end && is_output_option(name)) {
            if (name == words[i] && !is_flag(name)) ++i;  // skip its value, the next word
            continue;
        }
        kept.push_back(words[i]);
    }
    return shell_line(kept);
}

std::vector<std::string> words_of(std::string_view text) {
    if (take_word(text) != "achilles") throw std::runtime_error("the command stored in it is not an achilles command");
    std::vector<std::string> words;
    while (!text.empty()) {
        if (text[0] != ' ') throw std::runtime_error("the command stored in it is damaged: a space is missing");
        text.remove_prefix(1);
        words.push_back(take_word(text));
    }
    return words;
}

Notes notes(const Origin& origin, const std::vector<PictureRun>& runs) {
    Notes result;
    const auto add = [&](std::string_view key, const std::string& text) { result.push_back({std::string(key), text}); };
    std::string title;
    for (const PictureRun& run : runs)
        title += (title.empty() ? "" : "; ") + run.trajectory->model->description().title;
    add(title_key, title);
    add(software_key, origin.software);
    add(command_key, origin.command);
    if (!origin.picture.empty()) add(picture_key, origin.picture);
    for (const PictureRun& run : runs) {
        const std::string name = runs.size() > 1 ? run.system + ": " : "";
        add("Achilles Parameters", name + parameters_text(*run.trajectory));
        add("Achilles Options", name + options_text(run.trajectory->run.options));
        add("Achilles Certificates", name + certificates_text(*run.trajectory));
    }
    for (const InputSource& source : origin.sources)
        add(key_of(source.kind), shell_word(source.name) + "\n" + source.text);
    return result;
}

std::string picture_format(std::string_view file) {
    if (file.starts_with("\x89PNG")) return "png";
    if (file.starts_with("%PDF-")) return "pdf";
    return file.find("<svg") == std::string_view::npos ? "" : "svg";
}

Notes notes_of(std::string_view file) {
    const std::string format = picture_format(file);
    if (format.empty())
        throw std::runtime_error("this is not a PNG, SVG or PDF file; a picture that achilles wrote is expected");
    return format == "png" ? png_notes(file) : format == "svg" ? svg_notes(file) : pdf_notes(file);
}

Origin origin_of(std::string_view file) {
    Origin origin;
    for (const Note& note : notes_of(file)) {
        if (note.keyword == software_key) origin.software = note.text;
        if (note.keyword == command_key) origin.command = note.text;
        if (note.keyword == picture_key) origin.picture = note.text;
        for (const InputSource::Kind kind : {InputSource::Kind::system, InputSource::Kind::journal}) {
            if (note.keyword != key_of(kind)) continue;
            std::string_view text = note.text;
            const std::string name = take_word(text);
            if (text.substr(0, 1) != "\n") throw std::runtime_error("a file stored in it is damaged: it has no name");
            origin.sources.push_back({kind, name, std::string(text.substr(1))});
        }
    }
    if (origin.command.empty()) throw std::runtime_error("this picture does not contain the command that made it");
    return origin;
}

}  // namespace achilles
