#include "check/check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "check/equations_on_page.hpp"
#include "model/derived_values.hpp"
#include "output/contacts.hpp"

namespace achilles {

namespace {

class Report : EquationsOnPage {
 public:
    Report(const Model& model, const Run& run, const Simplified& simplified, Notation notation)
        : EquationsOnPage(model, run, simplified, Page(notation)) {}

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
                            constraints[condition.contact].name, joined_names(model_, condition.held)));
            zeno(condition.zeno);
            zeno_restitution(condition.contact);
        }
        unwritten_conditions();
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
        say("equations as printed above against the derived equations, at the same states:");
        if (disagreement.states > 0) say(fmt::format("  {}", list(disagreement.simplified)));
        say(disagreement.states > 0 ? fmt::format("largest disagreement {:.1e}", disagreement.largest())
                                    : "at none of the random states were all terms defined and M positive definite");
        say(fmt::format("deriving took {:.3g} ms", deriving * 1e3));
    }
};

}  // namespace

std::string check_report(const Model& model, const Run& run, double deriving, Notation notation, double& disagreement) {
    const Simplified simplified(model, run);
    const Disagreement found = compare_with_differences(model, run, simplified);
    disagreement = found.largest();
    return Report(model, run, simplified, notation).write(found, deriving);
}

}  // namespace achilles
