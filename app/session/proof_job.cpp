#include "session/proof_job.hpp"

#include <utility>

namespace achilles {

void ProofJob::begin(const std::shared_ptr<const Model>& model, const Spread& spread, const Claim& claim) {
    model_ = model;
    proof_.reset();
    const auto watch = std::make_shared<ProofWatch>();
    watch->time = claim.run.options.start_time;
    watch_ = watch;
    worker_.start([model, spread, claim, watch](const std::stop_token& stop) {
        watch->stop = stop;
        return std::make_shared<const Proof>(Proof{spread, claim, prove(model, claim, watch.get())});
    });
}

void ProofJob::stop() {
    if (watch_ == nullptr) return;
    watch_.reset();
    worker_.start([](const std::stop_token&) { return std::shared_ptr<const Proof>(); });
}

void ProofJob::forget() {
    stop();
    proof_.reset();
}

bool ProofJob::update(Patience patience) {
    if (watch_ == nullptr) return false;
    try {
        const auto made = worker_.take(patience);
        if (!made) return false;
        proof_ = *made;
    } catch (...) {
        watch_.reset();
        throw;
    }
    watch_.reset();
    return true;
}

command::Prove prove_command(const Spread& spread) {
    command::Prove command{spread.width, {}};
    for (const Spread::Side& side : spread.sides) command.intervals.push_back(to_text(side));
    return command;
}

bool same_to_a_proof(const Run& a, const Run& b) {
    const Options &x = a.options, &y = b.options;
    return a.q == b.q && a.v == b.v && a.parameters == b.parameters && x.start_time == y.start_time &&
           x.end_time == y.end_time && x.max_steps == y.max_steps && x.max_impacts == y.max_impacts;
}

}  // namespace achilles
