// Reads the expressions of a system file: T, V, Q, h, e and M of the equations (theory.md 1).
#pragma once

#include <fmt/format.h>

#include <span>
#include <string>

#include "expression/expression.hpp"
#include "expression/parse.hpp"
#include "model/derive.hpp"
#include "system/description.hpp"
#include "system/input_error.hpp"
#include "system/read_tables.hpp"

namespace achilles {

// In place of the shift of a coordinate over a period: whatever the motion makes of it.
inline constexpr std::string_view free_shift = "free";

// Sets the given terms, kinetic, potential, Q, gaps, restitutions, frictions and M of the equations, in whose graph it
// works. Adds the mistakes in these expressions and in the definitions of parameters, including those in T (kinetic_energy.hpp).
// Missing texts are skipped. An unknown name is reported once per file, at its first place;
// expressions that depend on it are not checked.
void read_equations(const SystemDescription& system, const Layout& layout, Graph& graph, Names& names,
                    Equations& equations, ErrorCollector& mistakes);

// Adds the mistakes in all expressions of the file: those above, drawings and views. Returns whether those above have
// none. Drops friction that is the number 0 from the description.
bool check_expressions(SystemDescription& system, Names names, ErrorCollector& mistakes);

// The message about equations that are too large to derive. Names the largest of the expressions given in the file,
// which is what a user can shorten, and its place. `what` is too large, such as "the equations of motion".
Mistake too_large(const SystemDescription& system, const Equations& equations, const std::string& what,
                  const ExpressionTooLarge& problem);

// Reads an expression typed as the value of a command-line option: calls `compile` on the text. An InputError in the
// text is rethrown with the option's name and the text in its message.
template <class Compile>
auto compile_option(const char* flag, const std::string& text, const Compile& compile) {
    const Text given{text, {}};
    try {
        return compile(std::span(&given, 1));
    } catch (const InputError& error) {
        throw InputError(fmt::format("{} {}", flag, shown(text)), error.at, error.message, error.hint, text);
    }
}

}  // namespace achilles
