// Output of a periodic orbit and its branch, as JSON and as text.
#include "output/output.hpp"

#include <fmt/format.h>

#include <cmath>

#include "analysis/orbit.hpp"
#include "model/model.hpp"
#include "output/contacts.hpp"
#include "output/json_parts.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

using Json = nlohmann::ordered_json;

template <class List>
Json list(const List& x) {
    Json result = Json::array();
    for (Eigen::Index i = 0; i < x.size(); ++i) result.push_back(number_json(x[i]));
    return result;
}

void add_point(Json& json, const OrbitPoint& point) {
    json["period"] = number_json(point.period);
    json["state"] = {{"t", number_json(point.state.t)}, {"q", list(point.state.q)}, {"v", list(point.state.v)}};
    Json& multipliers = json["multipliers"] = Json::array();
    for (const auto& mu : point.multipliers) multipliers.push_back({number_json(mu.real()), number_json(mu.imag())});
    json["zero_multipliers"] = point.zero_multipliers;
    Json& shifts = json["shift"] = Json::object();
    for (const auto& [name, shift] : point.free) shifts[name] = number_json(shift);
    json["stable"] = point.stable;
    json["margins"] = {{"grazing_speed", number_json(point.margins.grazing_speed)},
                       {"gap_minimum", number_json(point.margins.gap_minimum)},
                       {"a_inf", number_json(point.margins.a_inf)},
                       {"release_jerk", number_json(point.margins.release_jerk)}};
    json["psi"] = number_json(point.psi);
}

Json branch_of(const Branch& branch, const SystemDescription& description) {
    const std::string& name = description.parameters[branch.parameter].name;
    const auto points = [&](const std::vector<OrbitPoint>& all) {
        Json result = Json::array();
        for (const OrbitPoint& point : all) {
            Json json = {{"value", number_json(branch.value(point))}};
            add_point(json, point);
            result.push_back(std::move(json));
        }
        return result;
    };
    return {{"parameter", name},
            {"points", points(branch.points)},
            {"folds", points(branch.folds)},
            {"flips", points(branch.flips)},
            {"circles", points(branch.neimark_sacker)},
            {"lost", points(branch.zeno_lost)},
            {"changes", points(branch.changes)},
            {"ends", branch.ends}};
}

}  // namespace

std::string to_json(const Orbit& orbit, const Branch* branch) {
    const SystemDescription& description = orbit.run.model->description();
    Json result = {{"achilles", version()},
                   {"system", system_json(orbit.run)},
                   {"options", options_json(orbit.run)},
                   {"section", orbit.is_at_release   ? "release"
                               : orbit.is_autonomous ? "flight"
                                                     : "time"}};
    add_point(result, orbit);
    result["events"] = events_json(orbit.run);
    Json by = Json::object();
    const Eigen::Index n = orbit.state.q.size();
    for (std::size_t k = 0; k < orbit.parameters.size(); ++k) {
        const Eigen::VectorXd column = orbit.parameter_derivatives.col(static_cast<Eigen::Index>(k));
        by[description.parameters[k].name] = {
            {"period", number_json(column[2 * n])}, {"q", list(column.head(n))}, {"v", list(column.segment(n, n))}};
    }
    result["derivatives"] = std::move(by);
    if (orbit.run.model->has_conditional_contacts())
        result["state"]["inactive"] = contact_names(*orbit.run.model, orbit.run.start_inactive);
    result["newton"] = {{"steps", orbit.iterations}, {"error", number_json(orbit.error)}};
    result["branch"] = branch != nullptr ? branch_of(*branch, description) : Json(nullptr);
    return printable_json(result.dump(2, ' ', false, Json::error_handler_t::replace)) + "\n";
}

namespace {

std::string named(const SystemDescription& description, const Vector& values, const char* prime) {
    std::string text;
    for (Eigen::Index i = 0; i < values.size(); ++i) {
        const std::string name = description.coordinates[static_cast<std::size_t>(i)].name + prime;
        const std::string unit = unit_of(description, name);
        text +=
            fmt::format("{}{} = {:.12g}{}{}", i > 0 ? ", " : "", name, values[i] + 0.0, unit.empty() ? "" : " ", unit);
    }
    return text;
}

std::string multiplier_text(const std::complex<double>& mu, int digits) {
    if (mu.imag() == 0.0) return fmt::format("{:.{}g}", mu.real() + 0.0, digits);
    return fmt::format("{:.{}g} {} {:.{}g}i", mu.real() + 0.0, digits, mu.imag() < 0.0 ? "-" : "+", std::abs(mu.imag()),
                       digits);
}

// The largest size of a multiplier, but for those of shifts in time and of free coordinates.
double largest_multiplier(const OrbitPoint& point) {
    return point.multipliers.size() > point.shifts() ? std::abs(point.multipliers[point.shifts()]) : 0.0;
}

// Whether the largest multiplier has size 1 within its accuracy, as where nothing depends on a coordinate.
bool is_neutral(const OrbitPoint& point) {
    constexpr double accuracy = 1e-6;
    return !point.stable && largest_multiplier(point) <= 1.0 + accuracy;
}

const char* stability_word(const OrbitPoint& point) {
    if (point.stable) return "stable";
    return is_neutral(point) ? "neutral" : "unstable";
}

}  // namespace

