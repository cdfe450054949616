#include "cli/sweep_pictures.hpp"

#include <fmt/format.h>

#include <atomic>
#include <stdexcept>

#include "cli/terminal.hpp"
#include "pictures/pdf.hpp"
#include "pictures/picture_ending.hpp"
#include "pictures/take_away.hpp"
#include "study/chunks.hpp"

namespace achilles {

SweepPictures::SweepPictures(const SweepTable& table, const SweepPicturesAsked& asked, const PictureJob& job)
    : table_(table), asked_(asked), job_(job) {
    if (asked_.files.empty()) {
        for (const auto& [is_given, option] :
             {std::pair{asked_.look.dark, "--dark"}, std::pair{asked_.look.transparent, "--transparent"},
              std::pair{asked_.page.width > 0.0, "--width-mm"}})
            if (is_given) throw InputError(option, {}, "this needs --out F");
        return;
    }
    for (const std::string& file : asked_.files) {
        if (file == "-") throw InputError("--out -", {}, "the picture of a sweep needs a file", "write --out F.png");
        const std::string format = format_for(file, "");
        if (format == "pdf") need_pdf_writer("--out " + file);
        if (format == "png") job.check_size(asked_.size.width, asked_.size.height);
    }
    check(asked_.page, "--width-mm");
    if (!job.reproduces()) try_to_draw();
    const PictureSize size = size_of(page_for(asked_.page, "svg"), asked_.size, Figure(), "svg");
    asked_.look.width = size.width / size.scale;
    if (has_height()) asked_.look.height = size.height / size.scale;
    const SweepData data(table);
    check_drawn(data, asked_.look);
    for (const std::string& word : left_out(data, asked_.look))
        print_clean(stderr, "achilles: warning: --print {}: text values are not drawn in a section\n", word);
}

// Without its fonts, or what draws without a window, a picture fails: before the runs, not after them.
void SweepPictures::try_to_draw() const {
    for (const std::string& file : asked_.files) {
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

std::optional<Figure> SweepPictures::figure(const EachRows& each_rows) const {
    std::uint64_t count = 0;
    each_rows([&](const Rows& rows) { count += rows.count(); });
    const std::uint64_t every = (count + most_drawn_rows - 1) / most_drawn_rows;
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
            every, most_drawn_rows);
    SweepLook look = asked_.look;
    look.columns = columns_with_values(data, asked_.look);
    const bool needs_both = data.is_section() && data.sweep.axes.empty();  // one over the other
    if (look.columns.empty() || (needs_both && look.columns.size() < 2)) {
        print_clean(stderr, "achilles: no picture is drawn: no run has a value to draw\n");
        return std::nullopt;
    }
    return compose_sweep(data, look);
}

PictureSize SweepPictures::size_for(const Figure& figure, const std::string& format) const {
    PictureSize size = size_of(page_for(asked_.page, format), asked_.size, figure, format);
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

void reproduce_sweep(const SweepTable& table, const SweepPicturesAsked& asked, PictureJob& job, int threads) {
    const SweepPictures pictures(table, asked, job);
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
