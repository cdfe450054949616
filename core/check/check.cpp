#include "check/check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "algebra/writer.hpp"
#include "check/equation_sheet.hpp"
#include "check/flat_gap.hpp"
#include "check/simplified.hpp"
#include "model/derived_values.hpp"
#include "model/flat.hpp"
#include "output/contacts.hpp"
#include "output/page.hpp"
#include "output/wrap.hpp"

namespace achilles {

namespace {

// A formula of more terms than this is no longer read.
constexpr std::size_t most_terms = 150;

std::size_t terms(const Fraction& f) { return f.numerator.terms().size() + f.denominator.terms().size(); }

class Report {
 public:
    Report(const Model& model, const Run& run, const Simplified& simplified, Page page)
        : model_(model),
          run_(run),
          simplified_(simplified),
          page_(std::move(page)),
          writer_(simplified.algebra(), model.slot_names(), simplified.ranks(), page_.notation()) {}

    std::string write(const Disagreement& disagreement, double deriving) {
        const SystemDescription& system = model_.description();
        page_.title(system.title, system.source);
        page_.heading("Coordinates");
        coordinates();
        page_.heading("Parameters");
        parameters();
        const bool forces = has_forces(model_.equations());
        page_.heading(fmt::format("Energies, {}{}, restitution{}", forces ? "forces, " : "", is_one() ? "gap" : "gaps",
                                  is_one() ? "" : "s"));
        given();
        page_.heading(fmt::format("Free motion: M q'' + bias = {}", forces ? "Q" : "0"));
        matrix({"M", "M"}, simplified_.M, model_.layout().dof);
        matrix({"bias", "b"}, simplified_.bias, 1);
        if (forces) matrix({"Q", "Q"}, simplified_.Q, 1);
        for (std::size_t i = 0; i < model_.contacts(); ++i) {
            contact(i, forces);
            page_.heading(fmt::format("Zeno condition{}: hddot < 0 where h = 0 and hdot = 0", of(" of {}", i)));
            zeno(simplified_.contacts[i].zeno);
        }
        while_held();
        page_.heading("Checks");
        checks(disagreement, deriving);
        return page_.finish();
    }

    // The equations alone, in LaTeX, each formula in one piece.
    EquationSheet sheet() {
        EquationSheet result;
        const bool forces = has_forces(model_.equations());
        page_.heading({"Motion", fmt::format("Motion: $M \\ddot{{q}} + b = {}$", forces ? "Q" : "0")});
        page_.caption("mass matrix");
        matrix({"M", "M"}, simplified_.M, model_.layout().dof);
        page_.caption("bias: inertia of the rates, and the potential's forces");
        matrix({"bias", "b"}, simplified_.bias, 1);
        if (forces) page_.caption("forces");
        if (forces) matrix({"Q", "Q"}, simplified_.Q, 1);
        for (std::size_t i = 0; i < model_.contacts(); ++i) {
            contact(i, forces, true);
            condition(result, i, {}, simplified_.contacts[i].zeno);
        }
        for (const HeldCondition& held : simplified_.while_held) condition(result, held.contact, held.held, held.zeno);
        unwritten_conditions();
        result.blocks = page_.blocks();
        const Layout& layout = model_.layout();
        for (std::uint32_t slot = 0; slot <= layout.t(); ++slot)
            result.symbols.push_back({name(model_.slot_names()[slot]), model_.slot_names()[slot]});
        return result;
    }

 private:
    bool is_text() const { return page_.notation() == Notation::text; }
    std::string name(const std::string& symbol) const { return write_name(symbol, page_.notation()).text; }
    std::string in_line(const std::string& formula) const { return is_text() ? formula : fmt::format("${}$", formula); }
    std::string words(const std::string& plain) const { return is_text() ? plain : Page::escaped(plain); }

    void coordinates() {
        std::vector<std::vector<std::string>> rows;
        for (int i = 0; i < model_.dof(); ++i) {
            const auto& coordinate = model_.description().coordinates[static_cast<std::size_t>(i)];
            const auto start = [&](const std::string& symbol, double value) {
                return in_line(fmt::format("{}(0) = {}", symbol, value));
            };
            rows.push_back({in_line(name(coordinate.name)), start(name(coordinate.name), run_.q[i]),
                            start(name(coordinate.name + "'"), run_.v[i]), words(coordinate.unit)});
        }
        page_.lines(rows);
    }

