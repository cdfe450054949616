#include "check/check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "check/equations_on_page.hpp"
#include "check/finite_differences.hpp"
#include "check/simplified.hpp"
#include "model/model.hpp"
#include "output/contacts.hpp"

namespace achilles {

namespace {

TextAndLatex energy_of_prescribed_motion() {
    return {"T = T2 + T1 + T0 by degree in the rates: 'energy' is T2 - T0 + V, and 'work' belongs to that balance",
            "$T = T_2 + T_1 + T_0$ by degree in the rates: the energy is $T_2 - T_0 + V$, and the work belongs to that "
            "balance.\n"};
}

class Report : EquationsOnPage {
 public:
    Report(const Model& model, const Run& run, const SimplifiedEquations& simplified, Notation notation)
        : EquationsOnPage(model, run, simplified, Page(notation)) {}

    std::string write(const MaxDifference& disagreement, double deriving) {
        const SystemDescription& system = model_.description();
        page_.title(system.title, system.source);
        page_.heading("Coordinates");
        coordinates();
        page_.heading("Parameters");
        parameters();
        put_mechanism(page_, model_, run_);
        const bool forces = has_forces(model_.equations());
        const char* const plural = is_one() ? "" : "s";
        page_.heading(fmt::format("Energies{}", forces ? ", forces" : "") +
                      (model_.contacts() == 0 ? "" : fmt::format(", gap{0}, restitution{0}", plural)));
        write_given_quantities();
        page_.heading(fmt::format("Free motion: M q'' + bias = {}", forces ? "Q" : "0"));
        matrix({"M", "M"}, simplified_.M, model_.equations().M, model_.layout().dof);
        matrix({"bias", "b"}, simplified_.bias, model_.equations().bias, 1);
        if (forces) matrix({"Q", "Q"}, simplified_.Q, model_.equations().Q, 1);
        for (std::size_t i = 0; i < model_.contacts(); ++i) {
            contact(i, forces);
            page_.heading(fmt::format("Zeno condition{}: hddot < 0 where h = 0 and hdot = 0", of(" of {}", i)));
            zeno(simplified_.contacts[i].zeno);
            zeno_restitution(i);
        }
        while_held();
        page_.heading("Checks");
        checks(disagreement, deriving);
        return page_.finish();
    }

 private:
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
            rows.push_back({in_line(fmt::format("{} = {}", name(parameter.name), run_.parameters[i])),
                            words(parameter.unit),
                            words(fmt::format("{}in [{}, {}]", parameter.has_range ? "" : "slider ", parameter.range[0],
                                              parameter.range[1])),
                            words(parameter.about)});
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

    void while_held() {
        const auto& constraints = model_.description().constraints;
        for (const HeldCondition& condition : simplified_.while_held) {
            page_.heading(
                fmt::format("Zeno condition of {} while {} is held: hddot < 0 where h = 0 and hdot = 0 for both",
                            constraints[condition.contact].name, joined_names(model_, condition.mode.held())));
            zeno(condition.zeno);
            zeno_restitution(condition.contact);
        }
        unwritten_conditions();
    }

    // The quantities as given in the file.
    void write_given_quantities() {
        const Equations& e = model_.equations();
        const SystemDescription& system = model_.description();
        const auto show = [&](const TextAndLatex& left, Expression expression, const Text& text) {
            page_.formula(
                left, is_text() ? text.text : achilles::write(expression, model_.slot_names(), Notation::latex).text);
        };
        show({"T", "T"}, e.given.kinetic, system.kinetic);
        show({"V", "V"}, e.given.potential, system.potential);
        if (e.has_prescribed_motion()) page_.sentence(energy_of_prescribed_motion());
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
            // The restitution is often a parameter e, and "e = e" would say nothing.
            page_.sentence(
                {fmt::format("restitution{} {}", of(" {}", i), constraint.restitution.text),
                 fmt::format("Restitution{} ${}$.", words(of(" {}", i)),
                             achilles::write(e.restitutions[i], model_.slot_names(), Notation::latex).text)});
        }
    }

