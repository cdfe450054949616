// The processes that mpirun or srun has started together.
#pragma once

#include <memory>
#include <optional>

#include "analysis/distributed_chunks.hpp"

struct AchillesMpi;

namespace achilles {

// Number of processes and rank of this one, from environment variables.
struct Launch {
    int rank = 0;
    int size = 0;         // 0: unknown
    bool has_mpi = true;  // whether the launcher provides a connection between the processes
};
// Empty if this process is alone, or if ACHILLES_MPI=0 makes it act as if it were.
std::optional<Launch> find_launch();

// The ranks of a launch, connected by MPI. The connection ends with this object; rank 0 must release the others before.
class Ranks final : public Messages {
 public:
    // Waits for all processes. Throws InputError if they cannot be reached.
    explicit Ranks(const Launch& launch);
    ~Ranks() override;
    Ranks(const Ranks&) = delete;
    Ranks& operator=(const Ranks&) = delete;

    int rank() const override { return rank_; }
    int size() const override { return size_; }
    int cores() const override { return cores_; }
    void send(int to, std::string_view bytes) override;
    std::optional<RankMessage> receive() override;
    void leave() override { is_left_ = true; }

 private:
    const AchillesMpi* mpi_;
    int rank_ = 0, size_ = 1, cores_ = 1;
    bool is_left_ = false;
};

}  // namespace achilles