    void parameters() {
        std::vector<std::vector<std::string>> rows;
        for (std::size_t i = 0; i < run_.parameters.size(); ++i) {
            const auto& parameter = model_.description().parameters[i];
            rows.push_back(
                {in_line(fmt::format("{} = {}", name(parameter.name), run_.parameters[i])), words(parameter.unit),
                 words(fmt::format("in [{}, {}]", parameter.range[0], parameter.range[1])), words(parameter.about)});
        }
        const std::vector<double> derived = derived_values(model_, run_.parameters);
        for (std::size_t i = 0; i < derived.size(); ++i) {
            const auto& parameter = model_.description().derived[i];
            rows.push_back({in_line(fmt::format("{} = {}", name(parameter.name), derived[i])), words(parameter.unit),
                            words(parameter.definition.text), words(parameter.about)});
        }
        if (rows.empty()) rows.push_back({"none"});
        page_.lines(rows);
    }

    bool is_one() const { return model_.contacts() == 1; }
    // With the name of a contact, where there are several.
    std::string of(const char* words, std::size_t contact) const {
        if (is_one()) return "";
        return fmt::format(fmt::runtime(words), model_.description().constraints[contact].name);
    }

    // With `named` everything is said in words, too, and the gap stands there.
    void contact(std::size_t index, bool forces, bool named = false) {
        const SimplifiedContact& c = simplified_.contacts[index];
        const auto caption = [&](const char* words) {
            if (named) page_.caption(words);
        };
        const bool moves = !model_.equations().free.contacts[index].gap_t.is_zero();
        page_.heading("Contact" + of(" {}", index));
        caption("gap");
        if (named)
            page_.formula({"h", "h"},
                          achilles::write(model_.equations().gaps[index], model_.slot_names(), page_.notation()).text);
        caption("gradient of the gap");
        matrix({"dh", "\\mathrm{d}h"}, c.dh, model_.layout().dof);
        flat(index);
        caption("rate of the gap");
        formula({"hdot", "\\dot{h}"}, c.hdot,
                {moves ? "dh q' + h_t" : "dh q'", moves ? "\\mathrm{d}h\\,\\dot{q} + h_t" : "\\mathrm{d}h\\,\\dot{q}"});
        caption("acceleration of the gap in free motion");
        formula({"hddot", "\\ddot{h}"}, c.hddot,
                {fmt::format("q'^T Hess(h) q'{} {}", moves ? " + 2 dh_t q' + h_tt" : "",
                             forces ? "+ dh M^-1 (Q - bias)" : "- dh M^-1 bias"),
                 fmt::format("\\dot{{q}}^{{\\top}}\\,\\mathrm{{Hess}}(h)\\,\\dot{{q}}{} {}",
                             moves ? " + 2\\,\\mathrm{d}h_t\\,\\dot{q} + h_{tt}" : "",
                             forces ? "+ \\mathrm{d}h\\,M^{-1} (Q - b)" : "- \\mathrm{d}h\\,M^{-1} b")});
        caption("contact force while it is held");
        formula({"lambda", "\\lambda"}, c.lambda,
                {"-hddot/(dh M^-1 dh^T)", "-\\ddot{h} / (\\mathrm{d}h\\,M^{-1}\\,\\mathrm{d}h^{\\top})"});
    }

    // A gap that no run can land on.
    void flat(std::size_t index) {
        const std::optional<State> place = flat_place(model_, run_, index);
        if (!place) return;
        std::string at;
        for (int i = 0; i < model_.dof(); ++i)
            at += fmt::format("{}{} = {:.2g}", at.empty() ? "" : ", ", model_.slot_names()[static_cast<std::size_t>(i)],
                              place->q[i]);
        const std::string told = fmt::format("dh = 0 where h = 0, near {}: no impact can be computed there", at);
        for (const std::string& sentence : {told, std::string(flat_hint)})
            page_.sentence({sentence, Page::escaped(sentence)});
    }

