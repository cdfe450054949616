#include "cli/sweep_output.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "analysis/chunks.hpp"
#include "cli/assets.hpp"
#include "cli/terminal.hpp"
#include "output/output.hpp"
#include "pictures/export.hpp"
#include "pictures/origin.hpp"
#include "pictures/picture_format.hpp"

namespace achilles {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const std::string& path, int problem) {
    throw std::system_error(problem, std::generic_category(), path);
}

// Writes to an open file.
void put(int file, std::string_view bytes, const std::string& path) {
    while (!bytes.empty()) {
        const ssize_t count = ::write(file, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail(path, errno);
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
}

// Opens a file or standard output, writes and closes it. Messages use `name`, as the user typed it.
void write_file(const std::string& path, const std::string& name, const std::function<void(int file)>& write) {
    const bool is_standard = path == "-";
    const int file = is_standard ? STDOUT_FILENO : ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0) fail(name, errno);
    try {
        write(file);
    } catch (...) {
        if (!is_standard) ::close(file);
        throw;
    }
    if (!is_standard && ::close(file) != 0) fail(name, errno);
}

// True for standard output and devices.
bool is_stream(const std::string& path) {
    std::error_code ignored;
    const fs::file_status there = fs::status(path, ignored);
    return path == "-" || (fs::exists(there) && !fs::is_regular_file(there));
}

// The text of a stored chunk, which has the length of the text (8 bytes), the rows as text, and the binary rows.
std::string_view text_in(std::string_view bytes) {
    std::uint64_t size = 0;
    std::memcpy(&size, bytes.data(), sizeof size);
    return bytes.substr(sizeof size, size);
}

// The binary rows of a stored chunk.
std::string_view rows_in(std::string_view bytes) { return bytes.substr(sizeof(std::uint64_t) + text_in(bytes).size()); }

}  // namespace

SweepOutput::SweepOutput(const SweepTable& table, const SweepOutputOptions& options, const SweepPictures& pictures,
                         const fs::path& system_file, const std::string& system_name)
    : table_(table), pictures_(pictures), csv_(options.csv), hdf5_(options.hdf5), units_(options.units) {
    if (csv_.empty() && !keeps_rows()) csv_ = "-";
    if (units_ && csv_.empty()) throw InputError("--units", {}, "this needs --csv F");
    if (hdf5_ == "-") throw InputError("--hdf5 -", {}, "HDF5 output needs a file", "write --hdf5 F");
    if (!hdf5_.empty()) {
        if (const std::string why = hdf5_unavailable_reason(); !why.empty())
            throw InputError("--hdf5", {}, why, "write --csv F");
        if (const std::string fault = hdf5_name_error(table); !fault.empty()) throw InputError("--hdf5", {}, fault);
    }
    const SystemDescription& description = table.model().description();
    const std::string name = is_system_path(system_name) ? system_file.filename().string() : system_name;
    origin_ = {"Achilles " + version(),
               "achilles sweep " + shell_word(name) + " " + to_text(table.sweep(), description),
               description.source_text};
    files_.protect_input(system_file);
    for (const std::string& file : {csv_, hdf5_})
        if (!file.empty()) files_.add(file);
    for (const std::string& file : pictures_.files()) files_.add(file);
    if (is_stream(hdf5_)) throw InputError("--hdf5 " + hdf5_, {}, "HDF5 output needs a file");
    log_path_ = csv_.empty() || is_stream(csv_) ? hdf5_ : csv_;
    if (log_path_.empty() && !pictures_.files().empty()) log_path_ = pictures_.files().front();
    if (log_path_.empty()) {
        if (options.resume) throw InputError("--resume", {}, "this needs a file: --csv F, --hdf5 F or --out F");
        stream_ = csv_ == "-" ? STDOUT_FILENO : open_in_place(csv_);
        if (stream_ < 0)
            throw InputError(csv_, {}, fmt::format("the file cannot be written: {}", std::strerror(errno)));
        put(stream_, sweep_csv_heading(table_, units_), name_of_csv());
        return;
    }
    log_path_ += ".part";
    files_.refuse_output(log_path_);
    files_.add(log_path_);
    log_ = std::make_unique<SweepLog>(log_path_, key(), options.resume, table.sweep().count());
}

SweepOutput::~SweepOutput() {
    if (stream_ > STDOUT_FILENO) ::close(stream_);
}

std::string SweepOutput::name_of_csv() const { return csv_ == "-" ? "standard output" : csv_; }

SweepKey SweepOutput::key() const {
    std::string files;
    if (!csv_.empty()) files += units_ ? "csv with units " : "csv ";
    if (!hdf5_.empty()) files += "hdf5 ";
    if (!pictures_.files().empty()) files += "pictures ";
    return {origin_.software, to_text(table_.sweep(), table_.model().description()), files, origin_.system};
}

