#include "study/flags.hpp"

#include "system/description.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

constexpr std::string_view bare = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%^";

// No expression has a double quote, nor anything that means something to a shell inside them.
std::string quoted(const std::string& text) {
    const bool is_bare = !text.empty() && text.find_first_not_of(bare) == text.npos;
    return is_bare ? text : "\"" + text + "\"";
}

std::vector<std::string> words_of(std::string_view text, const std::string& whose) {
    std::vector<std::string> words;
    bool inside = false, open = false;
    for (const char c : text) {
        if (c == '"') {
            open = !open;
            if (!inside) words.emplace_back();
            inside = true;
        } else if (c == ' ' && !open) {
            inside = false;
        } else {
            if (!inside) words.emplace_back();
            inside = true;
            words.back() += c;
        }
    }
    if (open) throw InputError(whose, {}, "a quote is never closed");
    return words;
}

}  // namespace

std::vector<Flag> read_flags(std::string_view text, const std::string& whose) {
    const std::vector<std::string> words = words_of(text, whose);
    std::vector<Flag> flags;
    for (std::size_t i = 0; i < words.size(); i += 2) {
        if (i + 1 == words.size()) throw InputError(shown(words[i]), {}, "a value is missing");
        flags.push_back({words[i], words[i + 1]});
    }
    return flags;
}

std::string to_text(const std::vector<Flag>& flags) {
    std::string text;
    for (const Flag& flag : flags) text += (text.empty() ? "" : " ") + flag.name + " " + quoted(flag.value);
    return text;
}

}  // namespace achilles
