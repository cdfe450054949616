// A proof as JSON and as text.
#include "output/proof.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "model/model.hpp"
#include "output/output.hpp"

namespace achilles {

namespace {

using Json = nlohmann::ordered_json;

Json number(double x) { return std::isfinite(x) ? Json(x + 0.0) : Json(nullptr); }

// The ends are doubles, and print in the shortest form that reads back the same ones.
Json interval(const Interval& x) { return {number(x.lo()), number(x.hi())}; }

Json box(const Intervals& all) {
    Json result = Json::array();
    for (const Interval& x : all) result.push_back(interval(x));
    return result;
}

Json state(const EnclosedState& there) { return {{"t", number(there.t)}, {"q", box(there.q)}, {"v", box(there.v)}}; }

// A number and how far at most the truth is from it, to two digits: both ends are inside.
std::string about(const Interval& x) {
    const double centre = mid(x);
    if (x.lo() == x.hi() && width(as_written(centre)) == 0.0) return fmt::format("{}", centre + 0.0);
    const double radius = std::max(x.hi() - centre, centre - x.lo()) * (1.0 + 0x1p-50) + 0x1p-52 * std::abs(centre);
    double shown = radius;
    for (int ulps = 0; std::stod(fmt::format("{:.1e}", shown)) < radius && ulps < 3; ++ulps) shown *= 1.05;
    return fmt::format("{} +- {:.1e}", centre + 0.0, shown);
}

std::string list(const std::vector<std::string>& names, const Intervals& all) {
    std::string result;
    for (std::size_t i = 0; i < names.size(); ++i)
        result += fmt::format("{}{} = {}", i > 0 ? ", " : "", names[i], about(all[i]));
    return result;
}

}  // namespace

std::string_view to_text(Enclosure::Outcome::Kind kind) {
    switch (kind) {
        case Enclosure::Outcome::Kind::end_time:
            return "end time";
        case Enclosure::Outcome::Kind::undecided:
            return "undecided";
        case Enclosure::Outcome::Kind::cancelled:
            return "cancelled";
    }
    return "";
}

std::string to_json(const Model& model, const Claim& claim, const Enclosure& proof) {
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
        Json entry = {{"kind", to_text(event.kind)},
                      {"t", interval(event.t)},
                      {"contact", description.constraints[event.contact].name},
                      {"held", names(event.held)},
                      {"opened", names(event.opened)},
                      {"q", box(event.q)}};
        if (event.kind == Event::Kind::impact) {
            entry["v_before"] = box(event.v_before);
            entry["v_after"] = box(event.v_after);
        } else {
            entry["v"] = box(event.v_after);
        }
        if (event.kind == Event::Kind::zeno) entry["impacts"] = event.impacts;
        events.push_back(entry);
    }
    for (const EnclosedState& sample : proof.samples) samples.push_back(state(sample));
    Json result = {{"achilles", version()},
                   {"system", {{"title", description.title}, {"coordinates", coordinates}}},
                   {"claim",
                    {{"start_time", number(claim.run.options.start_time)},
                     {"end_time", number(claim.run.options.end_time)},
                     {"q", box(claim.q)},
                     {"v", box(claim.v)},
                     {"parameters", parameters}}},
                   {"proved_until", number(proof.proved_until)},
                   {"events", events},
                   {"events_differ", proof.events_differ},
                   {"end", proof.end ? state(*proof.end) : Json(nullptr)}};
    if (!claim.times.empty()) result["samples"] = samples;
    result["outcome"] = {{"kind", to_text(proof.outcome.kind)}, {"message", proof.outcome.message}};
    result["statistics"] = {{"steps", proof.statistics.steps}, {"impacts", proof.statistics.impacts}};
    result["assumptions"] = proof.assumptions;
    return result.dump(1) + "\n";
}