std::string serialize_rows(const SweepTable& table, RowStorage storage, const Rows& rows) {
    const std::string text = storage.text ? sweep_csv(table, rows) : "";
    if (!storage.in_log) return text;
    const std::uint64_t size = text.size();
    std::string bytes(reinterpret_cast<const char*>(&size), sizeof size);
    bytes += text;
    if (storage.rows) bytes += to_bytes(rows);
    return bytes;
}

void SweepOutput::append(Chunk chunk, const std::string& bytes) {
    if (log_) return log_->append(chunk, bytes);
    put(stream_, bytes, name_of_csv());
    printed_ += chunk.count;
}

void SweepOutput::write_csv(const std::string& path) const {
    const std::string name = name_of_csv();
    write_file(path, name, [&](int file) {
        put(file, sweep_csv_heading(table_, units_), name);
        log_->each([&](Chunk, std::string_view bytes) { put(file, text_in(bytes), name); });
    });
}

// Writes under a fixed temporary name, so a leftover is overwritten. Flushes to disk before renaming, and keeps the
// mode of a replaced file.
void SweepOutput::make(const std::string& path, const std::function<void(const std::string&)>& write) const {
    if (is_stream(path)) return write(path);
    const fs::path target = fs::weakly_canonical(path);
    const std::string file = target.string() + ".part.new";
    try {
        write(file);
        const int written = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
        const int problem = written < 0 || ::fsync(written) != 0 ? errno : 0;
        if (written >= 0) ::close(written);
        if (problem != 0 && problem != EINVAL) fail(path, problem);
        std::error_code ignored;
        const fs::file_status there = fs::status(target, ignored);
        if (fs::exists(there)) fs::permissions(file, there.permissions(), ignored);
        fs::rename(file, target);
    } catch (const std::system_error&) {
        ::unlink(file.c_str());
        throw;
    }
}

bool SweepOutput::draw(const RowReader& each_rows) {
    if (pictures_.files().empty()) return true;
    const std::optional<Figure> figure = pictures_.figure(each_rows);
    if (!figure) return false;
    for (const std::string& picture : pictures_.files()) {
        const std::string bytes = pictures_.bytes(*figure, picture);
        make(picture,
             [&](const std::string& path) { write_file(path, picture, [&](int file) { put(file, bytes, picture); }); });
        written_files_.push_back(picture);
    }
    return true;
}

bool SweepOutput::finish() {
    if (!log_) return true;
    if (!csv_.empty()) make(csv_, [&](const std::string& file) { write_csv(file); });
    if (!csv_.empty() && csv_ != "-") written_files_.push_back(csv_);
    const RowReader each_rows = [&](const std::function<void(const Rows&)>& take) {
        log_->each([&](Chunk, std::string_view bytes) { take(rows_from(rows_in(bytes), table_)); });
    };
    if (!hdf5_.empty())
        make(hdf5_, [&](const std::string& file) {
            errno = 0;
            try {
                write_hdf5(file, table_, origin_, each_rows);
            } catch (const std::runtime_error&) {
                fail(hdf5_, errno == 0 ? EIO : errno);
            }
        });
    if (!hdf5_.empty()) written_files_.push_back(hdf5_);
    const bool is_drawn = draw(each_rows);
    log_->remove();
    return is_drawn;
}

std::string SweepOutput::how_to_continue() {
    if (!log_) return "";
    if (log_->done() == table_.sweep().count())
        return fmt::format("; the runs are kept in {}: the same command writes the files", log_path_);
    if (log_->done() > 0) return fmt::format(": the same command with --resume continues from {}", log_path_);
    log_->remove();  // it is empty
    return "";
}

void SweepSummary::note(const Rows& rows) {
    const std::size_t width = columns_.size();
    for (std::size_t row = 0; row < rows.count(); ++row) {
        const std::uint64_t point = rows.points[row];
        const bool has_moment = !table_->is_section() || std::isfinite(rows.times[row]);
        if (has_moment) ++totals_.rows;
        if (totals_.last_point != point) {
            ++totals_.runs;
            if (rows.ends[row] == RunEnd(Outcome::Kind::end_time)) ++totals_.whole;
            totals_.last_point = point;
        }
        for (std::size_t i = 0; i < width; ++i) {
            const double x = rows.numbers[row * width + i];
            ColumnRange one;
            if (std::isfinite(x))
                one.count = 1, one.first = one.last = point, one.low = one.high = x;
            else
                one.missing = 1, one.first_missing = one.last_missing = point;
            add(columns_[i], one);
        }
    }
}

