// A proof of the present run.
#include <fmt/format.h>

#include <new>

#include "session/refusal.hpp"
#include "session/session.hpp"

namespace achilles {

const Proof* Session::proof() const {
    const Proof* const proof = proof_job_->proof().get();
    const bool is_its = proof != nullptr && proof_job_->model() == trajectory().model && !shows_start() &&
                        same_to_a_proof(proof->claim.run, trajectory().run);
    return is_its ? proof : nullptr;
}

const ProofWatch* Session::proof_under_way() const { return proof_job_->under_way(); }

std::optional<command::Prove> Session::proof_command() const {
    if (proof_asked_) return prove_command(proof_asked_->spread);
    return proof() == nullptr ? std::nullopt : std::optional(prove_command(proof()->spread));
}

void Session::perform(const command::Prove& command) {
    Spread spread;
    spread.width = command.width;
    for (const std::string& interval : command.intervals) {
        const auto side = read_side(interval, description());
        if (!side)
            throw refusal(fmt::format("'{}' is not an interval", interval), std::string(command::Prove::said.usage));
        const double present = *value(side->name);
        if (!(side->low <= present && present <= side->high))
            throw refusal(fmt::format("{} = {} in the present run is not in [{}, {}]", side->name, present, side->low,
                                      side->high));
        spread.sides.push_back(*side);
    }
    check(*system_->model, claim_of(description(), asked_, spread));
    proof_job_->forget();
    proof_asked_ = AskedProof{system_, asked_, spread};
    follow_proof(patience_);
    compose_pinned();
}

void Session::perform(const command::StopProof&) {
    proof_asked_.reset();
    proof_job_->forget();
    compose_pinned();
}

// What was asked of another run is not to be proved any more; of a run that is there it begins. Throws InputError for a system
// that no proof covers.
void Session::follow_proof(Patience patience) {
    if (proof_asked_ && (proof_asked_->system != system_ || !same_to_a_proof(proof_asked_->run, asked_))) {
        proof_asked_.reset();
        proof_job_->stop();
    }
    try {
        if (proof_asked_ && watch_ == nullptr && proof_job_->under_way() == nullptr)
            proof_job_->begin(system_->model, proof_asked_->spread, claim_to_draw(trajectory(), proof_asked_->spread));
        if (!proof_job_->update(patience)) return;
        proof_asked_.reset();
        compose_pinned();
    } catch (const InputError&) {
        proof_asked_.reset();
        throw;
    } catch (const std::bad_alloc&) {
        proof_asked_.reset();
        throw refusal("there is not enough memory for a proof of this run");
    }
}

void Session::receive_proof(Patience patience) {
    try {
        follow_proof(patience);
    } catch (const InputError& problem) {
        error_ = problem.what();
    }
}

}  // namespace achilles
