#include "system/read_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>

#include "expression/parse.hpp"

namespace achilles {

namespace {

// Depth-first search along the definitions.
class DefinitionSorter {
 public:
    DefinitionSorter(std::vector<DerivedDescription>& derived, Names& names, ErrorCollector& mistakes)
        : derived_(derived), names_(names), mistakes_(mistakes), states_(derived.size(), VisitState::unseen) {
        for (std::size_t i = 0; i < derived.size(); ++i) places_.emplace(derived[i].name, i);
        for (std::size_t i = 0; i < derived.size(); ++i) visit(i);
    }

    std::vector<DerivedDescription> ordered;

 private:
    enum class VisitState { unseen, on_the_way, done };

    void visit(std::size_t i) {
        if (states_[i] == VisitState::done) return;
        if (states_[i] == VisitState::on_the_way) return report_circular_definition(i);
        states_[i] = VisitState::on_the_way;
        way_.push_back(i);
        for (const std::string& name : names_in(derived_[i].definition.text))
            if (const auto other = places_.find(name); other != places_.end()) visit(other->second);
        way_.pop_back();
        states_[i] = VisitState::done;
        if (!names_.reported.contains(derived_[i].name)) ordered.push_back(derived_[i]);
    }

    // Reports a circular definition, from the parameter that comes first in the file: "J -> K -> J".
    void report_circular_definition(std::size_t again) {
        std::vector<std::size_t> circle(std::find(way_.begin(), way_.end(), again), way_.end());
        const bool is_reported = std::any_of(circle.begin(), circle.end(),
                                             [&](std::size_t i) { return names_.reported.contains(derived_[i].name); });
        for (const std::size_t i : circle) names_.reported.insert(derived_[i].name);
        if (is_reported) return;
        std::rotate(circle.begin(), std::min_element(circle.begin(), circle.end()), circle.end());
        const DerivedDescription& first = derived_[circle.front()];
        std::string way;
        for (const std::size_t i : circle) way += derived_[i].name + " -> ";
        mistakes_.add(
            {first.definition.at,
             fmt::format("the definition of the parameter '{}' is circular: {}{}", first.name, way, first.name),
             "give one of them a number as its value"});
    }

    std::vector<DerivedDescription>& derived_;
    Names& names_;
    ErrorCollector& mistakes_;
    std::vector<VisitState> states_;
    std::map<std::string, std::size_t> places_;
    std::vector<std::size_t> way_;
};

// Sorts derived parameters so that each follows those in its definition. Adds a mistake for every circular definition
// and removes its parameters.
void order_derived(ParsedFile& reading) {
    std::vector<DerivedDescription>& derived = reading.system.derived;
    derived = std::move(DefinitionSorter(derived, reading.names, reading.mistakes).ordered);
}

using RewriteRule = void (*)(ParsedFile& reading);
constexpr RewriteRule rewritings[] = {order_derived};

}  // namespace

void rewrite(ParsedFile& reading) {
    for (const RewriteRule apply : rewritings) apply(reading);
}

}  // namespace achilles
