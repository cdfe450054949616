// A rule as machine code, whatever the width.
#pragma once

#include "program/assembler.hpp"
#include "series/order.hpp"

namespace achilles {

constexpr std::size_t most_rules_in_code = 10000;

// Its three factors stand at (factors, first), one after the other. Register 0 is lost.
// The result need not be stored where its register keeps it as long as it is needed.
void write_rule(Assembler& code, const SeriesRule& rule, const Xbyak::Reg64& factors, std::ptrdiff_t first,
                bool store = true);

}  // namespace achilles
