#include "session/copied_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "figure/label.hpp"
#include "number/angle.hpp"
#include "output/contacts.hpp"
#include "output/output.hpp"
#include "session/study_jobs.hpp"
#include "system/units.hpp"

namespace achilles {

namespace {

// Factor for gap rates of angles: degrees per second, like the other rates.
double speed_factor(const Session& session, const Event& event) {
    const std::vector<std::string> rates = output_names(session.description(), "gap'");
    std::size_t first = 0;
    while (first + 1 < rates.size() && !event.contacts.contains(first)) ++first;
    return shown_unit(unit_of_expression(session.description(), rates[first])).factor;
}

std::string plot_table(const Session& session, const Plot& plot) {
    std::string text;
    for (const auto& quantity : plot.prepared->quantities())
        text += fmt::format("{}{}{}", text.empty() ? "" : "\t", quantity.text,
                            quantity.unit.empty() ? "" : fmt::format(" [{}]", quantity.unit));
    text += '\n';
    for (const Sample& sample : session.samples()) {
        const std::vector<double> values = values_at(session.trajectory(), sample, *plot.prepared);
        text += fmt::format("{}\n", fmt::join(values, "\t"));
    }
    return text;
}

}  // namespace

std::string events_table(const Session& session) {
    const auto& coordinates = session.description().coordinates;
    const bool several = session.model()->contacts() > 1, is_proved = session.shown_proof() != nullptr;
    std::string text = several ? "#\tevent\tcontacts\topened\theld\tt\timpact speed" : "#\tevent\tt\timpact speed";
    for (const char* prime : {"", "'"})
        for (const CoordinateDescription& coordinate : coordinates) text += "\t" + coordinate.name + prime;
    text += "\tenergy lost\tsentence";
    if (is_proved) text += "\tt proved from\tt proved to";
    const auto& events = session.trajectory().events;
    for (std::size_t i = 0; i < events.size(); ++i) {
        if (session.selected() > 0 && i + 1 != static_cast<std::size_t>(session.selected())) continue;
        const Event& event = events[i];
        text += fmt::format("\n{}\t{}", i + 1, names_of(event).name);
        for (const ContactSet& set : {event.contacts, event.opened, event.mode.held()})
            if (several) text += "\t" + joined_names(*session.model(), set, "+");
        text +=
            fmt::format("\t{}\t{}", event.t,
                        event.is_impact() ? fmt::format("{}", event.impact_speed * speed_factor(session, event)) : "");
        for (const Vector* const values : {&event.q, &event.v_after})
            for (std::size_t k = 0; k < coordinates.size(); ++k)
                text += fmt::format("\t{}", (*values)[static_cast<Eigen::Index>(k)] *
                                                (coordinates[k].unit == "rad" ? degrees(1.0) : 1.0));
        text += fmt::format("\t{}\t{}", energy_lost(session.trajectory(), i), session.sentences().of(i));
        const EnclosedEvent* const enclosed = session.enclosed(i);
        if (is_proved) text += enclosed ? fmt::format("\t{}\t{}", enclosed->t.lo(), enclosed->t.hi()) : "\t\t";
    }
    return text + "\n";
}

std::string plots_table(const Session& session, int number) {
    const Plots plots = number == 0 ? session.plotted() : session.plotted().only(number);
    std::string text;
    for (const Plot& plot : plots.list()) text += (text.empty() ? "" : "\n") + plot_table(session, plot);
    return text;
}

}  // namespace achilles
