#include "pictures/picture_ending.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>

#include "system/description.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

constexpr std::string_view written[] = {"png", "svg", "pdf"};
// What a person may hope for: bytes of another kind in such a file would be a trap.
constexpr std::string_view others[] = {"jpg", "jpeg", "gif", "mp4", "bmp", "webp", "tif", "tiff", "eps", "ps"};

template <std::size_t count>
bool is_among(const std::string& ending, const std::string_view (&endings)[count]) {
    return std::find(std::begin(endings), std::end(endings), ending) != std::end(endings);
}

template <class Change>
std::string each(std::string text, Change change) {
    for (char& c : text) c = static_cast<char>(change(static_cast<unsigned char>(c)));
    return text;
}
std::string large(const std::string& text) {
    return each(text, [](int c) { return std::toupper(c); });
}

}  // namespace

std::string ending_of(const std::string& file) {
    const std::string ending = std::filesystem::path(file).extension().string();
    return each(ending.substr(std::min<std::size_t>(1, ending.size())), [](int c) { return std::tolower(c); });
}

std::string ending_of_picture(const std::string& file) {
    const std::string ending = ending_of(file);
    return is_among(ending, written) ? ending : "";
}

std::string format_for(const std::string& out, const std::string& wanted, const std::string& advice) {
    const std::string ending = ending_of(out), said = ending_of_picture(out), option = "--out " + shown(out);
    if (wanted.empty() && out == "-") return "png";
    if (wanted.empty() && said.empty())
        throw InputError(option, {}, "the file name must end in .png, .svg or .pdf",
                         is_among(ending, others) ? "" : "or add --format png, svg or pdf");
    if (wanted.empty()) return said;
    if (said != wanted && (!said.empty() || is_among(ending, others)))
        throw InputError(option, {},
                         fmt::format("this name says {}, but the picture is {}", large(ending), large(wanted)),
                         fmt::format("end it in .{}{}", wanted, advice));
    return wanted;
}

}  // namespace achilles
