// The pictures of a sweep.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "figure/sweep_figure.hpp"
#include "output/sweep_files.hpp"
#include "pictures/paper_size.hpp"

namespace achilles {

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

}  // namespace achilles