void SweepSummary::add(ColumnRange& column, const ColumnRange& more) {
    if (more.count > 0) {
        column.low = column.count > 0 ? std::min(column.low, more.low) : more.low;
        column.high = column.count > 0 ? std::max(column.high, more.high) : more.high;
        column.first = std::min(column.first, more.first);
        column.last = std::max(column.last, more.last);
    }
    column.first_missing = std::min(column.first_missing, more.first_missing);
    column.last_missing = std::max(column.last_missing, more.last_missing);
    column.count += more.count;
    column.missing += more.missing;
}

std::string SweepSummary::append_to(std::string bytes) const {
    bytes.append(reinterpret_cast<const char*>(&totals_), sizeof totals_);
    if (!columns_.empty())
        bytes.append(reinterpret_cast<const char*>(columns_.data()), columns_.size() * sizeof(ColumnRange));
    return bytes;
}

std::string SweepSummary::take(std::string bytes) {
    std::vector<ColumnRange> columns(columns_.size());
    const std::size_t size = columns.size() * sizeof(ColumnRange);
    Totals totals;
    const char* const begin = bytes.data() + bytes.size() - size - sizeof totals;
    std::memcpy(&totals, begin, sizeof totals);
    if (size > 0) std::memcpy(columns.data(), begin + sizeof totals, size);
    totals_.runs += totals.runs;
    totals_.whole += totals.whole;
    totals_.rows += totals.rows;
    for (std::size_t i = 0; i < columns.size(); ++i) add(columns_[i], columns[i]);
    bytes.resize(bytes.size() - size - sizeof totals);
    return bytes;
}

const RunMeasures::Column& SweepSummary::column_of(std::size_t number) const {
    const auto& columns = table_->measures().columns();
    const auto is_number = [&](const RunMeasures::Column& column) {
        return column.kind == RunMeasures::Column::Kind::number && number-- == 0;
    };
    return *std::find_if(columns.begin(), columns.end(), is_number);
}

std::string SweepSummary::name_of(std::size_t number) const { return column_of(number).name; }

std::string SweepSummary::unit_of(std::size_t number) const {
    const std::string& unit = column_of(number).unit;
    return unit.empty() ? "" : " " + unit;
}

// Where a quantity is undefined: "e >= 0.7125" if that is one end of one axis, else the first point; "" without axes.
std::string SweepSummary::where_missing(const ColumnRange& column) const {
    const SweepSpec& sweep = table_->sweep();
    if (sweep.axes.empty()) return "";
    const auto at = [&](std::size_t axis, std::uint64_t point) {
        return fmt::format("{:.6g}", sweep.value(axis, point));
    };
    const SweepAxis& axis = sweep.axes.front();
    if (sweep.axes.size() == 1 && !sweep.random) {
        const bool is_up = axis.low < axis.high;
        if (column.last < column.first_missing)
            return fmt::format("{} {} {}", axis.name, is_up ? ">=" : "<=", at(0, column.first_missing));
        if (column.last_missing < column.first)
            return fmt::format("{} {} {}", axis.name, is_up ? "<=" : ">=", at(0, column.last_missing));
    }
    std::string where;
    for (std::size_t i = 0; i < sweep.axes.size(); ++i)
        where += fmt::format("{}{} = {}", i == 0 ? "first at " : ", ", sweep.axes[i].name, at(i, column.first_missing));
    return where;
}

std::string SweepSummary::text() const {
    const std::string& title = table_->model().description().title;
    const bool is_section = table_->is_section();
    std::string text =
        fmt::format("{}: {} run{}, {}{}\n", title, totals_.runs, totals_.runs == 1 ? "" : "s",
                    totals_.whole == totals_.runs ? "all reached the end time"
                                                  : fmt::format("{} reached the end time", totals_.whole),
                    is_section ? fmt::format("; {} rows", totals_.rows) : "");
    std::size_t width = 0;
    for (std::size_t i = 0; i < columns_.size(); ++i) width = std::max(width, name_of(i).size());
    const char* const things = is_section ? "rows" : "runs";
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        const ColumnRange& column = columns_[i];
        text += fmt::format("  {:<{}}   ", name_of(i), width);
        if (column.count == 0) {
            text += fmt::format("does not exist in any of the {} runs\n", totals_.runs);
            continue;
        }
        const std::string low = fmt::format("{:.6g}", column.low + 0.0),
                          high = fmt::format("{:.6g}", column.high + 0.0);
        text += low == high ? low : fmt::format("{} to {}", low, high);
        text += fmt::format("{} in {} {}", unit_of(i), column.count, things);
        if (column.missing > 0 && !is_section)
            text += fmt::format("; does not exist in {} ({})", column.missing, where_missing(column));
        text += '\n';
    }
    return text;
}

std::vector<std::string> SweepSummary::undefined_everywhere() const {
    std::vector<std::string> sentences;
    for (std::size_t i = 0; i < columns_.size(); ++i)
        if (columns_[i].count == 0 && totals_.runs > 0)
            sentences.push_back(fmt::format("{} does not exist in any of the {} runs", name_of(i), totals_.runs));
    return sentences;
}

