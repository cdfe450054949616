// Output of a trajectory as CSV, the instants that it contains, and a short text for golden tests.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "expression/parse.hpp"
#include "model/model.hpp"
#include "number/float_environment.hpp"
#include "output/contacts.hpp"
#include "output/output.hpp"
#include "simulate/contact_forces.hpp"
#include "system/description.hpp"
#include "system/input_error.hpp"
#include "system/units.hpp"

namespace achilles {

namespace {

// In the shortest form that is read back as the same double; empty if it is not finite.
void append(std::string& row, double x) {
    row += ',';
    if (std::isfinite(x)) row += fmt::format("{}", x + 0.0);
}

// Reserved words of Python that a coordinate may have as a name. The column lambda always needs a replacement.
constexpr std::string_view python_keywords[] = {
    "and",    "as",   "assert", "async",  "await",    "break", "class", "continue", "def",
    "del",    "elif", "else",   "except", "finally",  "for",   "from",  "global",   "if",
    "import", "in",   "is",     "lambda", "nonlocal", "not",   "or",    "pass",     "raise",
    "return", "try",  "while",  "with",   "yield",    "None",  "True",  "False"};

// Unique names that are valid in Python: x' becomes x_rate.
std::vector<std::string> plain(const std::vector<std::string>& columns) {
    std::vector<std::string> names;
    for (std::string name : columns) {
        if (name.ends_with('\'')) name.replace(name.size() - 1, 1, "_rate");
        std::replace(name.begin(), name.end(), ' ', '_');
        const auto is_taken = [&](const auto& list) {
            return std::find(std::begin(list), std::end(list), name) != std::end(list);
        };
        while (is_taken(python_keywords) || is_taken(names)) name += '_';
        names.push_back(name);
    }
    return names;
}

std::string row_of(const std::vector<std::string>& cells) {
    std::string row;
    for (const std::string& cell : cells) row += (&cell == cells.data() ? "" : ",") + cell;
    return row + "\n";
}

bool is_of_several(const Model& model) { return model.contacts() > 1; }
bool has_work(const Model& model) {
    return is_of_several(model) || model.equations().has_power() || model.has_friction() || model.has_jumps();
}
// With one gap and no joints, the columns of contacts and friction have no names of contacts.
bool has_named_columns(const Model& model) { return is_of_several(model) || !model.description().frictions.empty(); }

// The names of the columns and, if requested, their units.
std::string heading(const Model& model, const CsvStyle& style) {
    std::vector<std::string> columns{"t", "phase"}, units{"s", ""};
    for (std::size_t i = 0; i < 2 * static_cast<std::size_t>(model.dof()); ++i) {
        columns.push_back(model.slot_names()[i]);
        units.push_back(printable(unit_of(model.description(), columns.back())));
    }
    const auto add = [&](const std::string& column, const std::string& of = {}) {
        columns.push_back(column);
        units.push_back(of.empty() ? "" : unit_of_expression(model.description(), of));
    };
    const auto add_friction = [&](std::size_t which, const std::string& name) {
        if (!model.equations().friction.contains(which)) return;
        add(has_named_columns(model) ? "slip_" + name : "slip");
        add(has_named_columns(model) ? "friction_force_" + name : "friction_force");
    };
    const auto& constraints = model.description().constraints;
    for (std::size_t i = 0; i < constraints.size(); ++i) {
        const std::string& name = constraints[i].name;
        if (is_of_several(model)) {
            add("gap_" + name, "gap_" + name);
            add("rate_" + name, "gap_" + name + "'");
            add("lambda_" + name, "lambda_" + name);
        } else {
            for (const auto& [column, of] : {std::pair{"gap", "gap"}, {"gap rate", "gap'"}, {"lambda", "lambda"}})
                add(column, of);
        }
        add_friction(i, name);
    }
    const auto& frictions = model.description().frictions;
    for (std::size_t k = 0; k < frictions.size(); ++k) add_friction(joint_number(k), frictions[k].name);
    add("energy", "energy");
    add("j");
    if (is_of_several(model)) add("held");
    if (model.has_conditional_contacts()) add("inactive");
    if (model.has_latches()) add("latched");
    if (model.has_friction()) add("modes");
    if (has_work(model)) {
        add("work", "work");
        add("loss", "loss");
    }
    if (model.has_friction()) add("heat", "energy");
    if (style.instants) add("event");
    return row_of(style.plain_names ? plain(columns) : columns) + (style.units ? row_of(units) : "");
}

// The kinds of events [first, last), each once, in order of time: "impact+zeno". Empty if there are no events.
std::string kinds_of(const Trajectory& trajectory, int first, int last) {
    std::string kinds;
    for (int i = first; i < last; ++i) {
        const std::string_view kind = names_of(trajectory.events[static_cast<std::size_t>(i)].kind).word;
        if (kinds.find(kind) == kinds.npos) kinds += (kinds.empty() ? "" : "+") + std::string(kind);
    }
    return kinds;
}

}  // namespace

std::string to_csv(const Trajectory& trajectory, const CsvStyle& style) {
    const FloatEnvironmentGuard ground;
    const Model& model = *trajectory.model;
    std::string text = heading(model, style);
    std::vector<ContactTerms<Evaluator<double>>> contacts;
    for (std::size_t i = 0; i < model.contacts(); ++i)
        contacts.push_back(model.evaluator(model.programs_of(i).contact_terms, trajectory.run.parameters));
    ContactForces forces(model, trajectory.run.parameters);
    auto energy = model.evaluator(model.energy(), trajectory.run.parameters);
    ContactCache slips(model, trajectory.run);
    const auto append_friction = [&](std::string& row, const Sample& sample, std::size_t which) {
        if (!model.equations().friction.contains(which)) return;
        append(row, slips.slip(which, sample.state).u);
        append(row, forces.friction_force(which));
    };
    int happened = 0;  // number of events up to the previous row
    for (const Sample& sample :
         style.instants ? samples_at(trajectory, *style.instants) : samples_of_curve(trajectory)) {
        forces.set(sample);
        set_state(energy, sample.state);
        energy.run();
        text += fmt::format("{},{}", sample.t + 0.0, to_text(sample.phase));
        for (Eigen::Index i = 0; i < model.dof(); ++i) append(text, sample.state.q[i]);
        for (Eigen::Index i = 0; i < model.dof(); ++i) append(text, sample.state.v[i]);
        for (std::size_t i = 0; i < contacts.size(); ++i) {
            set_state(contacts[i], sample.state);
            contacts[i].run();
            append(text, contacts[i].h());
            append(text, contacts[i].hdot());
            append(text, forces.force(i));
            append_friction(text, sample, i);
        }
        for (std::size_t k = 0; k < model.description().frictions.size(); ++k)
            append_friction(text, sample, joint_number(k));
        append(text, energy.total());
        text += fmt::format(",{}", sample.j);
        if (is_of_several(model)) text += "," + joined_names(model, sample.mode.held(), "+");
        if (model.has_conditional_contacts()) text += "," + joined_names(model, sample.inactive, "+");
        if (model.has_latches()) text += "," + joined_names(model, sample.latched, "+");
        if (model.has_friction()) text += "," + modes_text(model, sample.mode);
        if (has_work(model)) {
            append(text, sample.work);
            append(text, sample.loss);
        }
        if (model.has_friction()) append(text, sample.heat);
        if (style.instants) text += ',' + kinds_of(trajectory, std::exchange(happened, sample.j), sample.j);
        text += '\n';
    }
    return text;
}

std::vector<double> equidistant(int count, double start, double end) {
    std::vector<double> times;
    for (int i = 0; i < count; ++i) times.push_back(start + (end - start) * i / (count - 1));
    times.back() = end;
    return times;
}

std::vector<double> read_instants(std::string_view text, const std::string& name, double start, double end) {
    constexpr std::string_view spaces = " \t\r";
    std::vector<double> times;
    int number = 0;
    while (!text.empty()) {
        const std::size_t size = std::min(text.find('\n'), text.size());
        const std::string line(text.substr(0, size));
        text.remove_prefix(std::min(size + 1, text.size()));
        ++number;
        const std::string_view words = std::string_view(line).substr(0, line.find('#'));
        const std::size_t first = words.find_first_not_of(spaces);
        if (first == words.npos) continue;
        const auto refuse = [&](const std::string& why) {
            return InputError(name, {number, static_cast<int>(first) + 1}, why, {}, line);
        };
        double t = 0.0;
        try {
            t = read_number(words).value;
        } catch (const ParseError& problem) {
            throw refuse(problem.what());
        }
        if (!(t >= start && t <= end))
            throw refuse(fmt::format("{} is outside the run, {} to {}; leave it out, or change --end", t, start, end));
        times.push_back(t);
    }
    if (times.empty()) throw InputError(name, {}, "the file contains no time", "write one time per line");
    return times;
}

std::vector<Sample> samples_of_curve(const Trajectory& trajectory) {
    constexpr std::size_t wanted = 1000;
    return Sampler(trajectory).all(static_cast<int>(wanted / std::max<std::size_t>(1, trajectory.pieces.size())));
}

std::vector<Sample> samples_at(const Trajectory& trajectory, const std::vector<double>& times) {
    Sampler sampler(trajectory);
    std::vector<Sample> samples;
    for (const double t : times)
        if (t <= trajectory.end_time) samples.push_back(sampler.at(t));
    return samples;
}

namespace {

std::string to_text(const Vector& x) {
    std::string text = "(";
    // Adding 0.0 turns -0 into 0, so that golden tests do not see the difference.
    for (Eigen::Index i = 0; i < x.size(); ++i) text += fmt::format("{}{:.9g}", i == 0 ? "" : ", ", x[i] + 0.0);
    return text + ")";
}

// " {what} knee+post" for a system with several contacts; else empty.
std::string contacts(const Trajectory& trajectory, const char* what, ContactSet contacts) {
    const Model& model = *trajectory.model;
    if (model.contacts() < 2 || contacts.empty()) return "";
    return fmt::format(" {} {}", what, joined_names(model, contacts, "+"));
}

}  // namespace

std::string to_text(const Trajectory& trajectory) {
    std::string text;
    for (const Phase& phase : trajectory.phases)
        text += fmt::format("phase {}{} [{:.9g}, {:.9g}] impacts {}\n", to_text(phase.kind),
                            contacts(trajectory, "held", phase.mode.held()), phase.start, phase.end, phase.impacts);
    for (const Event& event : trajectory.events)
        text += fmt::format("{}{}{}{} t {:.9g} q {} before {} after {}\n", names_of(event.kind).word,
                            contacts(trajectory, "of", event.contacts), contacts(trajectory, "opens", event.opened),
                            contacts(trajectory, "held", event.mode.held()), event.t, to_text(event.q),
                            to_text(event.v_before), to_text(event.v_after));
    return text + fmt::format("end t {:.9g} {}{} q {} v {}\noutcome {}: {}\n", trajectory.end_time,
                              to_text(trajectory.end_phase), contacts(trajectory, "held", trajectory.end_mode.held()),
                              to_text(trajectory.end.q), to_text(trajectory.end.v), to_text(trajectory.outcome.kind),
                              trajectory.outcome.message);
}

}  // namespace achilles
