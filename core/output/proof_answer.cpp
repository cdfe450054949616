// The default output of `prove`: the answer first, then a table of what changed, then the hypotheses.
#include <fmt/format.h>

#include <algorithm>

#include "model/model.hpp"
#include "output/bounds.hpp"
#include "output/proof.hpp"
#include "output/text_table.hpp"

namespace achilles {

namespace {

constexpr std::size_t most_coordinates = 4;  // columns of the table

// "2.5 +- 1e-9", without the equals sign of a list.
std::string cell(const Interval& x) {
    const std::string text = outer_text(x);
    return text.starts_with("= ") ? text.substr(2) : text;
}

class ProofAnswer {
 public:
    ProofAnswer(const Model& model, const Claim& claim, const Enclosure& proof)
        : description_(model.description()), claim_(claim), proof_(proof) {}

    std::string text() const {
        std::string text = first_lines();
        if (const auto rows = this->rows(); !rows.empty()) text += "\n" + table(rows);
        return text + "\n" + hypotheses() + assumptions();
    }

 private:
    using Row = std::vector<std::string>;

    bool is_whole() const { return proof_.end.has_value(); }
    std::size_t columns() const { return std::min(description_.coordinates.size(), most_coordinates); }

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

    // A change of the contact state: no impact, but those that open a contact.
    std::vector<Row> rows() const {
        std::vector<Row> rows;
        for (const EnclosedEvent& event : proof_.events) {
            const bool is_impact = event.kind == Event::Kind::impact;
            if (is_impact && event.opened.empty()) continue;
            const bool is_plastic = event.kind == Event::Kind::zeno && event.most_impacts == 0;
            std::string name = is_impact || is_plastic              ? "impact"
                               : event.kind == Event::Kind::release ? "release"
                                                                    : "Zeno";
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

    // In short; proof_.assumptions has them in full.
    static std::string assumptions() {
        return "Assumes IEEE arithmetic, a math library within 2 ulp (4 for hyperbolic functions), and correctly "
               "derived and\n"
               "compiled equations: achilles help accuracy. Impacts: --verbose\n";
    }

    // "Holds for x = 0, y = 2, ...": every number as typed or rounded inward.
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
    const Claim& claim_;
    const Enclosure& proof_;
};

}  // namespace

std::string proof_answer(const Model& model, const Claim& claim, const Enclosure& proof) {
    return ProofAnswer(model, claim, proof).text();
}

}  // namespace achilles
