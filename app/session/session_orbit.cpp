// A periodic run near the present one, and its branch.
#include <fmt/format.h>

#include "session/orbit_job.hpp"
#include "session/refusal.hpp"
#include "session/session.hpp"

namespace achilles {

namespace {

bool begin_alike(const Run& a, const Run& b) {
    return a.q == b.q && a.v == b.v && a.parameters == b.parameters && a.options.start_time == b.options.start_time;
}

}  // namespace

std::shared_ptr<const FoundOrbit> Session::orbit() const { return orbit_job_->found(); }

const OrbitWatch* Session::orbit_under_way() const { return orbit_job_->under_way(); }

void Session::receive_orbit(Patience patience) { orbit_job_->update(patience); }

void Session::perform(const command::FindOrbit& command) {
    try {
        orbit_job_->begin(system_->model, command.text, asked_,
                          make_orbit_question(read_orbit(command.text), asked_, system_->model));
    } catch (const InputError& problem) {
        throw refusal(problem.what(), std::string(command::FindOrbit::said.usage));
    }
    scene_.perform(command::Show{"orbit", true});
    receive_orbit(patience_);
}

void Session::perform(const command::StopOrbit&) { orbit_job_->forget(); }

void Session::perform(const command::GoOnOrbit& command) {
    const auto found = orbit();
    if (found == nullptr || found->count() == 0)
        throw refusal(orbit_under_way() != nullptr ? "the search for a periodic run is under way"
                                                   : "no periodic run has been found yet",
                      "orbit \"\" searches for one");
    if (command.point < 1 || static_cast<std::size_t>(command.point) > found->count())
        throw refusal(fmt::format("the branch has no point {}: its points are numbered from 1 to {}", command.point,
                                  found->count()));
    rerun(run_on(found->point(static_cast<std::size_t>(command.point) - 1), asked_));
}

std::optional<std::size_t> Session::orbit_point() const {
    const auto found = orbit();
    for (std::size_t i = 0; found != nullptr && i < found->count(); ++i)
        if (begin_alike(run_on(found->point(i), asked_), asked_)) return i;
    return std::nullopt;
}

std::optional<command::FindOrbit> Session::orbit_command() const {
    const auto found = orbit();
    if (found == nullptr) return std::nullopt;
    if (begin_alike(found->base, asked_)) return command::FindOrbit{found->text};
    if (!orbit_point()) return std::nullopt;
    AskedOrbit asked = read_orbit(found->text);
    asked.from = "start";
    return command::FindOrbit{to_text(asked)};
}

}  // namespace achilles
