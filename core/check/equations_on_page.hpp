// Layout of the derived equations of a system, shared by reports and sheets of equations. For the files of this library
// only: see algebra/multinomial.hpp.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "algebra/writer.hpp"
#include "check/simplified.hpp"
#include "output/page.hpp"

namespace achilles {

class EquationsOnPage {
 protected:
    EquationsOnPage(const Model& model, const Run& run, const SimplifiedEquations& simplified, Page page)
        : model_(model),
          run_(run),
          simplified_(simplified),
          page_(std::move(page)),
          writer_(simplified.algebra(), model.slot_names(), simplified.ranks(), page_.notation()) {}

    bool is_text() const { return page_.notation() == Notation::text; }
    std::string name(const std::string& symbol) const { return write_name(symbol, page_.notation()).text; }
    std::string in_line(const std::string& formula) const { return is_text() ? formula : fmt::format("${}$", formula); }
    std::string words(const std::string& plain) const { return is_text() ? plain : Page::escaped(plain); }

    bool is_one() const { return model_.contacts() == 1; }
    // A phrase that names the contact: `words` with its name in place of {}. "" if the system has only one contact.
    std::string of(const char* words, std::size_t contact) const {
        if (is_one()) return "";
        return fmt::format(fmt::runtime(words), model_.description().constraints[contact].name);
    }

    // The equations of a contact. If `named`, each formula has a caption, and the gap is included.
    void contact(std::size_t index, bool forces, bool named = false);
    // As one matrix if the page is wide enough, else entry by entry.
    void matrix(const TextAndLatex& left, const std::vector<std::optional<Fraction>>& entries,
                std::span<const Expression> derived, std::size_t columns);
    // The result for the sign of hddot on the surface.
    void zeno(const std::optional<ZenoCondition>& found);
    // "theta2 = 0", "theta2' = 0": the solutions of h = 0 and hdot = 0. Empty if that takes too much work.
    std::vector<std::string> on_surface(const ZenoCondition& zeno) const;
    // The value that must be negative, with the parameters of this run; nullopt if it depends on more than parameters.
    std::optional<double> decisive_here(const ZenoCondition& zeno) const;
    AlgebraWriter writer_of(const ZenoCondition& zeno) const;
    // The condition on the restitution: impacts accumulate only for 0 < e < 1.
    void zeno_restitution(std::size_t contact);
    // Says which Zeno conditions with held contacts are not printed.
    void unwritten_conditions();

    const Model& model_;
    const Run& run_;
    const SimplifiedEquations& simplified_;
    Page page_;
    AlgebraWriter writer_;

 private:
    struct Quotient {
        std::string whole, top, bottom;
    };
    void flat(std::size_t index);
    // As a product of factors; as a quotient of sums if factoring takes too much work.
    std::string written(const Fraction& fraction, const AlgebraWriter& writer, Algebra& algebra) const;
    std::string written(const Fraction& fraction) const { return written(fraction, writer_, simplified_.algebra()); }
    void formula(const TextAndLatex& left, const std::optional<Fraction>& fraction, Expression derived,
                 const TextAndLatex& definition);
    void unsimplified(const TextAndLatex& left, Expression derived, const TextAndLatex& definition);
    Quotient factor_or_sum(const Fraction& fraction) const;
    static Quotient split(const FactoredForm& factored, const std::string& whole, const AlgebraWriter& writer);
    static void long_formula(Page& page, const TextAndLatex& left, const Quotient& quotient);
    std::string grounds(const ZenoCondition& zeno) const;
    void reason(const ZenoCondition& zeno, const AlgebraWriter& writer);
};

// What the reader understood of a mechanism: masses, inertias, lengths, the meaning of contact forces, and friction.
// Headings Bodies, Springs, Contacts and Friction, with values at the start of the run. For a system typed as energies
// only the last, for a system without friction all but the last. The last cell of a row of text is a sentence
// (Block::Kind::lines).
void put_mechanism(Page& page, const Model& model, const Run& run);

}  // namespace achilles
