#include "session/run_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>

#include "figure/label.hpp"
#include "figure/palette.hpp"
#include "model/model.hpp"
#include "number/angle.hpp"
#include "output/contacts.hpp"
#include "output/precision.hpp"
#include "session/replay_script.hpp"
#include "session/results_text.hpp"

namespace achilles {

std::vector<VaryingInput> varying_inputs(std::span<const Run* const> runs, const SystemDescription& description) {
    std::vector<VaryingInput> all;
    for (std::size_t i = 1; i < runs.size(); ++i) {
        // Every list has the same order: a new name is inserted after the last match.
        std::size_t at = 0;
        for (const RunDifference& difference : differences(description, *runs[i], *runs[0])) {
            auto found = std::find_if(all.begin(), all.end(),
                                      [&](const VaryingInput& input) { return input.name == difference.name; });
            if (found == all.end())
                found = all.insert(
                    all.begin() + static_cast<std::ptrdiff_t>(at),
                    {difference.name, difference.is_option, std::vector<std::string>(runs.size(), difference.other)});
            found->values[i] = difference.now;
            at = static_cast<std::size_t>(found - all.begin()) + 1;
        }
    }
    return all;
}

std::vector<std::string> names_of_runs(std::span<const Run* const> runs, const SystemDescription& description) {
    const std::vector<VaryingInput> inputs = varying_inputs(runs, description);
    const auto name_of = [&](std::size_t run, std::size_t most) {
        std::vector<std::string> parts;
        for (const VaryingInput& input : inputs)
            parts.push_back(input.name + (input.is_option ? " " : " = ") + input.values[run]);
        if (parts.size() > most) parts.resize(most), parts.emplace_back("\u2026");
        return fmt::format("{}", fmt::join(parts, ", "));
    };
    constexpr std::size_t few = 3;
    const auto tells_apart = [&](std::size_t most) {
        std::map<std::string, const Run*> known;
        for (std::size_t i = 0; i < runs.size(); ++i)
            if (*known.try_emplace(name_of(i, most), runs[i]).first->second != *runs[i]) return false;
        return true;
    };
    const std::size_t most = inputs.size() > few && !tells_apart(few) ? inputs.size() : few;
    std::vector<std::string> names;
    std::map<std::string, int> known;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        std::string& name = names.emplace_back(name_of(i, most));
        if (i > 0 && *runs[i] == *runs[0])
            name = names[0];
        else if (const int count = ++known[name]; count > 1)
            name += fmt::format(" ({})", count);
    }
    return names;
}

