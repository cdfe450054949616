// What the commands that make pictures share: where they read from and where pictures go. `reproduce` runs the same
// commands in a job of its own, which reads from a picture and keeps the one that is asked for.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/write_files.hpp"
#include "figure/figure.hpp"
#include "pictures/origin.hpp"
#include "surface/offscreen.hpp"
#include "system/description.hpp"

namespace achilles {

struct Sweep;

class PictureJob {
 public:
    // For a command line: from the disk, into files.
    explicit PictureJob(const std::vector<std::string>& words);
    // For a picture made before.
    explicit PictureJob(const Origin& origin);

    Inputs& inputs() { return inputs_; }
    bool reproduces() const { return reproduces_; }

    // What such a picture carries.
    Notes notes_of(const std::string& picture, const std::vector<Shown>& runs) const;

    // A stranger's picture is made again up to a size. Throws InputError for so many pixels.
    void check_size(int width, int height) const;
    // The same of a run, of a sweep, and of the rows that it has come to. Throw Forbidden.
    void check(const Options& options) const;
    void check(const Sweep& sweep) const;
    void check_rows(std::uint64_t rows) const;
    // Tried before the work: a path that cannot be written is bad input, not a loss at the end. Throws InputError.
    void add(const std::string& path);
    // What the file will hold. `make` is not called for a picture nobody asked for.
    using Make = std::function<std::string(const Notes&)>;
    void put(const std::string& path, const std::string& picture, const std::vector<Shown>& runs, const Make& make);
    // Of a command that writes its pictures itself: what `reproduce` wants.
    void keep(std::string picture) { made_ = std::move(picture); }
    void put_text(const std::string& path, const std::string& text);
    // Throws InputError where a path is that of a file that was added: it cannot be written for another reason as well.
    void refuse_output(const std::string& path) const;
    // Writes all, or nothing. What was read is no output.
    void commit();

    // What `reproduce` wants: nothing if the command made no such picture.
    const std::optional<std::string>& made() const { return made_; }

 private:
    Inputs inputs_;
    OutputFiles files_;
    std::string command_, wanted_;
    bool reproduces_ = false;
    std::optional<std::string> made_;
};

// Pictures of one size, one after the other: whoever fills the frame draws into its background list.
class PictureSurface {
 public:
    explicit PictureSurface(const SurfaceOptions& options);
    std::string png(const FrameFunction& draw, const Notes& notes);

 private:
    Offscreen surface_;
};

// A figure as a PNG or SVG file with these notes. Throws std::runtime_error where it cannot be drawn.
struct PictureSize {
    int width = 1200, height = 800;  // pixels
    double scale = 1.0;
    double width_mm = 0.0;  // on paper, which the file says; 0: as its format has it
};
std::string png_of(const Figure& figure, const PictureSize& size, const Notes& notes);
std::string svg_of(const Figure& figure, const PictureSize& size, const Notes& notes);
// By the format's name: "png", "svg" or "pdf".
std::string picture_of(const Figure& figure, const PictureSize& size, const Notes& notes, const std::string& format);
// The same of a mechanism, over this colour; where that is clear there is no background.
std::string picture_of(const Drawing& world, const Color& background, const PictureSize& size, const Notes& notes,
                       const std::string& format);

// The views of these names, in this order. If none is named all, those over time first: their panels share an axis.
// Throws InputError for a name that is none.
std::vector<ViewDescription> views_of(const SystemDescription& description, const std::vector<std::string>& names);

}  // namespace achilles
