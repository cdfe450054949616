#include "session/orbit_job.hpp"

#include <algorithm>
#include <utility>

namespace achilles {

std::size_t FoundOrbit::first() const {
    for (std::size_t i = 0; i < count(); ++i)
        if (point(i).parameters == answer.orbit->parameters) return i;
    return 0;
}

Run run_on(const OrbitPoint& point, Run run) {
    const double length = std::max(run.options.end_time - run.options.start_time, point.period);
    run.parameters = point.parameters;
    run.q = point.flight.q;
    run.v = point.flight.v;
    // A drive has a clock; without one the run begins when it did.
    if (!point.has_flow) run.options.start_time = point.flight.t;
    run.options.end_time = run.options.start_time + length;
    return run;
}

void OrbitJob::begin(const std::shared_ptr<const Model>& model, const std::string& text, const Run& base,
                     OrbitQuestion question) {
    drop();
    start([model, text, base, question = std::move(question)](OrbitWatch& watch) {
        FoundOrbit found{text, base, {}};
        try {
            found.answer = answer_to(question, model, &watch);
        } catch (const InputError& problem) {  // of a start that was tried
            found.answer.why = problem.message;
        }
        return found;
    });
}

}  // namespace achilles
