// What a sweep is made of, chunk by chunk, in whichever process: this one, or one that was told so by an order.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "cli/sweep_output.hpp"
#include "study/ranks.hpp"

namespace achilles {

// Runs that are points with another outcome than the end time: so many of each, and the first.
class RunFailures {
 public:
    void note(const Rows& rows);
    // As bytes behind others, and taken away from there again: added to these.
    std::string behind(std::string bytes) const;
    std::string take(std::string bytes);
    // Says them on standard error.
    void tell(const SweepTable& table) const;

 private:
    struct Kind {
        std::uint64_t count = 0, first = most_points;
    };
    void add(std::uint8_t code, Kind more);
    std::map<std::uint8_t, Kind> kinds_;
};

// The bytes of a chunk: what is kept of its rows, behind them their failures and their summary.
std::string sweep_chunk(const SweepTable& table, SweepKept kept, Chunk chunk);

// What other processes are told of a sweep: neither files nor options of theirs are asked.
std::string sweep_order(const SweepTable& table, SweepKept kept, int threads);
// What they do then. Throws where the order is of another version of the program.
Share sweep_share(std::string_view order);

// All that a process does whom rank 0 tells what to do. It ends with rank 0, which alone hears Ctrl-C.
void help_with_sweep(Messages& messages);

}  // namespace achilles
