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

class Page {
 public:
    explicit Page(Notation notation) : notation_(notation) {}

    Notation notation() const { return notation_; }
    // What a formula may take on a line, in visible characters.
    std::size_t width() const { return notation_ == Notation::text ? 100 : 92; }

    void title(const std::string& title, const std::string& source);
    void heading(const std::string& words);
    void sentence(const Both& words);                               // in LaTeX as it is
    void lines(const std::vector<std::vector<std::string>>& rows);  // a table of plain words
    void formula(const Both& left, const std::string& right, int indent = 0);
    void matrix(const Both& left, const std::vector<std::vector<std::string>>& rows);
    std::string finish();

    // Plain words for LaTeX.
    static std::string escaped(std::string_view words);

 private:
    Notation notation_;
    std::string content_;
};

}  // namespace achilles