std::string proof_text(const Model& model, const Claim& claim, const Enclosure& proof) {
    const SystemDescription& description = model.description();
    std::vector<std::string> names, rates, parameters;
    for (const auto& coordinate : description.coordinates) {
        names.push_back(coordinate.name);
        rates.push_back(coordinate.name + "'");
    }
    for (const auto& parameter : description.parameters) parameters.push_back(parameter.name);
    std::string text = fmt::format("{}\n\nFor every start in\n  {}\n  {}\n", description.title, list(names, claim.q),
                                   list(rates, claim.v));
    if (!parameters.empty()) text += fmt::format("and all parameters in\n  {}\n", list(parameters, claim.parameters));
    const bool whole = proof.end.has_value();
    text += fmt::format("the completed execution {} t = {}:\n\n", whole ? "is proved until" : "is proved only until",
                        proof.proved_until);
    int impacts = 0;
    const auto tell_impacts = [&] {
        if (impacts > 1) text += fmt::format("  {:<8} {} more\n", "impacts", impacts - 1);
        impacts = 0;
    };
    for (const EnclosedEvent& event : proof.events) {
        if (event.kind == Event::Kind::impact && impacts++ > 0) continue;
        if (event.kind != Event::Kind::impact) tell_impacts();
        const bool is_one_of_several = model.contacts() > 1;
        text += fmt::format("  {:<8} t = {}{}\n           {}\n", to_text(event.kind), about(event.t),
                            is_one_of_several ? ", " + description.constraints[event.contact].name : "",
                            list(names, event.q));
    }
    tell_impacts();
    if (proof.events_differ) text += "  (from here on the parts have different events)\n";
    if (whole)
        text += fmt::format("  {:<8} t = {}\n           {}\n           {}\n", "end", proof.end->t,
                            list(names, proof.end->q), list(rates, proof.end->v));
    for (const EnclosedState& sample : proof.samples)
        text += fmt::format("  {:<8} t = {}\n           {}\n           {}\n", "at", sample.t, list(names, sample.q),
                            list(rates, sample.v));
    if (!whole) text += fmt::format("\nUndecided from there: {}.\n", proof.outcome.message);
    return text + fmt::format("\nIt stands on {}.\n", proof.assumptions);
}

std::string short_text(const Interval& x) {
    const double centre = mid(x), half = std::max(x.hi() - centre, centre - x.lo());
    if (!std::isfinite(half)) return fmt::format("[{}, {}]", x.lo(), x.hi());
    if (half == 0.0) return fmt::format("{}", centre + 0.0);
    constexpr int most = 15;  // decimals, of which a double of a few seconds has no more
    const int decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(half))), 0, most);
    const std::string text = fmt::format("{:.{}f}", centre, decimals);
    const long double shown = std::stold(text), off = std::max(x.hi() - shown, shown - x.lo()),
                      rounding = 0x1p-60L * (std::abs(shown) + off);
    return fmt::format("{}({})", text, std::ceil((off + rounding) * std::pow(10.0L, decimals)));
}

std::vector<const EnclosedEvent*> enclosed_events(const Trajectory& run, const Enclosure& proof) {
    std::vector<const EnclosedEvent*> result(run.events.size(), nullptr);
    for (std::size_t contact = 0; contact < run.model->contacts(); ++contact) {
        auto enclosed = proof.events.begin();
        const auto skip = [&](bool impacts) {  // to the next of this contact
            while (enclosed != proof.events.end() &&
                   (enclosed->contact != contact || (impacts && enclosed->kind == Event::Kind::impact)))
                ++enclosed;
            return enclosed != proof.events.end();
        };
        for (std::size_t i = 0; i < run.events.size(); ++i) {
            if (!run.events[i].contacts.contains(contact)) continue;
            const bool is_impact = run.events[i].kind == Event::Kind::impact;
            if (!skip(!is_impact)) break;
            if (enclosed->kind == run.events[i].kind)
                result[i] = &*enclosed++;
            else if (!is_impact)
                break;
        }
    }
    return result;
}

}  // namespace achilles
