// The words of one line of a journal. A word that holds spaces, # or quotes stands in "double quotes".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "system/description.hpp"

namespace achilles {

// The words of a line and where they stand, to complain about. Refers to the text and the file's name.
class Line {
 public:
    // Throws InputError where quotes are not closed. What follows a # outside quotes is a comment.
    Line(std::string_view text, const std::string& file, int number);

    struct Word {
        std::string text;
        int column = 1;
    };
    const Word& word(std::size_t i) const { return words_[i]; }
    std::size_t count() const { return words_.size(); }

    // Each reads a word and throws an InputError that names its place where it is something else.
    double number(std::size_t i) const;
    int whole_number(std::size_t i) const;
    // So many words follow the first, or else an error that shows the usage.
    void expect_arguments(std::size_t least, std::size_t most, const std::string& usage) const;
    InputError error(int column, const std::string& message, const std::string& hint = {}) const;

 private:
    std::string plain(std::size_t& at) const;
    std::string quoted(std::size_t& at) const;

    std::string_view text_;
    const std::string& file_;
    int number_;
    std::vector<Word> words_;
};

// A word as it is written in a line: in quotes, or plain where it may stand so.
std::string quoted(const std::string& word);
std::string quoted_where_needed(const std::string& word);

// Whether a line holds nothing but space and a comment.
bool is_blank(std::string_view line);

}  // namespace achilles
