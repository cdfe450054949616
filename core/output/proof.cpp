// Output of a proof as JSON and as text. The default output of `prove` has the answer first, then a table of changes,
// then the hypotheses.
#include "output/proof.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "model/model.hpp"
#include "output/json_parts.hpp"
#include "output/output.hpp"
#include "output/page.hpp"
#include "output/precision.hpp"

namespace achilles {

namespace {

using Json = nlohmann::ordered_json;

// The endpoints in the shortest form that is read back as the same double.
Json interval(const Interval& x) { return {number_json(x.lo()), number_json(x.hi())}; }

Json box(const Intervals& all) {
    Json result = Json::array();
    for (const Interval& x : all) result.push_back(interval(x));
    return result;
}

Json state(const EnclosedState& there) {
    return {{"t", number_json(there.t)}, {"q", box(there.q)}, {"v", box(there.v)}};
}

std::string list(const std::vector<std::string>& names, const Intervals& all, std::string (*text)(const Interval&)) {
    std::string result;
    for (std::size_t i = 0; i < names.size(); ++i)
        result += fmt::format("{}{} {}", i > 0 ? ", " : "", names[i], text(all[i]));
    return result;
}

bool is_plastic_impact(const EnclosedEvent& event) { return event.is_zeno() && event.most_impacts == 0; }
const EventNames& names_of(const EnclosedEvent& event) {
    return is_plastic_impact(event) ? landing_names : names_of(event.kind);
}

// True if a time, as typed, is not exactly a double.
bool is_rounded(double time) { return width(interval_of_decimal(time)) > 0.0; }

// A proof as text: hypotheses, time reached, conclusions.
class ProofText {
 public:
    ProofText(const Model& model, const EnclosureProblem& claim, const Enclosure& proof)
        : description_(model.description()), claim_(claim), proof_(proof) {
        for (const auto& coordinate : description_.coordinates) {
            names_.push_back(coordinate.name);
            rates_.push_back(coordinate.name + "'");
        }
    }

    std::string text() const {
        const bool is_whole = proof_.end.has_value();
        std::string text = fmt::format("{}\n\n{}the completed execution {} t = {}:\n\n{}", description_.title,
                                       hypotheses(), is_whole ? "is proved until" : "is proved only until",
                                       reach_text(proof_, digits_of_reach), events());
        if (is_whole) text += state("end", *proof_.end);
        for (const EnclosedState& sample : proof_.samples) text += state("at", sample);
        if (!is_whole) text += fmt::format("\nUndecided from there: {}.\n", proof_.outcome.message);
        if (has_rounded_times())
            text += "\nThe end time and the sample times are the doubles nearest to the times above.\n";
        return text + fmt::format("\nAssumptions: {}.\n", proof_.assumptions);
    }

 private:
    std::string hypotheses() const {
        std::string text = fmt::format("For every start with\n  {}\n  {}\n", list(names_, claim_.q, inner_text),
                                       list(rates_, claim_.v, inner_text));
        std::vector<std::string> parameters;
        for (const auto& parameter : description_.parameters) parameters.push_back(parameter.name);
        if (!parameters.empty())
            text += fmt::format("and all parameters with\n  {}\n", list(parameters, claim_.parameters, inner_text));
        return text;
    }

    // For successive impacts, the first one and the number of others.
    std::string events() const {
        std::string text;
        int impacts = 0;
        for (const EnclosedEvent& event : proof_.events) {
            if (event.is_impact() && impacts++ > 0) continue;
            if (!event.is_impact()) text += more_impacts(std::exchange(impacts, 0), &event);
            const std::string contact =
                description_.constraints.size() > 1 ? ", " + description_.constraints[event.contact].name : "";
            text += fmt::format("  {:<8} t {}{}\n           {}\n", names_of(event).word, outer_text(event.t), contact,
                                list(names_, event.q, outer_text));
        }
        text += more_impacts(impacts, nullptr);
        if (proof_.events_differ) text += "  (the parts list different events from here on)\n";
        return text;
    }

    // The line for the other impacts after the first; `next` is the event after them, or null at the end.
    static std::string more_impacts(int impacts, const EnclosedEvent* next) {
        const int after_first = std::max(impacts - 1, 0);
        const bool is_cut = next != nullptr && next->is_zeno() && !is_plastic_impact(*next);
        const int more_in_some = is_cut ? next->most_impacts - next->impacts : 0;
        if (after_first + more_in_some == 0) return "";
        std::string count = fmt::format("{}", after_first);
        if (more_in_some > 0) count += fmt::format(" to {}", after_first + more_in_some);
        return fmt::format("  {:<8} {} more{}{}\n", "impacts", count, is_cut ? " before the cut" : "",
                           more_in_some > 0 ? ", by part" : "");
    }

