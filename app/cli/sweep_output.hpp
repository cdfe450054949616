// Where the table of a sweep goes.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "cli/sweep_pictures.hpp"
#include "cli/write_files.hpp"
#include "output/sweep_files.hpp"

namespace achilles {

struct SweepOutputAsked {
    std::string csv, hdf5;  // files; csv: or -, standard output
    bool units = false, resume = false;
};

// What is kept of rows until the files are made of it, or printed: their text, themselves; in a log both, told apart.
struct SweepKept {
    bool text = false, rows = false, in_log = false;
};
// Asked of several threads at once.
std::string kept_bytes(const SweepTable& table, SweepKept kept, const Rows& rows);

// Files that are there when the sweep is done. Until then it is kept in a log, F.part of the first file F, which is gone on with
// where it ends. A table for standard output or a device alone is written as it is made, and kept nowhere.
class SweepOutput {
 public:
    // Looks whether the files can be written; nothing is computed before. Throws InputError. Refers to the pictures.
    SweepOutput(const SweepTable& table, const SweepOutputAsked& asked, const SweepPictures& pictures,
                const std::filesystem::path& system_file, const std::string& system_name);
    ~SweepOutput();
    SweepOutput(const SweepOutput&) = delete;
    SweepOutput& operator=(const SweepOutput&) = delete;

    // So many points are there already.
    std::uint64_t done() const { return log_ ? log_->done() : printed_; }
    SweepKept kept() const { return {!csv_.empty(), keeps_rows(), log_ != nullptr}; }
    // Takes what is kept of rows, in the order of the points. Throws std::system_error.
    void append(Chunk chunk, const std::string& bytes);
    // Makes the files. False where a picture would be empty: it is not made then, and the others are. Throws
    // std::runtime_error; the log stays then.
    bool finish();
    // Those that finish() has made.
    const std::vector<std::string>& files() const { return made_; }
    // The end of a message, if runs are kept: ": the same command with --resume continues from F.part", or once all runs are
    // done "; the runs are kept in F.part: ...". Empty otherwise.
    std::string how_to_continue();

 private:
    SweepKey key() const;
    bool keeps_rows() const { return !hdf5_.empty() || !pictures_.files().empty(); }
    bool draw(const EachRows& each_rows);
    std::string name_of_csv() const;
    void write_csv(const std::string& file) const;
    void make(const std::string& path, const std::function<void(const std::string& file)>& write) const;

    const SweepTable& table_;
    const SweepPictures& pictures_;
    std::string csv_, hdf5_, log_path_;
    bool units_;
    SweepOrigin origin_;
    OutputFiles files_;  // whether they can be written
    std::vector<std::string> made_;
    std::unique_ptr<SweepLog> log_;
    int stream_ = -1;  // where there is no log
    std::uint64_t printed_ = 0;
};

}  // namespace achilles
