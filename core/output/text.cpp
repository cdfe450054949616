// A trajectory as text, for golden tests.
#include <fmt/format.h>

#include "output/contacts.hpp"
#include "output/output.hpp"

namespace achilles {

namespace {

std::string to_text(const Vector& x) {
    std::string text = "(";
    // Adding 0.0 turns -0 into 0: their difference is not one that a golden should see.
    for (Eigen::Index i = 0; i < x.size(); ++i) text += fmt::format("{}{:.9g}", i == 0 ? "" : ", ", x[i] + 0.0);
    return text + ")";
}

// " of knee held wall", where there are several contacts.
std::string contacts(const Trajectory& trajectory, const char* what, ContactSet contacts) {
    const Model& model = *trajectory.model;
    if (model.contacts() == 1 || contacts.empty()) return "";
    return fmt::format(" {} {}", what, joined_names(model, contacts, "+"));
}

}  // namespace

std::string to_text(const Trajectory& trajectory) {
    std::string text;
    for (const Phase& phase : trajectory.phases)
        text += fmt::format("phase {}{} [{:.9g}, {:.9g}] impacts {}\n", to_text(phase.kind),
                            contacts(trajectory, "held", phase.held), phase.start, phase.end, phase.impacts);
    for (const Event& event : trajectory.events)
        text += fmt::format("{}{}{}{} t {:.9g} q {} before {} after {}\n", to_text(event.kind),
                            contacts(trajectory, "of", event.contacts), contacts(trajectory, "opens", event.opened),
                            contacts(trajectory, "held", event.held), event.t, to_text(event.q),
                            to_text(event.v_before), to_text(event.v_after));
    return text + fmt::format("end t {:.9g} {}{} q {} v {}\noutcome {}: {}\n", trajectory.end_time,
                              to_text(trajectory.end_phase), contacts(trajectory, "held", trajectory.end_held),
                              to_text(trajectory.end.q), to_text(trajectory.end.v), to_text(trajectory.outcome.kind),
                              trajectory.outcome.message);
}

}  // namespace achilles