    void while_held() {
        const auto& constraints = model_.description().constraints;
        for (const HeldCondition& condition : simplified_.while_held) {
            page_.heading(
                fmt::format("Zeno condition of {} while {} is held: hddot < 0 where h = 0 and hdot = 0 of both",
                            constraints[condition.contact].name, joined_names(model_, condition.held)));
            zeno(condition.zeno);
        }
        unwritten_conditions();
    }

    void unwritten_conditions() {
        if (is_one() || (!simplified_.while_held.empty() && model_.contacts() == 2)) return;
        const std::string left_out =
            fmt::format("The conditions while {} others are held are not written out; runs derive what they need.",
                        simplified_.while_held.empty() ? "any" : "two or more");
        page_.sentence({left_out, left_out});
    }

    // As the file has them.
    void given() {
        const Equations& e = model_.equations();
        const SystemDescription& system = model_.description();
        const auto show = [&](const Both& left, Expression expression, const Text& text) {
            page_.formula(
                left, is_text() ? text.text : achilles::write(expression, model_.slot_names(), Notation::latex).text);
        };
        show({"T", "T"}, e.kinetic, system.kinetic);
        show({"V", "V"}, e.potential, system.potential);
        Graph graph(e.energy.graph());
        const std::vector<Expression> forces = given_forces(model_, graph);
        if (!system.dissipation.text.empty()) show({"R", "R"}, forces.back(), system.dissipation);
        for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
            const CoordinateDescription& coordinate = system.coordinates[i];
            if (!coordinate.force.text.empty())
                show({"force on " + coordinate.name, fmt::format("F_{{{}}}", name(coordinate.name))}, forces[i],
                     coordinate.force);
        }
        for (std::size_t i = 0; i < system.constraints.size(); ++i) {
            const ConstraintDescription& constraint = system.constraints[i];
            show({"h" + of(" {}", i), is_one() ? "h" : fmt::format("h_{{{}}}", name(constraint.name))}, e.gaps[i],
                 constraint.gap);
            // The restitution is often a parameter e, and "e = e" says nothing.
            page_.sentence(
                {fmt::format("restitution{} {}", of(" {}", i), constraint.restitution.text),
                 fmt::format("Restitution{} ${}$.", words(of(" {}", i)),
                             achilles::write(e.restitutions[i], model_.slot_names(), Notation::latex).text)});
        }
    }

    std::string written(const Fraction& fraction) const { return writer_.write(fraction, simplified_.algebra()).text; }

    // In one piece if the page is wide enough, else entry by entry.
    void matrix(const Both& left, const std::vector<std::optional<Fraction>>& entries, std::size_t columns) {
        std::vector<std::vector<std::string>> rows;
        std::vector<std::size_t> widths(columns, 0);
        bool complete = true;
        for (std::size_t i = 0; i < entries.size(); ++i) {
            if (i % columns == 0) rows.emplace_back();
            complete = complete && entries[i] && terms(*entries[i]) <= most_terms;
            rows.back().push_back(complete ? written(*entries[i]) : std::string());
            widths[i % columns] =
                std::max(widths[i % columns], visible_length(rows.back().back(), page_.notation()) + 3);
        }
        std::size_t width = left.text.size() + 6;
        for (const std::size_t column : widths) width += column;
        if (complete && width <= page_.width()) return page_.matrix(left, rows);
        const bool vector = rows.size() == 1 || columns == 1;
        for (std::size_t i = 0; i < entries.size(); ++i) {
            const std::size_t row = i / columns, column = i % columns;
            if (!vector && column < row) continue;  // M is symmetric
            const std::string number = vector ? fmt::format("{}", i + 1) : fmt::format("{}{}", row + 1, column + 1);
            formula({left.text + number, fmt::format("{{{}}}_{{{}}}", left.latex, number)}, entries[i], {});
        }
    }

    // The left hand side and what was found; where nothing was, what it would be simplified from.
    void formula(const Both& left, const std::optional<Fraction>& fraction, const Both& definition) {
        if (fraction && terms(*fraction) <= most_terms) return long_formula(page_, left, factor_or_sum(*fraction));
        page_.formula(left, is_text() ? definition.text : definition.latex);
        const std::string why = fraction ? fmt::format("not written out: it has {} terms", terms(*fraction))
                                         : "not simplified: it takes too many operations";
        page_.sentence({"  (" + why + ")", "\\quad (" + why + ")"});
    }

