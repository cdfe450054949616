// Output of a sweep: table files, pictures and the summary.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/table.hpp"
#include "cli/write_files.hpp"
#include "figure/sweep_figure.hpp"
#include "output/sweep_files.hpp"
#include "pictures/picture_format.hpp"

namespace achilles {

// The pictures of a sweep.
struct SweepPictureOptions {
    std::vector<std::string> files;  // .png, .svg or .pdf
    SweepLook look;
    PictureSize size;
    bool has_size = false;  // size in pixels was given
    PaperSize page;
};

class SweepPictures {
 public:
    // Checks that they can be drawn, and throws InputError if not, before the sweep starts. Keeps references to the
    // table and the job.
    SweepPictures(const SweepTable& table, const SweepPictureOptions& options, const PictureJob& job);

    const std::vector<std::string>& files() const { return options_.files; }
    // Draws all rows at the end. Holds at most max_drawn_rows rows: if there are more, uses every second, third, ...
    // row. Columns without values are left out. If no column has a value, returns nothing and prints a warning to
    // standard error. Throws std::runtime_error if drawing fails.
    std::optional<Figure> figure(const RowReader& each_rows) const;
    // The picture in the format of the file's extension. A height that was not given is at least what the panels need.
    std::string bytes(const Figure& figure, const std::string& file) const;

 private:
    void try_to_draw() const;
    bool has_height() const { return options_.page.width > 0.0 ? options_.page.height > 0.0 : options_.has_size; }
    PictureSize size_for(const Figure& figure, const std::string& format) const;
    const SweepTable& table_;
    SweepPictureOptions options_;
    const PictureJob& job_;
};

// Makes the one picture that `reproduce` wants, without writing files.
void reproduce_sweep(const SweepTable& table, const SweepPictureOptions& options, PictureJob& job, int threads);

struct SweepOutputOptions {
    std::string csv, hdf5;  // file names; csv may be -, standard output
    bool units = false, resume = false;
};

// How rows are stored until the output is written: as text, as binary data, or in a log as both, separately.
struct RowStorage {
    bool text = false, rows = false, in_log = false;
};
// The stored form of these rows. Thread-safe.
std::string serialize_rows(const SweepTable& table, RowStorage storage, const Rows& rows);

// Output files of a sweep. They are written when the sweep is finished. Until then, its rows are stored in a log. The
// name of the log is that of the first output file with .part added. --resume continues from the log. If the sweep
// writes only to standard output or to a device, there is no log, and rows are written while the sweep runs.
class SweepOutput {
 public:
    // Checks that the files can be written, before the sweep starts. Throws InputError. Keeps a reference to the
    // pictures.
    SweepOutput(const SweepTable& table, const SweepOutputOptions& options, const SweepPictures& pictures,
                const std::filesystem::path& system_file, const std::string& system_name);
    ~SweepOutput();
    SweepOutput(const SweepOutput&) = delete;
    SweepOutput& operator=(const SweepOutput&) = delete;

    // Number of points finished earlier.
    std::uint64_t done() const { return log_ ? log_->done() : printed_; }
    RowStorage storage() const { return {!csv_.empty(), keeps_rows(), log_ != nullptr}; }
    // Appends the stored form of a chunk. Chunks must come in the order of the points. Throws std::system_error.
    void append(Chunk chunk, const std::string& bytes);
    // Writes the files. Returns false if a picture would be empty; it is then left out and the others are written.
    // Throws std::runtime_error; the log is kept then.
    bool finish();
    // The files written by finish().
    const std::vector<std::string>& files() const { return written_files_; }
    // End of a message if rows are stored: ": the same command with --resume continues from F.part" or, if all runs are
    // done, "; the runs are kept in F.part: ...". Empty otherwise.
    std::string how_to_continue();

 private:
    SweepKey key() const;
    bool keeps_rows() const { return !hdf5_.empty() || !pictures_.files().empty(); }
    bool draw(const RowReader& each_rows);
    std::string name_of_csv() const;
    void write_csv(const std::string& file) const;
    void make(const std::string& path, const std::function<void(const std::string& file)>& write) const;

    const SweepTable& table_;
    const SweepPictures& pictures_;
    std::string csv_, hdf5_, log_path_;
    bool units_;
    SweepOrigin origin_;
    OutputFiles files_;  // tests whether the files can be written
    std::vector<std::string> written_files_;
    std::unique_ptr<SweepLog> log_;
    int stream_ = -1;  // used if there is no log
    std::uint64_t printed_ = 0;
};

// Summary of a sweep: how many runs reached their end, and the range of each quantity.

// Counts and ranges over rows, accumulated chunk by chunk in any process. For transport they are appended to a chunk's
// bytes.
class SweepSummary {
 public:
    explicit SweepSummary(const SweepTable& table) : table_(&table), columns_(table.measures().numbers()) {}

    void note(const Rows& rows);
    // append_to() appends the totals to `bytes`. take() adds the totals at the end of `bytes` to these and returns the
    // rest.
    std::string append_to(std::string bytes) const;
    std::string take(std::string bytes);

    // "Ball on a sine: 9 runs, all reached the end time", then a line per quantity: its range, and where it is
    // undefined.
    std::string text() const;
    // A sentence for each quantity that is undefined in every run.
    std::vector<std::string> undefined_everywhere() const;

 private:
    struct ColumnRange {
        std::uint64_t count = 0, missing = 0;
        std::uint64_t first = max_sweep_points, last = 0, first_missing = max_sweep_points, last_missing = 0;  // points
        double low = 0.0, high = 0.0;
    };
    struct Totals {
        std::uint64_t runs = 0, whole = 0, rows = 0, last_point = max_sweep_points;
    };
    static void add(ColumnRange& column, const ColumnRange& more);
    std::string where_missing(const ColumnRange& column) const;
    std::string name_of(std::size_t number) const;
    std::string unit_of(std::size_t number) const;
    const RunMeasures::Column& column_of(std::size_t number) const;

    const SweepTable* table_;
    Totals totals_;
    std::vector<ColumnRange> columns_;
};

}  // namespace achilles
