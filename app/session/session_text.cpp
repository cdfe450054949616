#include <fmt/format.h>

#include "model/model.hpp"
#include "output/output.hpp"
#include "output/proof.hpp"
#include "session/orbit_job.hpp"
#include "session/session.hpp"

namespace achilles {

namespace {

// "zeno_time(1) = 2.7, by g -0.4, ...", as far as it is known of the present run.
std::string to_text(const Influences& known) {
    std::string text = fmt::format("{} = {:.9g}", known.quantity.expression, known.quantity.value);
    for (const Influences::Of& by : known.all)
        text += by.reason.empty() ? fmt::format(", by {} {:.6g}", by.name, by.derivative)
                                  : fmt::format(", by {} none: {}", by.name, by.reason);
    return text + "\n";
}

// "orbit --from start: period 3.5, 17 points, on point 3"
std::string to_text(const FoundOrbit& found, std::optional<std::size_t> on) {
    const auto& orbit = found.answer.orbit;
    if (!orbit) return fmt::format("orbit {}: none, {}\n", found.text, found.answer.why);
    return fmt::format("orbit {}: period {:.9g}, {} points{}\n", found.text, orbit->period, found.count(),
                       on ? fmt::format(", on point {}", *on + 1) : "");
}

}  // namespace

std::string to_text(const Session& session) {
    std::string text = fmt::format("system {}\n", session.system());
    const SystemDescription& description = session.description();
    const Run& run = session.run();
    for (std::size_t i = 0; i < description.parameters.size(); ++i)
        text += fmt::format("{} = {:.9g}\n", description.parameters[i].name, run.parameters[i]);
    for (std::size_t i = 0; i < description.coordinates.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        text += fmt::format("{0} = {1:.9g}, {0}' = {2:.9g}\n", description.coordinates[i].name, run.q[at], run.v[at]);
    }
    text += fmt::format("time {:.9g}{}, event {}\n", session.time(), session.playing() ? " playing" : "",
                        session.selected());
    for (const PinnedRun& pinned : session.pinned())
        text += fmt::format("pinned {}{}: {}\n", pinned.place, pinned.shown ? "" : " (hidden)",
                            pinned.name.empty() ? "the same" : pinned.name);
    if (const Proof* proof = session.proof())
        text += fmt::format("{}: {} until {}\n", to_text(*session.proof_command()),
                            to_text(proof->enclosure.outcome.kind), reach_text(proof->enclosure, 9));
    if (session.orbit() != nullptr) text += to_text(*session.orbit(), session.orbit_point());
    if (session.influences_are_current()) text += to_text(*session.influences());
    text += to_text(session.plotted()) + to_text(session.scene());
    if (session.theme().dark) text += "theme dark\n";
    if (const auto horizon = session.horizon()) text += fmt::format("trusted until {:.9g}\n", *horizon);
    if (!session.error().empty()) text += "error " + session.error() + "\n";
    if (session.document().is_changed()) text += "the text is not saved\n";
    for (const InputError& problem : session.document().problems) text += fmt::format("problem {}\n", problem.what());
    return text + to_text(session.trajectory());
}

}  // namespace achilles