    void checks(const MaxDifference& disagreement, double deriving) {
        const auto list = [](const std::vector<MaxDifference::CheckedQuantity>& quantities) {
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
        say("equations as printed above against the derived equations, at the same states:");
        if (disagreement.states > 0) say(fmt::format("  {}", list(disagreement.simplified)));
        say(disagreement.states > 0 ? fmt::format("largest disagreement {:.1e}", disagreement.largest())
                                    : "at none of the random states were all terms defined and M positive definite");
        say(fmt::format("deriving took {:.3g} ms", deriving * 1e3));
    }
};

}  // namespace

namespace {

class CheckReport : EquationsOnPage {
 public:
    CheckReport(const Model& model, const Run& run, const SimplifiedEquations& simplified)
        : EquationsOnPage(model, run, simplified, Page(Notation::text)) {}

    std::string write(const MaxDifference& disagreement) {
        put_mechanism(page_, model_, run_);
        if (!page_.blocks().empty()) page_.heading("Equations");
        for (std::size_t i = 0; i < model_.contacts(); ++i) condition(i, simplified_.contacts[i].zeno);
        if (const std::size_t count = simplified_.while_held.size(); count > 0)
            page_.sentence({counted(count, "more Zeno condition") + " while other contacts are held: --verbose", {}});
        page_.sentence({verified(disagreement), {}});
        if (model_.equations().has_prescribed_motion()) page_.sentence(energy_of_prescribed_motion());
        const bool forces = has_forces(model_.equations());
        page_.heading(fmt::format("M q'' + bias = {}", forces ? "Q" : "0"));
        matrix({"M", "M"}, simplified_.M, model_.equations().M, model_.layout().dof);
        matrix({"bias", "b"}, simplified_.bias, model_.equations().bias, 1);
        if (forces) matrix({"Q", "Q"}, simplified_.Q, model_.equations().Q, 1);
        const bool has_heading_first = page_.blocks().front().kind == Block::Kind::heading;  // with an empty line above
        return first_line(disagreement) + (has_heading_first ? "\n" : "\n\n") + page_.finish() +
               "\nParameters, energies, gap, hdot, hddot, lambda, each check: --verbose. LaTeX: --latex\n";
    }

 private:
    static std::string counted(std::size_t count, const char* noun) {
        return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
    }

    std::string first_line(const MaxDifference& disagreement) const {
        const SystemDescription& system = model_.description();
        if (disagreement.largest() > max_disagreement)
            return fmt::format("{}: FAILED, the derived equations differ from finite differences by {:.1e}",
                               system.title, disagreement.largest());
        return fmt::format("{}: OK    {}, {}, {}", system.title, counted(system.coordinates.size(), "coordinate"),
                           counted(system.parameters.size(), "parameter"), counted(model_.contacts(), "contact"));
    }

    static std::string verified(const MaxDifference& disagreement) {
        if (disagreement.states == 0)
            return "Equations not verified: at none of the random states were all terms defined and M positive "
                   "definite";
        return fmt::format("Equations {}: finite differences at {} random states agree to {:.1e}",
                           disagreement.largest() > max_disagreement ? "wrong" : "verified", disagreement.states,
                           disagreement.largest());
    }