namespace {

std::string value_text(double value, double error, int digits) {
    std::string text = known_digits(value, error, digits);
    for (std::size_t at = text.find('-'); at != std::string::npos; at = text.find('-', at + 1))
        text.replace(at, 1, "\u2212");
    return text;
}

const std::string nothing = "\u2013";

// An event in the table: a contact comes to rest, is released, or is opened by an impact.
struct RunStep {
    std::string name;
    double t = 0.0, error = 0.0;  // s
    std::string digits;           // the digits of t that every panel shows
};

std::vector<RunStep> steps_of(const Trajectory& run, const Precision& precision) {
    std::vector<RunStep> steps;
    for (std::size_t i = 0; i < run.events.size(); ++i) {
        const Event& event = run.events[i];
        if (!event.changes_held()) continue;
        // The digits that the bound of this time supports.
        double error = precision.of_event(i);
        const EventTime time = event_time(run, i, error);
        if (!time.bound.empty()) error = std::max(error, std::strtod(time.bound.c_str(), nullptr));
        const std::string contacts = event_contacts_text(run, event);
        steps.push_back({event.opened.empty() || !event.is_impact()
                             ? fmt::format("{}{}{}", names_of(event).label, contacts.empty() ? "" : " ", contacts)
                             : contacts + " opens " + joined_names(*run.model, event.opened),
                         event.t, error, time.digits});
    }
    return steps;
}

// Where the event sequences of two runs begin to differ.
struct RunDivergence {
    std::string after;     // the last common event: "release 2"; empty: they differ from the start
    std::string sentence;  // the next event of each run
};
std::optional<RunDivergence> divergence(const std::vector<RunStep>& present, double present_end,
                                        const std::vector<RunStep>& other, double other_end) {
    std::size_t same = 0;
    while (same < present.size() && same < other.size() && present[same].name == other[same].name) ++same;
    if (same == present.size() && same == other.size()) return std::nullopt;
    RunDivergence result;
    if (same > 0) {
        const std::string& last = present[same - 1].name;
        const auto count = std::count_if(present.begin(), present.begin() + static_cast<std::ptrdiff_t>(same),
                                         [&](const RunStep& step) { return step.name == last; });
        result.after = fmt::format("{} {}", last, count);
    }
    const auto goes_on = [&](const std::vector<RunStep>& steps, double end) {
        return same < steps.size()
                   ? fmt::format("{} at {} s", steps[same].name, value_text(steps[same].t, steps[same].error, 5))
                   : fmt::format("no further event until {} s", value_text(end, 0.0, 5));
    };
    result.sentence =
        fmt::format("{}: {}; the present run: {}", same > 0 ? "after " + result.after : std::string("from the start"),
                    goes_on(other, other_end), goes_on(present, present_end));
    return result;
}

class RunTableBuilder {
 public:
    explicit RunTableBuilder(std::span<const ShownRun> runs) : digits_(runs.size() <= 3 ? all_digits : 7) {
        for (const ShownRun& shown : runs) {
            runs_.push_back(shown.run);
            precisions_.emplace_back(*shown.run, shown.estimate);
            courses_.push_back(steps_of(*shown.run, precisions_.back()));
        }
    }

    RunTable made() {
        inputs();
        divergences();
        courses();
        std::vector<ValueWithError> impacts, ends;
        for (const Trajectory* run : runs_) {
            impacts.push_back({static_cast<double>(run->statistics.impacts), 0.0, ""});
            ends.push_back({run->end_time, 0.0, ""});
        }
        numbers("impacts", impacts);
        if (std::any_of(runs_.begin(), runs_.end(),
                        [](const Trajectory* run) { return run->outcome.kind != Outcome::Kind::end_time; }))
            outcomes();
        numbers("end (s)", ends);
        states();
        return std::move(table_);
    }

 private:
    void inputs() {
        std::vector<const Run*> recipes;
        for (const Trajectory* run : runs_) recipes.push_back(&run->run);
        for (VaryingInput& input : varying_inputs(recipes, runs_[0]->model->description())) {
            RunTable::Row& row = table_.rows.emplace_back();
            row.name = std::move(input.name);
            row.values = std::move(input.values);
            for (const std::string& value : row.values) row.differs.push_back(value != row.values[0]);
            row.is_cause = true;
        }
    }

    struct ValueWithError {
        double x = std::nan(""), error = 0.0;  // NaN: no value
        std::string text;                      // used where there is room for all digits, unless empty
    };
    void numbers(const std::string& name, const std::vector<ValueWithError>& values) {
        RunTable::Row& row = table_.rows.emplace_back();
        row.name = name;
        for (const auto& [x, error, text] : values) {
            row.values.push_back(!std::isfinite(x)                        ? nothing
                                 : digits_ == all_digits && !text.empty() ? text
                                                                          : value_text(x, error, digits_));
            row.differs.push_back(x != values[0].x && !(std::isnan(x) && std::isnan(values[0].x)));
        }
        if (values.size() == 2 && std::isfinite(values[0].x) && std::isfinite(values[1].x))
            row.change = value_text(values[0].x - values[1].x, values[0].error + values[1].error, 3);
    }

    void divergences() {
        RunTable::Row row{"same events until", {nothing}, {false}, "", false};
        for (std::size_t i = 1; i < runs_.size(); ++i) {
            const auto found = divergence(courses_[0], runs_[0]->end_time, courses_[i], runs_[i]->end_time);
            row.values.push_back(!found ? "the end" : found->after.empty() ? "the start" : found->after);
            row.differs.push_back(found.has_value());
            if (found) table_.divergences.emplace_back(i, found->sentence);
        }
        if (!table_.divergences.empty()) table_.rows.push_back(std::move(row));
    }

