#include "check/equations_on_page.hpp"

#include <fmt/args.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "expression/notation.hpp"
#include "expression/parse.hpp"
#include "model/scopes.hpp"
#include "system/units.hpp"

namespace achilles {

namespace {

class MechanismPage {
 public:
    MechanismPage(Page& page, const Model& model, const Run& run)
        : page_(page),
          system_(model.description()),
          layout_(model.layout()),
          laws_(model.equations().friction),
          names_(model.slot_names()),
          scope_(force_scope(system_, layout_, graph_)) {
        scope_.allowed.insert_or_assign("slip", graph_.symbol(layout_.sliding_speed()));
        for (const Vector* part : {&run.q, &run.v}) start_.insert(start_.end(), part->begin(), part->end());
        start_.insert(start_.end(), run.parameters.begin(), run.parameters.end());
        start_.push_back(run.options.start_time);
        start_.resize(layout_.count());
    }

    void put() {
        const MechanismSummary& mechanism = system_.mechanism;
        put_lines("Bodies", mechanism.bodies);
        put_lines("Springs and dampers", mechanism.springs);
        if (mechanism.has_signed_length) say("A signed length goes on below 0 where the ends pass each other.");
        put_contacts();
        if (mechanism.is_prescribed)
            say("Time moves a mass: M, impacts and lambda are those at frozen t, and 'energy' is T2 - T0 + V, where T2 "
                "is quadratic in the rates and T0 is the kinetic energy at rates zero; 'work' belongs to that "
                "balance.");
        put_frictions();
        put_conditions();
        put_latches();
        put_jumps();
    }

 private:
    bool is_text() const { return page_.notation() == Notation::text; }

    // Words in which backquotes enclose expressions.
    std::string words(const std::string& plain) {
        std::string result;
        for (std::size_t at = 0; at < plain.size();) {
            const bool is_formula = plain[at] == '`';
            const std::size_t begin = at + (is_formula ? 1 : 0), end = std::min(plain.find('`', begin), plain.size());
            const std::string part = plain.substr(begin, end - begin);
            result += is_formula ? formula("", part) : is_text() ? part : Page::escaped(part);
            at = end + (is_formula ? 1 : 0);
        }
        return result;
    }
    // "h = ": what stands on the left, if anything.
    std::string formula(const std::string& left, const std::string& expression) {
        if (is_text()) return left + expression;
        return fmt::format("${}{}$", left, write(parse(expression, scope_, graph_), names_, Notation::latex).text);
    }
    void say(const std::string& sentence) { page_.sentence({sentence, Page::escaped(sentence)}); }

    // "0.1029 kg m^2": the value at the start, with its unit if that is known.
    std::string value(const std::string& expression, std::string unit) {
        const double number = value_of(parse(expression, scope_, graph_), start_);
        if (unit.empty())
            unit = is_name(expression) ? unit_of(system_, expression) : unit_of_expression(system_, expression);
        return with_unit(number, unit);
    }
    static std::string with_unit(double number, std::string unit) {
        std::replace(unit.begin(), unit.end(), '*', ' ');
        return fmt::format("{:.4g}{}{}", number, unit.empty() ? "" : " ", unit);
    }

    void put_lines(const char* heading, const std::vector<SummaryLine>& lines) {
        if (lines.empty()) return;
        page_.heading(heading);
        std::vector<std::vector<std::string>> rows;
        for (const SummaryLine& line : lines) {
            fmt::dynamic_format_arg_store<fmt::format_context> values;
            for (std::size_t i = 0; i < line.values.size(); ++i)
                values.push_back(value(line.values[i], i < line.units.size() ? line.units[i] : ""));
            rows.push_back({words(line.name), words(fmt::vformat(line.pattern, values))});
        }
        page_.lines(rows);
    }

    void put_contacts() {
        std::vector<std::vector<std::string>> rows;
        for (std::size_t i = 0; i < system_.mechanism.contacts.size(); ++i) {
            const SummaryContact& contact = system_.mechanism.contacts[i];
            if (contact.name.empty()) continue;
            rows.push_back(
                {words(system_.constraints[i].name),
                 fmt::format("{}: {}, {}", words(contact.name), formula("h = ", contact.gap), words(contact.force))});
            if (!contact.slip.empty()) rows.push_back({"", words("slip = ") + formula("", contact.slip)});
        }
        if (rows.empty()) return;
        page_.heading("Contacts");
        page_.lines(rows);
    }