SweepPictures::SweepPictures(const SweepTable& table, const SweepPictureOptions& options, const PictureJob& job)
    : table_(table), options_(options), job_(job) {
    if (options_.files.empty()) {
        for (const auto& [is_given, option] :
             {std::pair{options_.look.dark, "--dark"}, std::pair{options_.look.transparent, "--transparent"},
              std::pair{options_.page.width > 0.0, "--width-mm"}})
            if (is_given) throw InputError(option, {}, "this needs --out F");
        return;
    }
    for (const std::string& file : options_.files) {
        if (file == "-") throw InputError("--out -", {}, "the picture of a sweep needs a file", "write --out F.png");
        const std::string format = format_for(file, "");
        if (format == "pdf") need_pdf_writer("--out " + file);
        if (format == "png") job.check_size(options_.size.width, options_.size.height);
    }
    check(options_.page, "--width-mm");
    if (!job.reproduces()) try_to_draw();
    const PictureSize size = size_of(page_for(options_.page, "svg"), options_.size, Figure(), "svg");
    options_.look.width = size.width / size.scale;
    if (has_height()) options_.look.height = size.height / size.scale;
    const SweepData data(table);
    check_drawn(data, options_.look);
    for (const std::string& word : left_out(data, options_.look))
        print_clean(stderr, "achilles: warning: --print {}: text values are not drawn in a section\n", word);
}

// Missing fonts or a missing off-screen renderer must cause an error before the runs, not after them.
void SweepPictures::try_to_draw() const {
    for (const std::string& file : options_.files) {
        const std::string format = format_for(file, "");
        try {
            picture_of(Figure(), {64, 64}, {}, format == "png" ? format : "svg");
        } catch (const InputError&) {
            throw;
        } catch (const std::runtime_error& problem) {
            throw InputError("--out " + file, {}, problem.what());
        }
    }
}

std::optional<Figure> SweepPictures::figure(const RowReader& each_rows) const {
    std::uint64_t count = 0;
    each_rows([&](const Rows& rows) { count += rows.count(); });
    const std::uint64_t every = (count + max_drawn_rows - 1) / max_drawn_rows;
    SweepData data(table_);
    std::uint64_t next = 0;
    each_rows([&](const Rows& rows) {
        if (every <= 1) return data.add(rows);
        for (std::size_t row = 0; row < rows.count(); ++row)
            if (next++ % every == 0) data.add(rows, row);
    });
    if (every > 1)
        print_clean(
            stderr,
            "achilles: warning: the table has {} rows; every {}th is drawn, because a figure holds at most {}\n", count,
            every, max_drawn_rows);
    SweepLook look = options_.look;
    look.columns = columns_with_values(data, options_.look);
    const bool needs_both = data.is_section() && data.sweep.axes.empty();  // one is drawn over the other
    if (look.columns.empty() || (needs_both && look.columns.size() < 2)) {
        print_clean(stderr, "achilles: no picture is drawn: no run has a value to draw\n");
        return std::nullopt;
    }
    return compose_sweep(data, look);
}

PictureSize SweepPictures::size_for(const Figure& figure, const std::string& format) const {
    PictureSize size = size_of(page_for(options_.page, format), options_.size, figure, format);
    if (!has_height()) size.height = readable_height(figure, size.width, size.height, size.scale);
    return size;
}

std::string SweepPictures::bytes(const Figure& figure, const std::string& file) const {
    const std::string format = format_for(file, "");
    const PictureSize size = size_for(figure, format);
    job_.check_size(size.width, size.height);
    const SystemDescription& description = table_.model().description();
    Notes notes = job_.notes_of("", {});
    for (Note& note : notes)
        if (note.keyword == "Title") note.text = description.title + ": " + to_text(table_.sweep(), description);
    return picture_of(figure, size, notes, format);
}

void reproduce_sweep(const SweepTable& table, const SweepPictureOptions& options, PictureJob& job, int threads) {
    const SweepPictures pictures(table, options, job);
    const std::uint64_t points = table.sweep().count();
    const std::atomic<bool> stop{false};
    std::vector<Rows> all;
    std::uint64_t row_count = 0;
    do_chunks(
        0, points, threads, [&](Chunk chunk) { return to_bytes(table.rows(chunk.first, chunk.count)); },
        [&](Chunk, const std::string& bytes) {
            all.push_back(rows_from(bytes, table));
            row_count += all.back().count();
            job.check_rows(row_count);
        },
        stop);
    const std::optional<Figure> figure = pictures.figure([&](const auto& take) {
        for (const Rows& rows : all) take(rows);
    });
    if (figure) job.keep(pictures.bytes(*figure, pictures.files().front()));
}

}  // namespace achilles
