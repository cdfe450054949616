#include "cli/sweep_work.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <stdexcept>

#include "cli/sweep_output.hpp"
#include "cli/terminal.hpp"
#include "model/read_system.hpp"
#include "output/output.hpp"

namespace achilles {

void RunFailures::add(std::uint8_t code, FailureCount more) {
    FailureCount& kind = kinds_[code];
    kind.count += more.count;
    kind.first = std::min(kind.first, more.first);
}

void RunFailures::note(const Rows& rows) {
    for (std::size_t i = 0; i < rows.count(); ++i) {
        const bool is_next_row = i > 0 && rows.points[i] == rows.points[i - 1];
        if (is_next_row || rows.ends[i] == RunEnd(Outcome::Kind::end_time)) continue;
        add(rows.ends[i].code(), {1, rows.points[i]});
    }
}

std::string RunFailures::append_to(std::string bytes) const {
    for (const auto& [code, kind] : kinds_) {
        bytes.append(reinterpret_cast<const char*>(&kind), sizeof kind);
        bytes += static_cast<char>(code);
    }
    return bytes + static_cast<char>(kinds_.size());
}

std::string RunFailures::take(std::string bytes) {
    const auto count = static_cast<std::size_t>(static_cast<unsigned char>(bytes.back()));
    bytes.pop_back();
    for (std::size_t i = 0; i < count; ++i) {
        FailureCount kind;
        const auto code = static_cast<std::uint8_t>(bytes.back());
        bytes.pop_back();
        std::memcpy(&kind, bytes.data() + bytes.size() - sizeof kind, sizeof kind);
        bytes.resize(bytes.size() - sizeof kind);
        add(code, kind);
    }
    return bytes;
}

void RunFailures::tell(const SweepTable& table) const {
    const SweepPoints points(table.sweep(), table.model().description());
    for (const auto& [code, kind] : kinds_) {
        std::string where, why;
        for (std::size_t axis = 0; axis < table.sweep().axes.size(); ++axis)
            where += fmt::format("{}{} = {}", axis == 0 ? "; first at " : ", ", table.sweep().axes[axis].name,
                                 table.sweep().value(axis, kind.first));
        try {
            table.model().check(points.run(kind.first));
        } catch (const InputError& error) {
            why = ": " + error.message;
        }
        const std::string_view outcome = RunEnd::from(code).text();
        print_clean(stderr, "achilles: warning: {} of the runs: {}{}{}\n", kind.count, outcome, where, why);
    }
}

std::string sweep_chunk(const SweepTable& table, RowStorage storage, Chunk chunk) {
    const Rows rows = table.rows(chunk.first, chunk.count);
    RunFailures failures;
    failures.note(rows);
    SweepSummary summary(table);
    summary.note(rows);
    return summary.append_to(failures.append_to(serialize_rows(table, storage, rows)));
}

// Header lines, then the text of the system file.
std::string sweep_order(const SweepTable& table, RowStorage storage, int threads) {
    const SystemDescription& description = table.model().description();
    return fmt::format("{}\n{:d} {:d} {:d} {}\n{}\n{}", version(), storage.text, storage.rows, storage.in_log, threads,
                       to_text(table.sweep(), description), description.source_text);
}

RankTask sweep_share(std::string_view order) {
    const auto take_line = [&] {
        const std::size_t end = order.find('\n');
        const std::string line(order.substr(0, end));
        order.remove_prefix(end == order.npos ? order.size() : end + 1);
        return line;
    };
    if (const std::string other = take_line(); other != version())
        throw std::runtime_error(
            fmt::format("this process runs Achilles {}, but rank 0 runs {}", version(), printable(other)));
    RowStorage storage;
    int text = 0, rows = 0, in_log = 0, threads = 0;
    std::sscanf(take_line().c_str(), "%d %d %d %d", &text, &rows, &in_log, &threads);
    storage = {text != 0, rows != 0, in_log != 0};
    const std::string sweep = take_line();
    const SystemDescription description = parse_system(std::string(order), "the system file sent by MPI rank 0");
    const auto table =
        std::make_shared<const SweepTable>(std::make_shared<const Model>(description), read_sweep(sweep, description));
    return {threads, [table, storage](Chunk chunk) { return sweep_chunk(*table, storage, chunk); }};
}

void help_with_sweep(Messages& messages) {
    // Rank 0 also receives the signal and releases this process. If rank 0 is gone, this process ends soon by itself.
    struct sigaction action {};
    static std::atomic<bool> asked_to_stop{false};
    action.sa_handler = [](int) {
        asked_to_stop = true;
        ::alarm(5);
    };
    for (const int signal : {SIGINT, SIGTERM}) ::sigaction(signal, &action, nullptr);
    help_with_chunks(messages, sweep_share);
    if (asked_to_stop) messages.leave();
}

}  // namespace achilles