std::string multipliers_text(const OrbitPoint& point, int digits) {
    std::string text;
    const std::size_t rest = point.multipliers.size() - point.zero_multipliers;
    for (std::size_t i = 0; i < point.multipliers.size(); ++i) {
        text += fmt::format("{}{}", i > 0 ? ", " : "", multiplier_text(point.multipliers[i], digits));
        const std::size_t first = point.is_autonomous ? 1 : 0;
        if (i < first) text += " (along the motion)";
        if (i >= first && i < point.shifts()) text += fmt::format(" (along {})", point.free[i - first].first);
        if (i + 1 == point.multipliers.size() && i >= rest)
            text += fmt::format(" (the last {} exactly)", point.zero_multipliers);
    }
    return text;
}

std::string stability_text(const OrbitPoint& point) {
    const double most = largest_multiplier(point);
    if (point.stable && most == 0.0) return "stable: perturbations vanish within a period";
    if (point.stable) return fmt::format("stable: perturbations shrink to {:.4g} of their size per period", most);
    if (is_neutral(point)) return "neutral: no perturbation grows, but some do not shrink (multipliers of size 1)";
    return fmt::format("unstable: perturbations grow by a factor {:.4g} per period", most);
}

std::string margins_text(const OrbitPoint& point) {
    std::string text;
    const auto add = [&](const char* what, const std::optional<double>& x) {
        if (x) text += fmt::format("{}{} {:.4g}", text.empty() ? "" : ", ", what, *x);
    };
    add("a_inf", point.margins.a_inf);
    add("h''' at release", point.margins.release_jerk);
    add("smallest speed of an impact that may graze", point.margins.grazing_speed);
    add("smallest minimum of a gap in flight", point.margins.gap_minimum);
    return text.empty() ? "" : "margins: " + text + "\n";
}

namespace {

std::string events_of(const Orbit& orbit) {
    std::string text;
    int impacts = 0;
    const auto tell_impacts = [&](const std::string& behind) {
        if (impacts > 0) text += fmt::format("  {} impact{}{}\n", impacts, impacts == 1 ? "" : "s", behind);
        impacts = 0;
    };
    for (const Event& event : orbit.run.events) {
        if (event.is_impact()) {
            if (++impacts <= 2)
                text += fmt::format("  {:<9} t = {:<18.13g} gap speed {:.6g}\n", "impact", event.t, event.impact_speed);
            continue;
        }
        impacts = std::max(impacts - 2, 0);
        tell_impacts(event.truncation && !is_plastic_landing(event) ? " more before the cut" : " more");
        text += fmt::format("  {:<9} t = {:<18.13g} {}\n", names_of(event).word, event.t,
                            named(orbit.run.model->description(), event.q, ""));
    }
    impacts = std::max(impacts - 2, 0);
    tell_impacts(" more");
    return text.empty() ? "  nothing\n" : text;
}

std::string branch_text(const Branch& branch, const SystemDescription& description) {
    const std::string& name = description.parameters[branch.parameter].name;
    std::string text = fmt::format("\nbranch in {}: {} points from {:.10g} to {:.10g}\n", name, branch.points.size(),
                                   branch.value(branch.points.front()), branch.value(branch.points.back()));
    const auto tell = [&](const char* what, const std::vector<OrbitPoint>& all) {
        for (const OrbitPoint& point : all)
            text += fmt::format("  {:<26} {} = {:.12g}: period {:.10g} s, {}; {}\n", what, name, branch.value(point),
                                point.period, named(description, point.state.q, ""), multipliers_text(point, 11));
    };
    tell("fold", branch.folds);
    tell("period doubling (mu = -1)", branch.flips);
    tell("|mu| = 1, complex", branch.neimark_sacker);
    tell("Zeno point lost", branch.zeno_lost);
    tell("event sequence changes", branch.changes);
    return text + fmt::format("  it ends at the first point: {}\n           at the last point: {}\n", branch.ends[0],
                              branch.ends[1]);
}

}  // namespace

std::string orbit_text(const Orbit& orbit, const Branch* branch) {
    const SystemDescription& description = orbit.run.model->description();
    const Options& o = orbit.run.run.options;
    std::string text = fmt::format("{}\n  {}", description.title, to_text(o.method));
    for (const Option* option : options_in_report_order())
        if (option->key == "tolerance" || option->table == "truncation")
            text += ", " + summary_text(*option, o, "{:g}");
    text += fmt::format("\n  {} steps of Newton's method, the last {:.1e} relative to the state\n\n", orbit.iterations,
                        orbit.error);
    text += fmt::format("period {:.14g} s, from {} t = {:.10g} s\n  {}\n  {}\n", orbit.period,
                        orbit.is_at_release ? "the release at" : "the flight at", orbit.state.t,
                        named(description, orbit.state.q, ""), named(description, orbit.state.v, "'"));
    text += fmt::format("multipliers {}\n{}\n\n{}\n{}", multipliers_text(orbit, 11), stability_text(orbit),
                        events_of(orbit), margins_text(orbit));
    if (branch != nullptr) text += branch_text(*branch, description);
    return text;
}

