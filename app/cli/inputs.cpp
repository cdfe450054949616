#include "cli/inputs.hpp"

#include <algorithm>

#include "cli/assets.hpp"
#include "journal/journal.hpp"
#include "model/read_system.hpp"

namespace achilles {

namespace {

InputError not_carried(const std::string& name) {
    return {name, {}, "the picture does not carry this file", "its origin is incomplete"};
}

}  // namespace

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
    if (from_picture_) {
        const Source& source = next(name, false);
        if (source.kind == Source::Kind::refusal) throw InputError({}, {}, source.text);
        return source.text;
    }
    try {
        kept_.push_back({Source::Kind::system, name, read_text(find_system(name))});
    } catch (const InputError& error) {
        kept_.push_back({Source::Kind::refusal, name, error.what()});
        throw;
    }
    return kept_.back().text;
}

// Messages call a system what it was called here: an explorer that shows one is a picture too, and must not depend on
// where the assets are.
SystemDescription Inputs::system(const std::string& name) { return parse_system(text(name), name); }

std::string Inputs::journal(const std::string& path) {
    if (from_picture_) return next(path, true).text;
    kept_.push_back({Source::Kind::journal, path, journal_file(find_journal(path))});
    return kept_.back().text;
}

std::string Inputs::first_system() const {
    const auto first = std::find_if(kept_.begin(), kept_.end(),
                                    [](const Source& source) { return source.kind == Source::Kind::system; });
    if (first == kept_.end()) throw not_carried("SYSTEM");
    return first->name;
}

}  // namespace achilles