    // "mu = 0.3", "0.2 + 0.1*exp(-slip) = 0.25 at the start", "12 N": a level as written, with its value if it has
    // names.
    std::string level(const Text& text, Expression level, const std::string& unit) const {
        const std::string number = with_unit(value_of(level, start_), unit);
        if (!has_names(text.text)) return number;
        std::vector<std::uint32_t> varying{layout_.t(), layout_.sliding_speed()};
        for (std::uint32_t slot = 0; slot < 2 * layout_.dof; ++slot) varying.push_back(slot);
        return fmt::format("`{}` = {}{}", text.text, number, depends_on(level, varying) ? " at the start" : "");
    }

    void put_frictions() {
        std::vector<std::vector<std::string>> rows;
        const std::vector<SlidingPlace> places = sliding_places(system_);
        const std::vector<std::string> forces = sliding_names(system_, "friction_force");
        for (std::size_t i = 0; i < places.size(); ++i) {
            const FrictionLaw& law = laws_.at(places[i].number);
            const std::string unit = !is_joint(places[i].number) ? "" : unit_of_expression(system_, forces[i]);
            start_[layout_.sliding_speed()] = std::abs(value_of(law.slip, start_));
            std::string line = fmt::format("slip = `{}`, ", places[i].slip->text);
            if (law.never_slides)
                line += "never slides";
            else
                line +=
                    (is_joint(places[i].number) ? "level " : "coefficient ") + level(*places[i].level, law.level, unit);
            if (places[i].static_level != nullptr)
                line += ", static " + level(*places[i].static_level, law.static_level, unit);
            rows.push_back({words(places[i].name), words(line)});
        }
        if (rows.empty()) return;
        page_.heading("Friction");
        page_.lines(rows);
        if (std::any_of(places.begin(), places.end(),
                        [](const SlidingPlace& place) { return !is_joint(place.number); }))
            say("A contact slides with coefficient*lambda against its slip, and sticks up to static*lambda.");
    }

    void put_conditions() {
        std::vector<std::vector<std::string>> rows;
        for (const ConstraintDescription& constraint : system_.constraints)
            if (!constraint.when.text.empty())
                rows.push_back({words(constraint.name), words(fmt::format("where `{}` > 0", constraint.when.text))});
        if (rows.empty()) return;
        page_.heading("Contacts that count only sometimes");
        page_.lines(rows);
    }

    // "knee: until an impact of foot"
    void put_latches() {
        std::vector<std::vector<std::string>> rows;
        for (const ConstraintDescription& constraint : system_.constraints) {
            const Trigger& latch = constraint.latch;
            if (latch.on.text.empty()) continue;
            rows.push_back({words(constraint.name),
                            words(latch.contact ? fmt::format("held until an impact of {}",
                                                              system_.constraints[*latch.contact].name)
                                                : fmt::format("held until `{}` rises through 0", latch.on.text))});
        }
        if (rows.empty()) return;
        page_.heading("Latches");
        page_.lines(rows);
    }

    // "after impacts of foot, where x > 0: x = -x, x' = x'/2"
    void put_jumps() {
        std::vector<std::vector<std::string>> rows;
        for (const JumpDescription& jump : system_.jumps) {
            std::string line = jump.on.contact
                                   ? fmt::format("after impacts of {}", system_.constraints[*jump.on.contact].name)
                                   : fmt::format("where `{}` falls through 0", jump.on.on.text);
            if (!jump.when.text.empty()) line += fmt::format(" and `{}` > 0", jump.when.text);
            for (std::size_t i = 0; i < jump.set.size(); ++i)
                line += fmt::format("{} `{}` := `{}`", i == 0 ? ":" : ",", names_[jump.set[i].place],
                                    jump.set[i].value.text);
            rows.push_back({words(jump.name), words(line)});
        }
        if (rows.empty()) return;
        page_.heading("Jumps");
        page_.lines(rows);
    }

    Page& page_;
    const SystemDescription& system_;
    const Layout& layout_;
    const FrictionLaws& laws_;
    const std::span<const std::string> names_;
    Graph graph_;
    Scope scope_;
    std::vector<double> start_;  // by slot
};

}  // namespace

void put_mechanism(Page& page, const Model& model, const Run& run) { MechanismPage(page, model, run).put(); }

}  // namespace achilles