namespace {

// Summary of one period: "release at 0 s, 17 impacts from 1.886 s before the cut, Zeno point at 2.43686 s".
std::string period_line(const Orbit& orbit) {
    std::string text;
    int impacts = 0;
    double first = 0.0;
    const auto add = [&](const std::string& what) { text += (text.empty() ? "" : ", ") + what; };
    const auto add_impacts = [&](const char* cut) {
        if (impacts > 0) add(fmt::format("{} impact{} from {:.7g} s{}", impacts, impacts == 1 ? "" : "s", first, cut));
        impacts = 0;
    };
    if (orbit.is_at_release) add(fmt::format("release at {:.7g} s", orbit.state.t));
    for (const Event& event : orbit.run.events) {
        if (event.is_impact()) {
            if (impacts++ == 0) first = event.t;
            continue;
        }
        add_impacts(is_zeno_point(event) ? " before the cut" : "");
        add(fmt::format("{} at {:.7g} s", is_plastic_landing(event) ? "contact" : names_of(event).name, event.t));
    }
    add_impacts("");
    return text.empty() ? "no events" : text;
}

// The shifts of free coordinates over a period: "y = -0.0194453793 m".
std::string shifts_text(const OrbitPoint& point) {
    std::string text;
    for (const auto& [name, shift] : point.free)
        text += fmt::format("{}{} = {:.12g}", text.empty() ? "" : ", ", name, shift);
    return text;
}

std::string branch_answer(const Branch& branch, const SystemDescription& description) {
    const std::string& name = description.parameters[branch.parameter].name;
    std::string text =
        fmt::format("\nbranch in {}, {:.6g} to {:.6g} ({} points)\n", name, branch.value(branch.points.front()),
                    branch.value(branch.points.back()), branch.points.size());
    const auto add = [&](const char* what, const std::vector<OrbitPoint>& all) {
        for (const OrbitPoint& point : all)
            text += fmt::format("  {} = {:.9g}   {}, period {:.9g} s\n", name, branch.value(point), what, point.period);
    };
    add("fold", branch.folds);
    add("period doubling (multiplier -1)", branch.flips);
    add("Neimark-Sacker (complex multipliers of size 1)", branch.neimark_sacker);
    add("Zeno point lost", branch.zeno_lost);
    add("event sequence changes", branch.changes);
    return text + fmt::format("  first point: {}\n  last point: {}\n", branch.ends[0], branch.ends[1]);
}

}  // namespace

std::string orbit_answer(const Orbit& orbit, const Branch* branch) {
    const SystemDescription& description = orbit.run.model->description();
    std::string text = fmt::format("{}: {} periodic orbit, period {:.14g} s\n\n", description.title,
                                   stability_word(orbit), orbit.period);
    text += fmt::format("  {}\n", stability_text(orbit));
    text += fmt::format("  multipliers   {}\n", multipliers_text(orbit, 8));
    text += fmt::format("  one period    {}\n", period_line(orbit));
    if (!orbit.free.empty()) text += fmt::format("  shift         {}\n", shifts_text(orbit));
    text += fmt::format("  start         {}, {}\n", named(description, orbit.state.q, ""),
                        named(description, orbit.state.v, "'"));
    if (branch != nullptr) text += branch_answer(*branch, description);
    text += fmt::format(
        "\nNumerical result, not a proof (Newton residual {:.0e}). Margins, impacts, options: --verbose.{}\n",
        orbit.error, branch == nullptr ? " Branch: --continue NAME=LOW:HIGH" : "");
    return text;
}

OrbitGuess orbit_guess(const std::string& json, const std::string& file, std::size_t dof) {
    const auto refuse = [&](const std::string& why) {
        return InputError(file, {}, why, "give a file written by achilles orbit --json or achilles simulate --json");
    };
    const Json root = Json::parse(json, nullptr, false);
    if (root.is_discarded() || !root.is_object()) throw refuse("this is not a JSON file of Achilles");
    const char* const key = root.contains("state") ? "state" : "end";
    if (!root.contains(key)) throw refuse("the file has no state to start from");
    const Json& at = root[key];
    const auto read = [&](const char* name) {
        if (!at.is_object() || !at.contains(name) || !at[name].is_array() || at[name].size() != dof)
            throw refuse(fmt::format("{}.{} must be an array of {} numbers, one for each coordinate", key, name, dof));
        Vector values(static_cast<Eigen::Index>(dof));
        for (std::size_t i = 0; i < dof; ++i) {
            if (!at[name][i].is_number()) throw refuse(fmt::format("{}.{} must contain only numbers", key, name));
            values[static_cast<Eigen::Index>(i)] = at[name][i].template get<double>();
        }
        return values;
    };
    OrbitGuess guess;
    guess.state = {read("q"), read("v"), 0.0};
    if (at.contains("t") && at["t"].is_number()) guess.state.t = at["t"].get<double>();
    if (root.contains("period") && root["period"].is_number()) guess.period = root["period"].get<double>();
    return guess;
}

}  // namespace achilles