    std::string state(const char* what, const EnclosedState& there) const {
        return fmt::format("  {:<8} t = {}\n           {}\n           {}\n", what, there.t + 0.0,
                           list(names_, there.q, outer_text), list(rates_, there.v, outer_text));
    }

    bool has_rounded_times() const {
        const bool is_end = proof_.end && is_rounded(proof_.end->t);
        return is_end || std::any_of(proof_.samples.begin(), proof_.samples.end(),
                                     [](const EnclosedState& sample) { return is_rounded(sample.t); });
    }

    static constexpr int digits_of_reach = 10;
    const SystemDescription& description_;
    const EnclosureProblem& claim_;
    const Enclosure& proof_;
    std::vector<std::string> names_, rates_;
};

}  // namespace

std::string_view to_text(Enclosure::ProofOutcome::Kind kind) {
    switch (kind) {
        case Enclosure::ProofOutcome::Kind::end_time:
            return "end time";
        case Enclosure::ProofOutcome::Kind::undecided:
            return "undecided";
        case Enclosure::ProofOutcome::Kind::cancelled:
            return "cancelled";
    }
    return "";
}

std::string to_json(const Model& model, const EnclosureProblem& claim, const Enclosure& proof) {
    const SystemDescription& description = model.description();
    Json coordinates = Json::array(), parameters = Json::object(), events = Json::array(), samples = Json::array();
    for (const auto& coordinate : description.coordinates) coordinates.push_back(coordinate.name);
    for (std::size_t i = 0; i < description.parameters.size(); ++i)
        parameters[description.parameters[i].name] = interval(claim.parameters[i]);
    for (const EnclosedEvent& event : proof.events) {
        const auto names = [&](const ContactSet& set) {
            Json result = Json::array();
            for (std::size_t i = 0; i < description.constraints.size(); ++i)
                if (set.contains(i)) result.push_back(description.constraints[i].name);
            return result;
        };
        Json entry = {{"kind", names_of(event.kind).word},
                      {"t", interval(event.t)},
                      {"contact", description.constraints[event.contact].name},
                      {"held", names(event.mode.held())},
                      {"opened", names(event.opened)},
                      {"q", box(event.q)}};
        if (event.is_impact()) {
            entry["v_before"] = box(event.v_before);
            entry["v_after"] = box(event.v_after);
        } else {
            entry["v"] = box(event.v_after);
        }
        if (event.is_zeno()) {
            entry["impacts"] = event.impacts;
            if (event.impacts < event.most_impacts) entry["impacts_of_parts"] = {event.impacts, event.most_impacts};
        }
        events.push_back(entry);
    }
    for (const EnclosedState& sample : proof.samples) samples.push_back(state(sample));
    Json result = {{"achilles", version()},
                   {"system", {{"title", description.title}, {"coordinates", coordinates}}},
                   {"claim",
                    {{"start_time", number_json(claim.run.options.start_time)},
                     {"end_time", number_json(claim.run.options.end_time)},
                     {"q", box(claim.q)},
                     {"v", box(claim.v)},
                     {"parameters", parameters}}},
                   {"proved_until", number_json(proof.proved_until)},
                   {"events", events},
                   {"events_differ", proof.events_differ},
                   {"end", proof.end ? state(*proof.end) : Json(nullptr)}};
    if (!claim.times.empty()) result["samples"] = samples;
    result["outcome"] = {{"kind", to_text(proof.outcome.kind)}, {"message", proof.outcome.message}};
    result["statistics"] = {{"steps", proof.statistics.steps}, {"impacts", proof.statistics.impacts}};
    result["assumptions"] = proof.assumptions;
    return result.dump(1) + "\n";
}

std::string reach_text(const Enclosure& proof, int digits) {
    const bool is_whole = proof.outcome.kind == Enclosure::ProofOutcome::Kind::end_time;  // end time as typed
    return is_whole ? fmt::format("{}", proof.proved_until + 0.0) : rounded_down(proof.proved_until, digits);
}

std::string proof_text(const Model& model, const EnclosureProblem& claim, const Enclosure& proof) {
    return ProofText(model, claim, proof).text();
}

std::vector<const EnclosedEvent*> enclosed_events(const Trajectory& run, const Enclosure& proof) {
    std::vector<const EnclosedEvent*> result(run.events.size(), nullptr);
    for (std::size_t contact = 0; contact < run.model->contacts(); ++contact) {
        auto enclosed = proof.events.begin();
        const auto skip = [&](bool impacts) {  // to the next event of this contact
            while (enclosed != proof.events.end() &&
                   (enclosed->contact != contact || (impacts && enclosed->is_impact())))
                ++enclosed;
            return enclosed != proof.events.end();
        };
        for (std::size_t i = 0; i < run.events.size(); ++i) {
            if (!run.events[i].contacts.contains(contact)) continue;
            const bool is_impact = run.events[i].is_impact();
            if (!skip(!is_impact)) break;
            if (enclosed->kind == run.events[i].kind)
                result[i] = &*enclosed++;
            else if (!is_impact)
                break;
        }
    }
    return result;
}

namespace {

constexpr std::size_t max_enclosure_columns = 4;  // columns of the table

// "2.5 +- 1e-9", without the equals sign.
std::string cell(const Interval& x) {
    const std::string text = outer_text(x);
    return text.starts_with("= ") ? text.substr(2) : text;
}

class ProofAnswer {
 public:
    ProofAnswer(const Model& model, const EnclosureProblem& claim, const Enclosure& proof)
        : description_(model.description()), claim_(claim), proof_(proof) {}

