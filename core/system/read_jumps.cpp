// Reads [[jump]]: what a jump follows, and what it sets.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "expression/name_suggestions.hpp"
#include "expression/parse.hpp"
#include "system/keys.hpp"
#include "system/read_tables.hpp"

namespace achilles {

std::vector<std::string> names_of_contacts(const SystemDescription& system) {
    std::vector<std::string> names;
    for (const ConstraintDescription& constraint : system.constraints) names.push_back(constraint.name);
    return names;
}

namespace {

// What a jump follows: one word is the name of a contact. Throws Mistake.
void read_on(const SystemDescription& system, const Names& known, const Fields& fields, JumpDescription& jump) {
    const Text on = fields.expression("on");
    std::string word = on.text;
    word.erase(0, word.find_first_not_of(' '));
    word.erase(word.find_last_not_of(' ') + 1);
    if (!is_name(word)) {
        jump.on = on;
        return;
    }
    const std::vector<std::string> names = names_of_contacts(system);
    const auto found = std::find(names.begin(), names.end(), word);
    if (found != names.end()) {
        jump.on = on;
        jump.contact = static_cast<std::size_t>(found - names.begin());
        return;
    }
    if (known.places.contains(word))
        throw Mistake{on.at, fmt::format("'{}' in [[jump]] is no contact", word),
                      fmt::format("one word is the name of a contact; an expression that is one name stands in "
                                  "parentheses: on = \"({})\"",
                                  word)};
    if (!known.complete) throw ErrorAlreadyReported{};  // the contact's own table has a mistake
    throw Mistake{on.at, fmt::format("no [[constraint]] is named '{}'{}", word, did_you_mean(word, names)),
                  names.empty() ? "write an expression that falls through zero, as on = \"x - 1\""
                                : fmt::format("the contacts are {}", listed(names))};
}

// One entry of `set`. Throws Mistake.
JumpDescription::Assignment read_assignment(const SystemDescription& system, const Names& known, const Fields& set,
                                            const TomlEntry& entry) {
    const auto& coordinates = system.coordinates;
    std::vector<std::string> names;
    for (const char* prime : {"", "'"})
        for (const CoordinateDescription& coordinate : coordinates) names.push_back(coordinate.name + prime);
    const auto found = std::find(names.begin(), names.end(), entry.key);
    if (found != names.end())
        return {static_cast<std::size_t>(found - names.begin()), set.expression(entry.key, entry.value)};
    const std::string bare = entry.key.substr(0, entry.key.find('\''));
    if (known.reported.contains(bare) || (!known.complete && !known.places.contains(bare)))
        throw ErrorAlreadyReported{};
    if (known.places.contains(entry.key))
        throw Mistake{
            entry.at, fmt::format("'{}' is a parameter: a jump sets coordinates and rates", entry.key),
            "what a jump shall change is a coordinate of its own; its kinetic energy may be that of a unit mass"};
    throw Mistake{entry.at,
                  fmt::format("unknown name {} in set{}", in_quotes(shown(entry.key)), did_you_mean(entry.key, names)),
                  fmt::format("a jump sets {}; the name of a rate stands in quotes, as in \"{}'\" = \"0\"",
                              listed(names), coordinates.empty() ? "x" : coordinates.front().name)};
}

}  // namespace

void read_jumps(std::vector<Fields> tables, SystemDescription& system, const Names& known, ErrorCollector& mistakes) {
    std::map<std::string, Location> places;
    for (Fields& fields : tables) {
        fields.allow(keys_of("[[jump]]"), mistakes);
        JumpDescription& jump = system.jumps.emplace_back();
        jump.at = fields.table().at;
        mistakes.attempt([&] {
            fields.need("name", {fields.table().at, "missing key 'name' in [[jump]]",
                                 "it is the name of its events, as in name = \"legs swap\""});
            const Text name = fields.string("name");
            if (name.text.empty()) throw Mistake{name.at, "the name of a [[jump]] is empty", {}};
            const auto [other, is_new] = places.try_emplace(name.text, name.at);
            if (!is_new) throw used_twice(name, other->second);
            jump.name = name.text;
        });
        mistakes.attempt([&] { read_on(system, known, fields, jump); });
        mistakes.attempt([&] { jump.when = fields.expression_or_none("when"); });
        mistakes.attempt([&] {
            const TomlValue& value = fields.need("set");
            if (value.kind != TomlValue::Kind::table || value.entries.empty())
                throw Mistake{value.at, "'set' in [[jump]] must name the new values",
                              fmt::format("write set = {{{0} = \"-{0}\"}}",
                                          system.coordinates.empty() ? "x" : system.coordinates.front().name)};
            const Fields set(value, "set");
            for (const TomlEntry& entry : value.entries)
                mistakes.attempt([&] { jump.set.push_back(read_assignment(system, known, set, entry)); });
        });
    }
}

}  // namespace achilles
