#include "journal/link.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "cli/assets.hpp"
#include "journal/journal.hpp"
#include "session/replay_script.hpp"

namespace achilles {

namespace {

constexpr std::string_view mark = "#run=";
// The base64url of RFC 4648, without padding.
constexpr std::string_view link_letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";

InputError damaged() { return {"the link", {}, "the run in this link is damaged", "copy the whole link"}; }

std::string in_letters(const std::vector<Bytef>& bytes) {
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(bytes.size() - i, 3);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0U);
        for (std::size_t k = 0; k <= count; ++k) text += link_letters[group >> (18 - 6 * k) & 63];
    }
    return text;
}

std::vector<Bytef> from_letters(std::string_view text) {
    if (text.size() % 4 == 1) throw damaged();
    std::vector<Bytef> bytes;
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::size_t value = link_letters.find(text[i]);
        if (value == std::string_view::npos) throw damaged();
        group = group << 6 | static_cast<std::uint32_t>(value);
        if (i % 4 > 0) bytes.push_back(static_cast<Bytef>(group >> (6 - 2 * (i % 4)) & 255));
    }
    return bytes;
}

std::vector<Bytef> compressed(const std::string& text) {
    std::vector<Bytef> bytes(compressBound(static_cast<uLong>(text.size())));
    uLongf size = static_cast<uLongf>(bytes.size());
    if (compress2(bytes.data(), &size, reinterpret_cast<const Bytef*>(text.data()), static_cast<uLong>(text.size()),
                  Z_BEST_COMPRESSION) != Z_OK)
        throw InputError("the link", {}, "there is not enough memory for a link");
    bytes.resize(size);
    return bytes;
}

// A few letters can expand to very much text, so the result is limited as a journal file is.
std::string expanded_text(const std::vector<Bytef>& bytes) {
    std::string text(largest_file, '\0');
    uLongf size = static_cast<uLongf>(text.size());
    const int result =
        uncompress(reinterpret_cast<Bytef*>(text.data()), &size, bytes.data(), static_cast<uLong>(bytes.size()));
    if (result == Z_BUF_ERROR && size == text.size())
        throw InputError("the link", {}, "the run in this link is too large for a journal");
    if (result != Z_OK) throw damaged();
    text.resize(size);
    return text;
}

// recipe() for another machine, which has the assets but none of the user's files.
std::vector<Command> portable_recipe(const Session& session) {
    std::vector<Command> steps = recipe(session);
    std::vector<Command> portable;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const auto* open = std::get_if<command::Open>(&steps[i]);
        if (open == nullptr || !is_system_path(open->system)) {
            portable.push_back(steps[i]);
            continue;
        }
        portable.emplace_back(command::New{});
        const bool is_replaced = i + 1 < steps.size() && std::holds_alternative<command::SetText>(steps[i + 1]);
        if (!is_replaced) portable.emplace_back(command::SetText{read_text(open->system)});
    }
    return portable;
}

}  // namespace

std::string web_address() {
    const char* const given = std::getenv("ACHILLES_WEB");
    return given != nullptr && *given != '\0' ? given : "http://127.0.0.1:8000/";
}

std::string link_of(const Session& session) {
    return web_address() + std::string(mark) + in_letters(compressed(journal_text(portable_recipe(session))));
}

bool is_link(std::string_view text) { return text.find(mark) != std::string_view::npos; }

std::string journal_in_link(std::string_view link) {
    const std::size_t at = link.find(mark);
    if (at == std::string_view::npos)
        throw InputError("the link", {}, "there is no run in this link",
                         "copy the whole link, with what follows #run=");
    return expanded_text(from_letters(link.substr(at + mark.size())));
}

std::string text_of_journal(const std::string& journal) {
    return is_link(journal) ? journal_in_link(journal) : journal_file(find_journal(journal));
}

std::string name_in_messages(const std::string& journal) {
    return is_link(journal) ? "the link" : find_journal(journal).string();
}

}  // namespace achilles