    struct Quotient {
        std::string whole, top, bottom;
    };

    Quotient factor_or_sum(const Fraction& fraction) const {
        Algebra& algebra = simplified_.algebra();
        algebra.work() = Work{1000000};
        Quotient result{written(fraction), {}, {}};
        if (fraction.denominator.is_number()) return result;
        return split(factor(fraction, algebra), result.whole, writer_);
    }

    static Quotient split(const Factored& factored, const std::string& whole, const Writer& writer) {
        Factored top{numerator(factored.number), {}}, bottom{denominator(factored.number), {}};
        for (const auto& [base, exponent] : factored.factors)
            (exponent > 0 ? top : bottom).factors.push_back({base, std::abs(exponent)});
        return {whole, writer.write(top).text, writer.write(bottom).text};
    }

    // A quotient too wide for a line is written as N/D with N and D below.
    static void long_formula(Page& page, const Both& left, const Quotient& quotient) {
        const std::size_t length = visible_length(quotient.whole, page.notation()) + left.text.size() + 5;
        const bool tall = page.notation() == Notation::latex && !quotient.top.empty();
        const std::size_t across = tall ? std::max(visible_length(quotient.top, page.notation()),
                                                   visible_length(quotient.bottom, page.notation())) +
                                              8
                                        : length;
        if (quotient.top.empty() || across <= page.width()) return page.formula(left, quotient.whole);
        page.formula(left, page.notation() == Notation::text ? "N/D, where" : "N/D, \\quad\\text{where}");
        page.formula({"N", "N"}, quotient.top, 2);
        page.formula({"D", "D"}, quotient.bottom, 2);
    }

    void zeno(const std::optional<ZenoCondition>& found) {
        if (!found) {
            page_.sentence(
                {"(not simplified: it takes too many operations)", "(not simplified: it takes too many operations)"});
            return;
        }
        const ZenoCondition& zeno = *found;
        const auto plain = [&](Expression e) { return achilles::write(e, model_.slot_names(), page_.notation()).text; };
        std::vector<Fraction> values;
        for (const auto& [symbol, value] : zeno.solved) {
            zeno.algebra->work() = Work{1000000};
            values.push_back(zeno.algebra->simplify(value));
        }
        // It knows what the algebra has met so far.
        const Writer writer(*zeno.algebra, model_.slot_names(), simplified_.ranks(), page_.notation());
        std::vector<std::string> there;
        for (std::size_t i = 0; i < values.size(); ++i)
            there.push_back(in_line(
                fmt::format("{} = {}", plain(zeno.solved[i].first), writer.write(values[i], *zeno.algebra).text)));
        if (!there.empty()) {
            const std::string line = fmt::format("there {}", fmt::join(there, ", "));
            page_.sentence({line, line});
        }
        const Factored whole = zeno.positive * zeno.decisive;
        const std::string hddot = writer.write(whole).text;
        const bool divided = !zeno.positive.factors.empty() || zeno.positive.number != 1;
        if (zeno.verdict == ZenoCondition::Verdict::depends) {
            if (divided) {
                long_formula(page_, {"hddot", "\\ddot{h}"}, split(whole, hddot, writer));
                reason(zeno, writer);
            }
            page_.formula({}, fmt::format("{} < 0", writer.write(zeno.decisive).text));
            return;
        }
        long_formula(page_, {"hddot", "\\ddot{h}"}, split(whole, hddot, writer));
        const std::string verdict = zeno.verdict == ZenoCondition::Verdict::always
                                        ? "hddot < 0 at every contact"
                                        : "hddot >= 0 at every contact: none of them ends in a Zeno point";
        const std::string because = grounds(zeno);
        page_.sentence({verdict + because, Page::escaped(verdict) + because});
    }

