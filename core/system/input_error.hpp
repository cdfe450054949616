// Errors in files and values, with their locations: exceptions, the collection of mistakes while a file is read, and
// the formatting of names and lines in messages.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace achilles {

struct SystemDescription;

// A position in a file, counted from 1; 0: none.
struct Location {
    int line = 0;
    int column = 0;
};

// Invalid input. what() is "FILE:LINE:COLUMN: message", the line with a caret if there is one, and a hint.
struct InputError : std::runtime_error {
    InputError(std::string file, Location at, std::string message, std::string hint = {}, const std::string& line = {});
    std::string file, message, hint;  // hint: a correction; may be empty
    Location at;

 protected:
    // For a collection of errors: the data of the first, with its own what().
    InputError(const InputError& first, const std::string& what);
};

// The mistakes of one file, ordered by position. As an InputError it is the first of them. what() lists all, separated
// by empty lines, with a last line "and N more" if some are not shown.
struct InputErrors : InputError {
    // `all` has at least one, ordered; `more` is the number of others.
    explicit InputErrors(std::vector<InputError> all, std::size_t more = 0);
    std::vector<InputError> all;  // at most ten, each with line and column
    std::size_t more;
};

// The mistakes of an InputErrors, or the error itself.
std::vector<InputError> each_of(const InputError& error);

// An expression or number in a file. `at` is the location of its first character.
struct TextPiece {
    std::size_t begin;  // offset in the text; the piece ends where the next one begins
    Location at;
    bool is_written;  // false: created by the reader from what is at `at`
};
struct Text {
    std::string text;
    Location at;
    bool is_written = true;           // false: created by the reader from what is at `at` (rewrite.hpp)
    std::vector<TextPiece> pieces{};  // parts from other places, by their begin; the text before the first is as above
};

// The location of a byte of a text. For a part created by the reader it is that of its origin.
Location place_in(const Text& text, std::size_t offset);

// Collects the mistakes of one system file while it is read. Parts independent of a mistake are still read; parts that
// depend on it are skipped. All mistakes are reported at the end, ordered by position.

// One mistake, thrown while a file is read and caught by ErrorCollector::attempt. It does not store its line, because a
// hostile file has very many mistakes and only ten are shown.
struct Mistake {
    Location at;
    std::string message, hint;  // hint: a correction; may be empty
    bool has_line = true;       // false: something is missing, so no line is shown
};

// Thrown to stop reading because of a mistake that was already added.
struct ErrorAlreadyReported {};

class ErrorCollector {
 public:
    void add(Mistake mistake);
    // Calls read() and adds the Mistake that it throws. Returns true if it throws none.
    template <class Read>
    bool attempt(const Read& read) {
        try {
            read();
            return true;
        } catch (Mistake& mistake) {
            add(std::move(mistake));
        } catch (const ErrorAlreadyReported&) {
        }
        return false;
    }
    std::size_t count() const { return count_; }
    // Throws InputErrors if there are any mistakes: the first ten by position, and the number of others.
    void raise(const SystemDescription& system) const;

 private:
    std::vector<Mistake> stored_;
    std::size_t count_ = 0;
};

// The line with this number, from 1, without its line break; "" if there is none.
std::string line_of(std::string_view text, int line);

// The byte offset of a column (from 1, in UTF-8 characters); the line's size if there is no such column.
std::size_t byte_of_column(std::string_view line, int column);

// User input for a message: control characters and invalid UTF-8 become '?', and it is cut to about 60 characters.
std::string shown(std::string_view text);

// Text from a file, a journal or a picture for a terminal. What could control the terminal becomes '?': control
// characters except line breaks and tabs, invalid UTF-8, and marks that change the writing direction.
std::string printable(std::string_view text);

// UTF-8 JSON for a terminal, with the same value: control characters are escaped, as in \u009b.
std::string printable_json(std::string_view json);

// Error message for a subnormal parameter value, and the hint for it.
std::string subnormal_parameter(std::string_view name, double value);
inline constexpr const char* subnormal_hint = "use 0, or choose units in which it is at least 2.3e-308 in size";

}  // namespace achilles
