#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "cli/commands/commands.hpp"
#include "cli/write_files.hpp"
#include "pictures/icon.hpp"
#include "pictures/picture_job.hpp"

namespace achilles {

namespace {

void draw_icons(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    OutputFiles files;
    const auto put = [&](const std::string& name, int pixels, const std::string& format) {
        const std::string file = (folder / name).string();
        files.add(file);
        files.put(file, picture_of(icon(pixels), {0, 0, 0, 0}, {pixels, pixels, 1.0, 0.0}, {}, format));
    };
    for (const int pixels : icon_sizes) put(fmt::format("{}.png", pixels), pixels, "png");
    put("achilles.svg", icon_sizes[std::size(icon_sizes) - 1], "svg");
    files.commit();
}

}  // namespace

void add_icon(CLI::App& program, int& status) {
    const auto folder = std::make_shared<std::string>();
    CLI::App* command =
        program.add_subcommand("icon", "Draws the icon of the program, as SVG and as PNGs of all sizes");
    command->add_option("--out", *folder, "folder for the pictures")->required()->type_name("DIR");
    command->callback([folder, &status] {
        draw_icons(*folder);
        status = reached_end;
    });
}

}  // namespace achilles
