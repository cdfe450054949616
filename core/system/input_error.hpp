// What is wrong with a file or a value, and where: errors, the mistakes gathered while a file is read, and how names and lines
// are shown in their messages.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace achilles {

struct SystemDescription;

// Where something stands in a file, from 1; 0: nowhere.
struct Location {
    int line = 0;
    int column = 0;
};

// Bad input, told to a person: "FILE:LINE:COLUMN: message", the offending line with a caret where there is one, a hint.
struct InputError : std::runtime_error {
    InputError(std::string file, Location at, std::string message, std::string hint = {}, const std::string& line = {});
    std::string file, message, hint;  // hint: what would be right; may be empty
    Location at;

 protected:
    // One that stands for several: the first of them, but for what() a text of its own.
    InputError(const InputError& first, const std::string& told);
};

// The mistakes of one file, in order of position. Caught as an InputError it is the first of them; what() tells all,
// each as it would be told alone, with an empty line between them and a last line "and N more" where there are more.
struct InputErrors : InputError {
    // `all`: at least one, in order; `more`: how many others there are.
    explicit InputErrors(std::vector<InputError> all, std::size_t more = 0);
    std::vector<InputError> all;  // at most ten, each with its line and column
    std::size_t more;
};

// What an error consists of: the mistakes of an InputErrors, or itself.
std::vector<InputError> each_of(const InputError& error);

// An expression (or a number) of a file. `at` is the place of its first character.
struct Text {
    std::string text;
    Location at;
    bool is_written = true;  // false: the reader made it from what stands at `at` (rewrite.hpp)
};

// The place of a byte inside a text that starts at `text.at`; of one that the reader made, `text.at` itself.
Location place_in(const Text& text, std::size_t offset);

// The mistakes of one system file, gathered while it is read: what is independent of a mistake is read on, what depends on it
// is skipped, and in the end all are told in order of position.

// One mistake, thrown while a file is read and caught by Mistakes::attempt. It holds no line yet: a hostile file has
// very many, and only ten are shown.
struct Mistake {
    Location at;
    std::string message, hint;  // hint: what would be right; may be empty
    bool has_line = true;       // false: no line can be blamed, something is missing
};

// Thrown where reading cannot go on because of a mistake that was added already.
struct AlreadyTold {};

class Mistakes {
 public:
    void add(Mistake mistake);
    // Runs read() and keeps the Mistake it throws. True if it threw none.
    template <class Read>
    bool attempt(const Read& read) {
        try {
            read();
            return true;
        } catch (Mistake& mistake) {
            add(std::move(mistake));
        } catch (const AlreadyTold&) {
        }
        return false;
    }
    std::size_t count() const { return count_; }
    // Throws InputErrors if there are any: the first ten by position, and how many more.
    void raise(const SystemDescription& system) const;

 private:
    std::vector<Mistake> kept_;
    std::size_t count_ = 0;
};

// The line with that number, from 1, without its line break; "" where there is none.
std::string line_of(std::string_view text, int line);

// The byte at which the character of that column (from 1, UTF-8 characters) starts; the line's size if there is none.
std::size_t byte_of_column(std::string_view line, int column);

// What a person typed, fit for a message: control characters and broken UTF-8 become '?', and at most about 60
// characters stay.
std::string shown(std::string_view text);

// Text from a file, a journal or a picture, fit for a terminal: what would steer it becomes '?' (control characters but
// the line break and the tab, broken UTF-8, marks that turn the direction of reading). The rest stays.
std::string printable(std::string_view text);

// JSON in UTF-8, fit for a terminal and still the same value: what would steer one is written as \u009b.
std::string printable_json(std::string_view json);

// What is wrong with a subnormal parameter, and what would be right.
std::string subnormal_parameter(std::string_view name, double value);
inline constexpr const char* subnormal_hint = "use 0, or choose units in which it is at least 2.3e-308 in size";

}  // namespace achilles
