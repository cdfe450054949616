// Where the table of a sweep goes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/write_files.hpp"
#include "figure/sweep_figure.hpp"
#include "output/sweep_files.hpp"
#include "pictures/picture_format.hpp"
#include "study/table.hpp"

namespace achilles {

// The pictures of a sweep.
struct SweepPicturesAsked {
    std::vector<std::string> files;  // .png, .svg or .pdf
    SweepLook look;
    PictureSize size;
    bool has_size = false;  // that of pixels is given
    PaperSize page;
};

class SweepPictures {
 public:
    // Whether they can be drawn: throws InputError before anything is computed. Refers to the table and the job.
    SweepPictures(const SweepTable& table, const SweepPicturesAsked& asked, const PictureJob& job);

    const std::vector<std::string>& files() const { return asked_.files; }
    // Drawn from all rows at the end, of which it holds most_drawn_rows at most: of more, every second, third, ... one. Columns
    // without a value are left out; nothing where no column has one, which is said on standard error. Throws
    // std::runtime_error where it cannot be drawn.
    std::optional<Figure> figure(const EachRows& each_rows) const;
    // As the name of such a file says. A height that is not asked for is no less than what its panels need.
    std::string bytes(const Figure& figure, const std::string& file) const;

 private:
    void try_to_draw() const;
    bool has_height() const { return asked_.page.width > 0.0 ? asked_.page.height > 0.0 : asked_.has_size; }
    PictureSize size_for(const Figure& figure, const std::string& format) const;
    const SweepTable& table_;
    SweepPicturesAsked asked_;
    const PictureJob& job_;
};

// Makes the one picture that a job is asked for again, keeping no file.
void reproduce_sweep(const SweepTable& table, const SweepPicturesAsked& asked, PictureJob& job, int threads);

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

// What a sweep came to, in a few lines: how many runs reached their end, and the range of each quantity.

// Counts and ranges over rows, chunk by chunk, in whichever process: they travel as bytes behind those of a chunk.
class SweepSummary {
 public:
    explicit SweepSummary(const SweepTable& table) : table_(&table), columns_(table.measures().numbers()) {}

    void note(const Rows& rows);
    // As bytes behind others, and taken away from there again: added to these.
    std::string behind(std::string bytes) const;
    std::string take(std::string bytes);

    // "Ball on a sine: 9 runs, all reached the end time", and a line for each quantity: its range, and where it does not exist.
    std::string text() const;
    // A sentence for each quantity that exists in no run.
    std::vector<std::string> nowhere() const;

 private:
    struct Column {
        std::uint64_t count = 0, missing = 0;
        std::uint64_t first = most_points, last = 0, first_missing = most_points, last_missing = 0;  // points
        double low = 0.0, high = 0.0;
    };
    struct Totals {
        std::uint64_t runs = 0, whole = 0, rows = 0, last_point = most_points;
    };
    static void add(Column& column, const Column& more);
    std::string where_missing(const Column& column) const;
    std::string name_of(std::size_t number) const;
    std::string unit_of(std::size_t number) const;
    const RunMeasures::Column& column_of(std::size_t number) const;

    const SweepTable* table_;
    Totals totals_;
    std::vector<Column> columns_;
};

}  // namespace achilles
