#include "model/read_system.hpp"

#include <utility>

#include "model/model.hpp"
#include "model/read_expressions.hpp"
#include "number/float_environment.hpp"
#include "system/read_tables.hpp"

namespace achilles {

SystemDescription read_system(const std::filesystem::path& file) {
    return parse_system(read_text(file), file.string());
}

namespace {

// Checks the start of a system whose only mistakes are in drawings and views, so that all mistakes are reported at
// once.
void check_start(SystemDescription system, ErrorCollector& mistakes) {
    system.drawings.clear();
    system.views.clear();
    for (ConstraintDescription& constraint : system.constraints) constraint.drawings.clear();
    try {
        const Model model(std::move(system));
        model.check(model.default_run());
    } catch (const InputError& error) {
        for (const InputError& each : each_of(error))
            mistakes.add({each.at, each.message, each.hint, each.at.line > 0});
    }
}

}  // namespace

SystemDescription parse_system(std::string text, std::string name) {
    const FloatEnvironmentGuard ground;  // constants are evaluated as intervals, too
    ParsedFile read = read_tables(std::move(text), std::move(name));
    const bool has_equations = check_expressions(read.system, std::move(read.names), read.mistakes);
    if (read.mistakes.count() > 0 && read.has_system && has_equations) check_start(read.system, read.mistakes);
    read.mistakes.raise(read.system);
    if (!read.typed_views.empty()) read.system.views = std::move(read.typed_views);
    return std::move(read.system);
}

std::string expand_system(const std::string& text, const std::string& name) {
    parse_system(text, name);
    std::string expanded;
    read_tables(text, name, &expanded);
    return expanded;
}

std::shared_ptr<const Model> derive(SystemDescription description) {
    return std::make_shared<const Model>(std::move(description));
}

}  // namespace achilles