    // What the proof of a sign rests on.
    std::string grounds(const ZenoCondition& zeno) const {
        std::vector<std::string> names, reasons;
        for (const Expression e : zeno.assumed)
            names.push_back(in_line(achilles::write(e, model_.slot_names(), page_.notation()).text));
        if (!names.empty())
            reasons.push_back(fmt::format("by the range{} of {}", names.size() > 1 ? "s" : "", fmt::join(names, ", ")));
        if (zeno.definite) reasons.emplace_back("where M is positive definite");
        return reasons.empty() ? "" : fmt::format(", {}", fmt::join(reasons, " and "));
    }

    void reason(const ZenoCondition& zeno, const Writer& writer) {
        const std::string divisor = in_line(writer.write(zeno.positive).text);
        const std::string because = grounds(zeno);
        if (is_text() && divisor.size() > 60)
            return page_.sentence({fmt::format("divided by the factors that are positive{}:", because), {}});
        const std::string line = fmt::format("divided by {}, which is positive{}:", divisor, because);
        page_.sentence({line, line});
    }

    // The same for a sheet.
    void condition(EquationSheet& sheet, std::size_t contact, ContactSet held,
                   const std::optional<ZenoCondition>& found) {
        const std::string who = of("of {} ", contact);
        const std::string while_held = held.empty() ? "" : fmt::format("while {} is held", joined_names(model_, held));
        const std::string where = held.empty() ? "$h = \\dot{h} = 0$" : "$h = \\dot{h} = 0$ of both";
        const std::string plain = fmt::format("Zeno condition {}{}", who, while_held);
        const std::size_t first = page_.blocks().size();
        page_.heading({plain, fmt::format("Zeno condition {}{}: $\\ddot{{h}} < 0$ where {}", Page::escaped(who),
                                          Page::escaped(while_held), where)});
        zeno(found);
        if (!found) return;
        Algebra& algebra = *found->algebra;
        Expression value = algebra.graph().number(1);
        for (const auto& [base, exponent] : found->decisive.factors)
            value = value * power_of(algebra.expression(base), exponent);
        if (found->decisive.number < 0) value = -value;
        if (found->decisive.number == 0) value = algebra.graph().number(0);
        sheet.conditions.push_back({contact, held, first, page_.blocks().size(),
                                    Program(std::span(&value, 1), model_.layout().slots()),
                                    found->verdict == ZenoCondition::Verdict::depends});
    }

    static Expression power_of(Expression base, int exponent) { return exponent == 1 ? base : power(base, exponent); }

    void checks(const Disagreement& disagreement, double deriving) {
        const auto list = [](const std::vector<Disagreement::Quantity>& quantities) {
            std::vector<std::string> parts;
            for (const auto& [quantity, largest] : quantities)
                parts.push_back(fmt::format("{} {:.1e}", quantity, largest));
            return fmt::format("{}", fmt::join(parts, ", "));
        };
        const auto say = [&](const std::string& sentence) {
            page_.sentence({sentence, Page::escaped(sentence) + "\n"});
        };
        say(fmt::format(
            "derived equations against central differences of L{} and h, at {} random states, in 50 digits:",
            has_forces(model_.equations()) ? ", the forces" : "", disagreement.states));
        if (disagreement.states > 0) say(fmt::format("  {}", list(disagreement.derived)));
        say("what is written above against the derived equations, at the same states:");
        if (disagreement.states > 0) say(fmt::format("  {}", list(disagreement.simplified)));
        say(disagreement.states > 0 ? fmt::format("largest disagreement {:.1e}", disagreement.largest())
                                    : "none of the states tried had everything defined and M positive definite");
        say(fmt::format("deriving took {:.3g} ms", deriving * 1e3));
    }

    const Model& model_;
    const Run& run_;
    const Simplified& simplified_;
    Page page_;
    Writer writer_;
};

}  // namespace

std::string check_report(const Model& model, const Run& run, double deriving, Notation notation, double& disagreement) {
    const Simplified simplified(model, run);
    const Disagreement found = compare_with_differences(model, run, simplified);
    disagreement = found.largest();
    return Report(model, run, simplified, Page(notation)).write(found, deriving);
}

EquationSheet equation_sheet(const Model& model, const Run& run) {
    constexpr std::size_t no_limit = 1000000;  // who sets them breaks lines himself
    const Simplified simplified(model, run);
    return Report(model, run, simplified, Page(Notation::latex, no_limit)).sheet();
}

}  // namespace achilles
