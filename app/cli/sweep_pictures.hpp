// The pictures of a sweep.
#pragma once

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
    PaperSize page;
};

class SweepPictures {
 public:
    // Whether they can be drawn: throws InputError before anything is computed. Refers to the table and the job.
    SweepPictures(const SweepTable& table, const SweepPicturesAsked& asked, const PictureJob& job);

    const std::vector<std::string>& files() const { return asked_.files; }
    // Drawn from all rows at the end, of which it holds most_drawn_rows at most: of more, every second, third, ... one. Throws
    // std::runtime_error where it cannot be drawn.
    Figure figure(const EachRows& each_rows) const;
    // As the name of such a file says.
    std::string bytes(const Figure& figure, const std::string& file) const;

 private:
    const SweepTable& table_;
    SweepPicturesAsked asked_;
    const PictureJob& job_;
};

// Makes the one picture that a job is asked for again, keeping no file.
void reproduce_sweep(const SweepTable& table, const SweepPicturesAsked& asked, PictureJob& job, int threads);

}  // namespace achilles