    // "Impacts of knee end in a Zeno point where g*sin(theta1) < 0 (at theta2 = 0, theta2' = 0; restitution 0.5)".
    void condition(std::size_t contact, const std::optional<ZenoCondition>& found) {
        constexpr std::size_t longest = 200;  // longest inequality, in characters, of this short report
        const std::string impacts = "Impacts" + of(" of {}", contact);
        const double e = model_.restitution(run_.parameters, contact);
        const auto say = [&](const std::string& rest) { page_.sentence({impacts + rest, {}}); };
        if (e <= 0.0) return say(" are plastic: the first one ends on the surface (restitution 0)");
        if (e >= 1.0) return say(" never end in a Zeno point: the restitution is 1");
        if (!found) return say(": the Zeno condition could not be simplified");
        if (found->verdict == ZenoCondition::Verdict::never)
            return say(" never end in a Zeno point: hddot >= 0 at every contact");
        if (found->verdict == ZenoCondition::Verdict::always)
            return say(fmt::format(" end in a Zeno point: hddot < 0 at every contact (restitution {})", e));
        std::string notes;
        if (const auto there = on_surface(*found); !there.empty())
            notes = fmt::format("at {}; ", fmt::join(there, ", "));
        notes += fmt::format("restitution {}", e);
        if (const auto value = decisive_here(*found)) notes += *value < 0.0 ? "; true here" : "; false here";
        const std::string decisive = writer_of(*found).write(found->decisive).text + " < 0";
        if (decisive.size() > longest)
            return say(
                fmt::format(" end in a Zeno point where a long inequality holds: --verbose (restitution {})", e));
        const std::string line = fmt::format(" end in a Zeno point where {} ({})", decisive, notes);
        if (impacts.size() + line.size() <= page_.width()) return say(line);
        say(fmt::format(" end in a Zeno point ({}) where", notes));
        page_.formula({}, decisive, 2);
    }
};

}  // namespace

std::string check_answer(const Model& model, const Run& run, double& disagreement) {
    const SimplifiedEquations simplified(model, run);
    const MaxDifference found = compare_with_differences(model, run, simplified);
    disagreement = found.largest();
    return check_answer(model, run, simplified, found);
}

std::string check_answer(const Model& model, const Run& run, const SimplifiedEquations& simplified,
                         const MaxDifference& disagreement) {
    return CheckReport(model, run, simplified).write(disagreement);
}

std::string check_report(const Model& model, const Run& run, double deriving, Notation notation, double& disagreement) {
    const SimplifiedEquations simplified(model, run);
    const MaxDifference found = compare_with_differences(model, run, simplified);
    disagreement = found.largest();
    return check_report(model, run, deriving, notation, simplified, found);
}

std::string check_report(const Model& model, const Run& run, double deriving, Notation notation,
                         const SimplifiedEquations& simplified, const MaxDifference& disagreement) {
    return Report(model, run, simplified, notation).write(disagreement, deriving);
}

namespace {

std::vector<EquationSheet::Symbol> symbols_of(const Model& model) {
    std::vector<EquationSheet::Symbol> symbols;
    for (std::uint32_t slot = 0; slot <= model.layout().t(); ++slot)
        symbols.push_back({write_name(model.slot_names()[slot], Notation::latex).text, model.slot_names()[slot]});
    return symbols;
}

// The Zeno conditions come first.
class SheetWriter : EquationsOnPage {
 public:
    SheetWriter(const Model& model, const Run& run, const SimplifiedEquations& simplified)
        : EquationsOnPage(model, run, simplified, Page(Notation::latex, no_limit)) {}

    EquationSheet write() {
        EquationSheet result;
        const bool forces = has_forces(model_.equations());
        for (std::size_t i = 0; i < model_.contacts(); ++i) condition(result, i, {}, simplified_.contacts[i].zeno);
        for (const HeldCondition& held : simplified_.while_held) condition(result, held.contact, held.mode, held.zeno);
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
        result.symbols = symbols_of(model_);
        return result;
    }

 private:
    static constexpr std::size_t no_limit = 1000000;  // lines are broken by the caller

    void condition(EquationSheet& sheet, std::size_t contact, Mode mode, const std::optional<ZenoCondition>& found) {
        std::string plain = "Zeno condition" + of(" of {}", contact), where = "$h = \\dot{h} = 0$";
        if (!mode.is_free()) {
            plain += fmt::format(" while {} is held", joined_names(model_, mode.held()));
            where += " for both";
        }
        const std::size_t first = page_.blocks().size();
        page_.heading({plain, fmt::format("{}: $\\ddot{{h}} < 0$ where {}", Page::escaped(plain), where)});
        zeno(found);
        if (!found) return;
        const Expression value = expression_of(found->decisive, *found->algebra);
        sheet.conditions.push_back({contact, mode, first, page_.blocks().size(),
                                    Program(std::span(&value, 1), model_.layout().slots()),
                                    found->verdict == ZenoCondition::Verdict::depends});
    }
};

}  // namespace

EquationSheet equation_sheet(const Model& model, const Run& run, std::stop_token stop) {
    const SimplifiedEquations simplified(model, run, std::move(stop));
    return SheetWriter(model, run, simplified).write();
}

EquationSheet mechanism_sheet(const Model& model, const Run& run) {
    Page page(Notation::latex);
    put_mechanism(page, model, run);
    EquationSheet result;
    result.blocks = page.blocks();
    result.symbols = symbols_of(model);
    return result;
}

}  // namespace achilles
