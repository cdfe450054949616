// The processes that mpirun or srun has started as one program.
#pragma once

#include <memory>
#include <optional>

#include "study/ranks.hpp"

struct AchillesMpi;

namespace achilles {

// How many there are, and which this one is, by what is in the environment.
struct Launch {
    int rank = 0;
    int size = 0;         // 0: not told
    bool has_mpi = true;  // whether it told them how to reach one another
};
// Nothing where this process is alone, or where ACHILLES_MPI=0 says that it is to do as if it was.
std::optional<Launch> find_launch();

// The ranks of a launch, by MPI; it ends with this object, and rank 0 dismisses the others before.
class Ranks final : public Messages {
 public:
    // Waits for all. Throws InputError where they cannot be reached.
    explicit Ranks(const Launch& launch);
    ~Ranks() override;
    Ranks(const Ranks&) = delete;
    Ranks& operator=(const Ranks&) = delete;

    int rank() const override { return rank_; }
    int size() const override { return size_; }
    int cores() const override { return cores_; }
    void send(int to, std::string_view bytes) override;
    std::optional<Letter> receive() override;
    void leave() override { is_left_ = true; }

 private:
    const AchillesMpi* mpi_;
    int rank_ = 0, size_ = 1, cores_ = 1;
    bool is_left_ = false;
};

}  // namespace achilles