    // Event by event in the order of the current run, then those that only other runs have. No rows beyond `most`
    // events.
    void courses() {
        constexpr std::size_t most = 60;
        const std::vector<std::vector<RunStep>>& all = courses_;
        std::map<std::string, std::vector<std::vector<ValueWithError>>>
            times;                                               // per name and run: times of its occurrences
        std::vector<std::pair<std::string, std::size_t>> order;  // rows: name and number of the occurrence
        for (std::size_t i = 0; i < all.size(); ++i)
            for (const RunStep& step : all[i]) {
                auto& of_runs = times[step.name];
                of_runs.resize(all.size());
                of_runs[i].push_back({step.t, step.error, step.digits});
                const std::pair<std::string, std::size_t> key{step.name, of_runs[i].size()};
                const auto longest = [&] {
                    std::size_t longest_of_others = 0;
                    for (std::size_t j = 0; j < i; ++j)
                        longest_of_others = std::max(longest_of_others, of_runs[j].size());
                    return longest_of_others;
                };
                if (order.size() < most && key.second > longest()) order.push_back(key);
            }
        for (const auto& [name, number] : order) {
            std::vector<ValueWithError> values;
            for (const std::vector<ValueWithError>& of_run : times[name])
                values.push_back(number <= of_run.size() ? of_run[number - 1] : ValueWithError{});
            numbers(fmt::format("{} {} (s)", name, number), values);
        }
    }

    void outcomes() {
        RunTable::Row& row = table_.rows.emplace_back();
        row.name = "stopped by";
        for (const Trajectory* run : runs_) {
            row.values.emplace_back(to_text(run->outcome.kind));
            row.differs.push_back(run->outcome.kind != runs_[0]->outcome.kind);
        }
    }

    void states() {
        const auto& coordinates = runs_[0]->model->description().coordinates;
        for (std::size_t i = 0; i < coordinates.size(); ++i) {
            const auto at = static_cast<Eigen::Index>(i);
            const bool is_angle = coordinates[i].unit == "rad";
            const double factor = is_angle ? degrees(1.0) : 1.0;
            for (const bool is_rate : {false, true}) {
                std::vector<ValueWithError> values;
                for (std::size_t k = 0; k < runs_.size(); ++k) {
                    const State errors = precisions_[k].of_state(runs_[k]->end_time);
                    values.push_back({(is_rate ? runs_[k]->end.v : runs_[k]->end.q)[at] * factor,
                                      (is_rate ? errors.v : errors.q)[at] * factor, ""});
                }
                std::string unit = is_angle ? "\u00b0" : typeset_unit(coordinates[i].unit);
                if (is_rate && !unit.empty()) unit += "/s";
                numbers(with_unit(typeset_name(coordinates[i].name + (is_rate ? "'" : "")) + " at the end", unit),
                        values);
            }
        }
    }

    std::vector<const Trajectory*> runs_;
    static constexpr int all_digits = 10;
    std::vector<Precision> precisions_;
    int digits_;
    std::vector<std::vector<RunStep>> courses_;
    RunTable table_;
};

}  // namespace

RunTable run_table(std::span<const ShownRun> runs) { return RunTableBuilder(runs).made(); }

std::string to_text(const RunTable& table) {
    std::string text;
    for (const RunTable::Row& row : table.rows) {
        text += row.name;
        for (std::size_t i = 0; i < row.values.size(); ++i)
            text += fmt::format(" | {}{}", row.values[i], row.differs[i] ? " *" : "");
        text += (row.change.empty() ? "" : " | " + row.change) + "\n";
    }
    for (const auto& [run, sentence] : table.divergences) text += fmt::format("run {} {}\n", run, sentence);
    return text;
}

}  // namespace achilles
