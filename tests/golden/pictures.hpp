// The pictures that have golden files. Images are made by the program from the command line, texts by the functions
// that it calls.
#pragma once

#include "figure/publication.hpp"
#include "golden/goldens.hpp"
#include "run/trajectory.hpp"

namespace achilles::golden {

// A figure of every system in assets/systems, the paper's pictures, a frame of every system in tests/golden/frame, the
// sweeps in tests/golden/sweep, the proofs in tests/golden/proof, and the explorer after every journal in
// tests/golden/explorer and assets/journals. A new file without golden files is a failure.
std::vector<GoldenPicture> pictures();

constexpr int frame_width = 1000, frame_height = 625;  // pixels
// Size of the golden figures: small, with the proportions of `achilles figure`.
constexpr int figure_width = 840, figure_height = 560;  // pixels
constexpr double figure_size = 0.7;                     // --scale
constexpr double figure_scale = figure_size * publication_scale;

Trajectory gallery_run(const std::string& system);
Figure gallery_figure(const Trajectory& trajectory, const PublicationStyle& style);

// The image made by a command of the program. `environment` has variables in shell syntax. Throws std::runtime_error
// with the message of the program.
Image image_of(const std::string& command, const std::string& environment = {});
std::string figure_command(const std::string& system);
// The first line of a journal may have the form "# achilles screenshot OPTIONS".
std::string explorer_command(const std::filesystem::path& journal);

}  // namespace achilles::golden
