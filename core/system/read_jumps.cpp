// Reads [[jump]], and the latches of contacts: what starts a jump or ends a latch, and what a jump sets.
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

// The value of a key that starts a jump or ends a latch: one word is the name of a contact. `direction`: in which an
// expression passes through zero. Throws Mistake.
Trigger read_trigger(const SystemDescription& system, const Names& known, const Fields& fields, const char* key,
                     const char* direction) {
    const Text on = fields.expression(key);
    std::string word = on.text;
    word.erase(0, word.find_first_not_of(' '));
    word.erase(word.find_last_not_of(' ') + 1);
    if (!is_name(word)) return {on, {}};
    const std::vector<std::string> names = names_of_contacts(system);
    const auto found = std::find(names.begin(), names.end(), word);
    if (found != names.end()) return {on, static_cast<std::size_t>(found - names.begin())};
    if (known.places.contains(word))
        throw Mistake{on.at, fmt::format("'{}' in {} is no contact", word, fields.where()),
                      fmt::format("one word is the name of a contact; an expression that is one name stands in "
                                  "parentheses: {} = \"({})\"",
                                  key, word)};
    if (!known.complete) throw ErrorAlreadyReported{};  // the contact's own table has a mistake
    throw Mistake{on.at, fmt::format("no [[constraint]] is named '{}'{}", word, did_you_mean(word, names)),
                  names.empty()
                      ? fmt::format("write an expression that {} through zero, as {} = \"x - 1\"", direction, key)
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
        mistakes.attempt([&] { jump.on = read_trigger(system, known, fields, "on", "falls"); });
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

void read_latches(const std::vector<Fields>& tables, SystemDescription& system, const Names& known,
                  ErrorCollector& mistakes) {
    for (std::size_t i = 0; i < tables.size(); ++i) {
        const TomlValue* const value = tables[i].find("latch");
        if (value == nullptr) continue;
        mistakes.attempt([&] {
            if (system.constraints[i].has_friction())
                throw Mistake{value->at, fmt::format("'{}' has a latch and friction", system.constraints[i].name),
                              "a latched contact is held against any force, which leaves its friction undetermined: "
                              "leave out one of the two"};
            Trigger latch = read_trigger(system, known, tables[i], "latch", "rises");
            if (latch.contact == i)
                throw Mistake{
                    value->at,
                    fmt::format("the latch of '{0}' ends with an impact of '{0}' itself", system.constraints[i].name),
                    "a held contact has no impact: name another contact, or write an expression that rises "
                    "through zero"};
            system.constraints[i].latch = std::move(latch);
        });
    }
}

}  // namespace achilles
