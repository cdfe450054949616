// Input and output shared by the commands that make pictures. `reproduce` runs the same commands with a job that reads
// its inputs from a picture and keeps only the requested output.
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

struct SweepSpec;

class PictureJob {
 public:
    // For a command line: reads from the disk and writes files.
    explicit PictureJob(const std::vector<std::string>& words);
    // For a picture made before: reads the sources stored in it.
    explicit PictureJob(const Origin& origin);

    Inputs& inputs() { return inputs_; }
    bool reproduces() const { return reproduces_; }

    // The notes to store in a picture.
    Notes notes_of(const std::string& picture, const std::vector<PictureRun>& runs) const;

    // Throws InputError if a reproduced picture would have too many pixels, since it may come from an untrusted source.
    void check_size(int width, int height) const;
    // Budget checks for a run, a sweep, and the rows of a sweep so far. Throw Forbidden.
    void check(const Options& options) const;
    void check(const SweepSpec& sweep) const;
    void check_rows(std::uint64_t rows) const;
    // Registers an output and checks that it can be written, before the work starts. Throws InputError if not.
    void add(const std::string& path);
    // Adds a picture to the output. `make` returns the content and is called only if this picture is wanted.
    using Make = std::function<std::string(const Notes&)>;
    void put(const std::string& path, const std::string& picture, const std::vector<PictureRun>& runs,
             const Make& make);
    // For a command that writes its pictures itself: the picture that `reproduce` wants.
    void keep(std::string picture) { made_ = std::move(picture); }
    void put_text(const std::string& path, const std::string& text);
    // Throws InputError if a registered output has this path, which is also written for another purpose.
    void refuse_output(const std::string& path) const;
    // Writes all outputs, or none. Outputs must not be inputs.
    void commit();

    // The picture that `reproduce` wants; empty if the command did not make it.
    const std::optional<std::string>& made() const { return made_; }

 private:
    Inputs inputs_;
    OutputFiles files_;
    std::string command_, wanted_;
    bool reproduces_ = false;
    std::optional<std::string> made_;
};

// An off-screen surface for pictures of one size. Each frame is drawn into ImGui's background draw list.
class PictureSurface {
 public:
    explicit PictureSurface(const SurfaceOptions& options);
    std::string png(const FrameFunction& draw, const Notes& notes);

 private:
    Offscreen surface_;
};

// Size and rendering of a picture as PNG or SVG with notes. The functions throw std::runtime_error if drawing fails.
struct PictureSize {
    int width = 1200, height = 800;  // pixels
    double scale = 1.0;
    double width_mm = 0.0;  // width on paper, stored in the file; 0: the default of the format
};
std::string png_of(const Figure& figure, const PictureSize& size, const Notes& notes);
std::string svg_of(const Figure& figure, const PictureSize& size, const Notes& notes);
// `format`: "png", "svg" or "pdf".
std::string picture_of(const Figure& figure, const PictureSize& size, const Notes& notes, const std::string& format);
// The same for a mechanism on this background color; a transparent color means no background.
std::string picture_of(const Drawing& world, const Color& background, const PictureSize& size, const Notes& notes,
                       const std::string& format);

// The views of these names, in this order. Without names: all views, those over time first because their panels share
// an axis. Throws InputError for an unknown name.
std::vector<ViewDescription> views_of(const SystemDescription& description, const std::vector<std::string>& names);

}  // namespace achilles
