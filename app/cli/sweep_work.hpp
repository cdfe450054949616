// The computation of one chunk of a sweep, in this process or in another one that received an order for it.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "analysis/distributed_chunks.hpp"
#include "cli/sweep_output.hpp"

namespace achilles {

// Counts runs whose outcome is not the end time, by outcome, with the first point of each.
class RunFailures {
 public:
    void note(const Rows& rows);
    // append_to() appends the counts to `bytes`. take() adds the counts at the end of `bytes` to these and returns the
    // rest.
    std::string append_to(std::string bytes) const;
    std::string take(std::string bytes);
    // Prints them to standard error.
    void tell(const SweepTable& table) const;

 private:
    struct FailureCount {
        std::uint64_t count = 0, first = max_sweep_points;
    };
    void add(std::uint8_t code, FailureCount more);
    std::map<std::uint8_t, FailureCount> kinds_;
};

// The bytes of a chunk: the stored form of its rows, then its failures and its summary.
std::string sweep_chunk(const SweepTable& table, RowStorage storage, Chunk chunk);

// The description of a sweep for other processes, which use no files or options of their own.
std::string sweep_order(const SweepTable& table, RowStorage storage, int threads);
// The work that an order describes. Throws if the order is from another version of the program.
RankTask sweep_share(std::string_view order);

// Main function of all ranks except 0: performs the orders of rank 0 until it ends. Only rank 0 handles Ctrl-C.
void help_with_sweep(Messages& messages);

}  // namespace achilles
