#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "cli/commands/commands.hpp"
#include "cli/overrides.hpp"
#include "cli/terminal.hpp"
#include "cli/write_files.hpp"
#include "pictures/picture_comparison.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

struct CompareArguments {
    std::string before, after, out, json;
    double threshold = 1.0;
};

// Adds the differences of the pictures that differ. The folder must be new or empty: a picture of an earlier comparison
// would look like a result of this one.
void put_differences(const CompareArguments& arguments, const PictureComparison& comparison, OutputFiles& files) {
    const std::filesystem::path folder = arguments.out;
    if (std::filesystem::exists(folder) && !std::filesystem::is_empty(folder))
        throw InputError(arguments.out, {}, "this folder is not empty", "name a new folder");
    for (const ComparedPicture& picture : comparison.pictures) {
        if (picture.is_same(arguments.threshold)) continue;
        const std::filesystem::path file = folder / picture.name;
        std::filesystem::create_directories(file.parent_path());
        files.add(file.string());
        files.put(file.string(), difference_png(comparison, picture));
    }
}

int compare(const CompareArguments& arguments) {
    OutputFiles files;
    const bool are_folders = std::filesystem::is_directory(arguments.before);
    if (!are_folders) {
        files.protect_input(arguments.before);
        files.protect_input(arguments.after);
        if (!arguments.out.empty()) files.add(arguments.out);
    }
    if (!arguments.json.empty()) files.add(arguments.json);
    const PictureComparison comparison = compare_pictures(arguments.before, arguments.after);
    if (!arguments.out.empty() && are_folders) put_differences(arguments, comparison, files);
    if (!arguments.out.empty() && !are_folders)
        files.put(arguments.out, difference_png(comparison, comparison.pictures.front()));
    if (!arguments.json.empty()) files.put(arguments.json, comparison_json(comparison, arguments.threshold));
    files.commit();
    const bool is_piped = arguments.out == "-" || arguments.json == "-";
    print_clean(is_piped ? stderr : stdout, "{}", comparison_text(comparison, arguments.threshold));
    return is_same(comparison, arguments.threshold) ? reached_end : made_differently;
}

}  // namespace

void add_compare(CLI::App& program, int& status) {
    const auto arguments = std::make_shared<CompareArguments>();
    CLI::App* command = program.add_subcommand(
        "compare", "Compares two PNGs, or two folders of PNGs, as screenshot regression tests do");
    command->add_option("BEFORE", arguments->before, "PNG, or folder of PNGs, to compare with")
        ->required()
        ->type_name("");
    command->add_option("AFTER", arguments->after, "PNG or folder to compare")->required()->type_name("");
    command
        ->add_option_function<std::string>(
            "--threshold",
            [arguments](const std::string& text) {
                arguments->threshold = number_from("--threshold", text);
                if (!(arguments->threshold >= 0.0))
                    throw InputError("--threshold " + text, {}, "the threshold must be 0 or more");
            },
            "largest difference of the same picture (default 1: the mean color of a tile of 30 pixels may differ by "
            "0.5 percent, one channel in a tile of 10 pixels by 0.8 percent)")
        ->type_name("X");
    command
        ->add_option("--out", arguments->out,
                     "PNG to write: ten times the difference, on black; for folders a new folder with those of the "
                     "pictures that differ")
        ->type_name("F.png|DIR");
    command->add_option("--json", arguments->json, "write the result as JSON; - is standard output")->type_name("F");
    command->callback([arguments, &status] { status = compare(*arguments); });
}

}  // namespace achilles
