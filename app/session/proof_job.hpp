// A proof of a whole run on a thread of its own, which takes longer than the run.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "figure/proof.hpp"
#include "session/command.hpp"
#include "session/worker.hpp"

namespace achilles {

class ProofJob {
 public:
    // Of a run of this model. What is under way is given up.
    void begin(const std::shared_ptr<const Model>& model, const Spread& spread, const Claim& claim);
    // Gives up what is under way; what is there stays.
    void stop();
    void forget();
    // Takes in what is ready: true where that is a proof. Throws InputError for a system that no proof covers.
    bool update(Patience patience);
    // Called on another thread when update() would take something in.
    void on_ready(std::function<void()> ready) { worker_.on_ready(std::move(ready)); }

    // How far what is under way has come; null: nothing is.
    const ProofWatch* under_way() const { return watch_.get(); }
    // The last that was made, and of which model; null: none.
    const std::shared_ptr<const Proof>& proof() const { return proof_; }
    const std::shared_ptr<const Model>& model() const { return model_; }

 private:
    std::shared_ptr<const Model> model_;
    std::shared_ptr<ProofWatch> watch_;
    std::shared_ptr<const Proof> proof_;
    Worker<std::shared_ptr<const Proof>> worker_;
};

// What a person writes for it.
command::Prove prove_command(const Spread& spread);

// Of two runs of a model whether what is proved of one is proved of the other: how they are computed means nothing to it.
bool same_to_a_proof(const Run& a, const Run& b);

}  // namespace achilles
