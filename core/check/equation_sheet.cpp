#include "check/equation_sheet.hpp"

#include <fmt/format.h>

#include "check/equations_on_page.hpp"
#include "check/finite_differences.hpp"
#include "check/zeno_condition.hpp"
#include "output/contacts.hpp"

namespace achilles {

namespace {

// What the run may end in stands first.
class SheetWriter : EquationsOnPage {
 public:
    SheetWriter(const Model& model, const Run& run, const Simplified& simplified)
        : EquationsOnPage(model, run, simplified, Page(Notation::latex, no_limit)) {}

    EquationSheet write() {
        EquationSheet result;
        const bool forces = has_forces(model_.equations());
        for (std::size_t i = 0; i < model_.contacts(); ++i) condition(result, i, {}, simplified_.contacts[i].zeno);
        for (const HeldCondition& held : simplified_.while_held) condition(result, held.contact, held.held, held.zeno);
        unwritten_conditions();
        page_.heading({"Motion", fmt::format("Motion: $M \\ddot{{q}} + b = {}$", forces ? "Q" : "0")});
        page_.caption("mass matrix");
        matrix({"M", "M"}, simplified_.M, model_.equations().M, model_.layout().dof);
        page_.caption("bias: inertia of the rates, and the potential's forces");
        matrix({"bias", "b"}, simplified_.bias, model_.equations().bias, 1);
        if (forces) page_.caption("forces");
        if (forces) matrix({"Q", "Q"}, simplified_.Q, model_.equations().Q, 1);
        for (std::size_t i = 0; i < model_.contacts(); ++i) contact(i, forces, true);
        result.blocks = page_.blocks();
        const Layout& layout = model_.layout();
        for (std::uint32_t slot = 0; slot <= layout.t(); ++slot)
            result.symbols.push_back({name(model_.slot_names()[slot]), model_.slot_names()[slot]});
        return result;
    }

 private:
    static constexpr std::size_t no_limit = 1000000;  // who sets them breaks lines himself

    void condition(EquationSheet& sheet, std::size_t contact, ContactSet held,
                   const std::optional<ZenoCondition>& found) {
        std::string plain = "Zeno condition" + of(" of {}", contact), where = "$h = \\dot{h} = 0$";
        if (!held.empty()) {
            plain += fmt::format(" while {} is held", joined_names(model_, held));
            where += " for both";
        }
        const std::size_t first = page_.blocks().size();
        page_.heading({plain, fmt::format("{}: $\\ddot{{h}} < 0$ where {}", Page::escaped(plain), where)});
        zeno(found);
        if (!found) return;
        const Expression value = expression_of(found->decisive, *found->algebra);
        sheet.conditions.push_back({contact, held, first, page_.blocks().size(),
                                    Program(std::span(&value, 1), model_.layout().slots()),
                                    found->verdict == ZenoCondition::Verdict::depends});
    }
};

}  // namespace

EquationSheet equation_sheet(const Model& model, const Run& run, std::stop_token stop) {
    const Simplified simplified(model, run, std::move(stop));
    return SheetWriter(model, run, simplified).write();
}

}  // namespace achilles
