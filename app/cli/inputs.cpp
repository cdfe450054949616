#include "cli/inputs.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cli/assets.hpp"
#include "model/read_system.hpp"

namespace achilles {

namespace {

InputError not_carried(const std::string& name) {
    return {name, {}, "the picture does not contain this file", "the files stored in it are incomplete"};
}

}  // namespace

Inputs::Inputs(std::vector<Source> kept, const std::string& command)
    : kept_(std::move(kept)),
      from_picture_(true),
      trust_{
          Trust::Files::imagined, {}, {}, std::make_shared<Budget>("to make it without this limit, run:\n" + command)} {
    trust_.budget->limit();
    time_limit_.arm(trust_.budget->how_to_allow());
}

// Of a picture: what this name stood for when it was asked for so often; what came last stays.
const Source& Inputs::next(const std::string& name, bool is_journal) {
    const std::size_t wanted = asked_[{name, is_journal}]++;
    const Source* found = nullptr;
    std::size_t count = 0;
    for (const Source& source : kept_)
        if (source.name == name && (source.kind == Source::Kind::journal) == is_journal && count++ <= wanted)
            found = &source;
    if (found == nullptr) throw not_carried(name);
    return *found;
}

std::string Inputs::text(const std::string& name) {
    if (from_picture_) return next(name, false).text;
    kept_.push_back({Source::Kind::system, name, read_text(files_read_.emplace_back(find_system(name)))});
    return kept_.back().text;
}

std::string Inputs::data(const std::string& path) {
    if (from_picture_) return next(path, false).text;
    kept_.push_back({Source::Kind::system, path, read_text(files_read_.emplace_back(path))});
    return kept_.back().text;
}

// Messages call a system what it was called here: an explorer that shows one is a picture too, and must not depend on
// where the assets are.
SystemDescription Inputs::system(const std::string& name) { return parse_system(text(name), name); }

std::string Inputs::journal_text(const std::string& path) {
    if (from_picture_) return next(path, true).text;
    kept_.push_back({Source::Kind::journal, path, journal_file(files_read_.emplace_back(find_journal(path)))});
    return kept_.back().text;
}

std::vector<Command> Inputs::journal(const std::string& path) {
    if (trust_.budget) time_limit_.arm(trust_.budget->how_to_allow());
    std::vector<Command> commands = parse_trusted(journal_text(path), path, trust_);
    count(path, commands);
    return commands;
}

std::vector<Command> Inputs::steps(const std::vector<std::string>& lines) {
    std::vector<Command> commands = parse_steps(lines);
    if (from_picture_) count("--do", commands);
    return commands;
}

// Every command that is done was counted when it was read, so journals that replay one another come to an end.
void Inputs::count(const std::string& name, const std::vector<Command>& commands) {
    replayed_ += commands.size();
    if (replayed_ > most_replayed)
        throw Forbidden(name, {}, fmt::format("a session replays at most {} commands", most_replayed));
    changes_ += static_cast<std::size_t>(std::count_if(commands.begin(), commands.end(), [](const Command& command) {
        return change_of(command) == command::Change::together || change_of(command) == command::Change::alone;
    }));
    if (from_picture_ && changes_ > most_changes)
        throw Forbidden(name, {}, fmt::format("a picture is reproduced with at most {} changes", most_changes));
}

std::string Inputs::first_system() const {
    const auto first = std::find_if(kept_.begin(), kept_.end(),
                                    [](const Source& source) { return source.kind == Source::Kind::system; });
    if (first == kept_.end()) throw not_carried("SYSTEM");
    return first->name;
}

}  // namespace achilles