    std::string text() const {
        std::string text = first_lines();
        if (const auto rows = this->rows(); !rows.empty()) text += "\n" + table(rows);
        return text + "\n" + hypotheses() + assumptions();
    }

 private:
    using Row = std::vector<std::string>;

    bool is_whole() const { return proof_.end.has_value(); }
    std::size_t columns() const { return std::min(description_.coordinates.size(), max_enclosure_columns); }

    std::string first_lines() const {
        const std::string reach = reach_text(proof_);
        if (is_whole()) return fmt::format("{}: proved to t = {} s, the end\n", description_.title, reach);
        return fmt::format("{}: proved to t = {} s of {:.9g} s, then undecided\n  {}.\n  {}\n", description_.title,
                           reach, claim_.run.options.end_time, proof_.outcome.message,
                           "Try a smaller box (--width, --set NAME=LOW..HIGH), or more parts (--split).");
    }

    Row row(std::string name, std::string time, const Intervals& q) const {
        Row cells{std::move(name), std::move(time)};
        for (std::size_t i = 0; i < columns(); ++i) cells.push_back(cell(q[i]));
        if (columns() < description_.coordinates.size()) cells.emplace_back("...");
        return cells;
    }

    // One row per change of the contact state. Impacts are included only if they open a contact.
    std::vector<Row> rows() const {
        std::vector<Row> rows;
        for (const EnclosedEvent& event : proof_.events) {
            if (event.is_impact() && event.opened.empty()) continue;
            std::string name(names_of(is_plastic_impact(event) ? Event::Kind::impact : event.kind).label);
            if (description_.constraints.size() > 1) name += " of " + description_.constraints[event.contact].name;
            rows.push_back(row(std::move(name), cell(event.t), event.q));
        }
        if (is_whole()) rows.push_back(row("end", fmt::format("{}", proof_.end->t), proof_.end->q));
        for (const EnclosedState& sample : proof_.samples)
            rows.push_back(row("sample", fmt::format("{}", sample.t), sample.q));
        return rows;
    }

    std::string table(const std::vector<Row>& rows) const {
        TextTable table;
        table.add_column("event", TextTable::Align::left);
        table.add_column("t (s)", TextTable::Align::decimal_point);
        for (std::size_t i = 0; i < columns(); ++i) {
            const CoordinateDescription& coordinate = description_.coordinates[i];
            table.add_column(
                coordinate.unit.empty() ? coordinate.name : fmt::format("{} ({})", coordinate.name, coordinate.unit),
                TextTable::Align::decimal_point);
        }
        if (columns() < description_.coordinates.size()) table.add_column("...", TextTable::Align::left);
        add_first_and_last(
            rows, [&](const Row& row) { table.add_row(row); },
            [&](std::size_t count) { table.add_line(fmt::format("... {} more events (--verbose)", count)); });
        return table.text();
    }

    // Short version; proof_.assumptions is complete.
    static std::string assumptions() {
        return "Assumes IEEE arithmetic, a math library within 2 ulp (4 for hyperbolic functions), and correctly "
               "derived and\n"
               "compiled equations: achilles help accuracy. Impacts: --verbose\n";
    }

    // "Holds for x = 0, y = 2, ...": numbers as typed or rounded inward.
    std::string hypotheses() const {
        std::string text;
        const auto add = [&](const std::string& name, const Interval& x) {
            text += fmt::format("{}{} {}", text.empty() ? "Holds for " : ", ", name, inner_text(x));
        };
        for (std::size_t i = 0; i < claim_.q.size(); ++i) add(description_.coordinates[i].name, claim_.q[i]);
        for (std::size_t i = 0; i < claim_.v.size(); ++i) add(description_.coordinates[i].name + "'", claim_.v[i]);
        for (std::size_t i = 0; i < claim_.parameters.size(); ++i)
            add(description_.parameters[i].name, claim_.parameters[i]);
        return text + ". Initial boxes: --width, --set NAME=LOW..HIGH\n";
    }

    const SystemDescription& description_;
    const EnclosureProblem& claim_;
    const Enclosure& proof_;
};

}  // namespace

std::string proof_answer(const Model& model, const EnclosureProblem& claim, const Enclosure& proof) {
    return ProofAnswer(model, claim, proof).text();
}

}  // namespace achilles
