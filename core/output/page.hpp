// Headings, sentences, formulas and matrices on a page of plain text or of LaTeX.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "expression/notation.hpp"

namespace achilles {

// A word or name in both notations.
struct Both {
    std::string text, latex;
};

// A piece of a page, for whoever sets it in another way.
struct Block {
    enum class Kind { title, heading, caption, sentence, lines, formula, matrix } kind = Kind::sentence;
    Both words;         // of a title its two lines, of a formula or a matrix the left hand side
    std::string right;  // of a formula
    std::vector<std::vector<std::string>> rows{};
    int indent = 0;
};

class Page {
 public:
    // What a formula may take on a line, in visible characters.
    Page(Notation notation, std::size_t width) : notation_(notation), width_(width) {}
    explicit Page(Notation notation) : Page(notation, notation == Notation::text ? 100 : 92) {}

    Notation notation() const { return notation_; }
    std::size_t width() const { return width_; }

    void title(const std::string& title, const std::string& source);
    void heading(const Both& words);
    void heading(const std::string& words) { heading(Both{words, words}); }
    void caption(const std::string& words);                         // what the next formula is
    void sentence(const Both& words);                               // in LaTeX as it is
    void lines(const std::vector<std::vector<std::string>>& rows);  // a table of plain words
    void formula(const Both& left, const std::string& right, int indent = 0);
    void matrix(const Both& left, const std::vector<std::vector<std::string>>& rows);

    const std::vector<Block>& blocks() const { return blocks_; }
    // All of it as one text.
    std::string finish() const;

    // Plain words for LaTeX.
    static std::string escaped(std::string_view words);

 private:
    Notation notation_;
    std::size_t width_;
    std::vector<Block> blocks_;
};

}  // namespace achilles
