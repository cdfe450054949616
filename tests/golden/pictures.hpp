// Which pictures have golden files, and how each is made: images by the program itself, as a user's shell runs it, and
// texts by the functions it calls.
#pragma once

#include "figure/publication.hpp"
#include "golden/goldens.hpp"
#include "run/trajectory.hpp"

namespace achilles::golden {

// A figure of every system in assets/systems, the paper's pictures, a frame of every system in tests/golden/frame, the
// sweeps in tests/golden/sweep, the proofs in tests/golden/proof, and the explorer after every journal in
// tests/golden/explorer and assets/journals. What a new file shows has no golden files yet: that is a failure.
std::vector<Picture> pictures();

constexpr int frame_width = 1000, frame_height = 625;  // pixels
// The golden figures' size: small, with the proportions of `achilles figure`.
constexpr int figure_width = 840, figure_height = 560;  // pixels
constexpr double figure_size = 0.7;                     // --scale
constexpr double figure_scale = figure_size * publication_scale;

Trajectory gallery_run(const std::string& system);
Figure gallery_figure(const Trajectory& trajectory, const PublicationStyle& style);

// The image a command of the program makes; `environment`: variables before it, as a shell reads them. Throws
// std::runtime_error with what the program said.
Image image_of(const std::string& command, const std::string& environment = {});
std::string figure_command(const std::string& system);
// The first line of a journal may say "# achilles screenshot" and options.
std::string explorer_command(const std::filesystem::path& journal);

}  // namespace achilles::golden
