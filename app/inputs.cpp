#include "inputs.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "assets.hpp"

namespace achilles {

namespace {

InputError not_carried(const std::string& name) {
    return {name, {}, "the picture does not carry this file", "its origin is incomplete"};
}

}  // namespace

const Source* Inputs::find(Source::Kind kind, const std::string& name) const {
    const auto found = std::find_if(kept_.begin(), kept_.end(),
                                    [&](const Source& source) { return source.kind == kind && source.name == name; });
    return found == kept_.end() ? nullptr : &*found;
}

void Inputs::keep(Source source) {
    if (find(source.kind, source.name) == nullptr) kept_.push_back(std::move(source));
}

SystemDescription Inputs::system(const std::string& name) {
    // Asked for again it is the same, whatever became of the file. Messages call it what it was called here: an
    // explorer that shows one is a picture too, and must not depend on where the assets are.
    if (const Source* refusal = find(Source::Kind::refusal, name)) throw InputError({}, {}, refusal->text);
    if (const Source* known = find(Source::Kind::system, name)) return parse_system(known->text, name);
    if (from_picture_) throw not_carried(name);
    try {
        keep({Source::Kind::system, name, read_file(find_system(name))});
    } catch (const InputError& error) {
        keep({Source::Kind::refusal, name, error.what()});
        throw;
    }
    return parse_system(kept_.back().text, name);
}

std::string Inputs::journal(const std::string& path) {
    if (const Source* known = find(Source::Kind::journal, path)) return known->text;
    if (from_picture_) throw not_carried(path);
    keep({Source::Kind::journal, path, read_file(path)});
    return kept_.back().text;
}

std::string Inputs::first_system() const {
    const auto first = std::find_if(kept_.begin(), kept_.end(),
                                    [](const Source& source) { return source.kind == Source::Kind::system; });
    if (first == kept_.end()) throw not_carried("SYSTEM");
    return first->name;
}

}  // namespace achilles
