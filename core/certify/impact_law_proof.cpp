#include "certify/impact_law_proof.hpp"

#include <algorithm>
#include <vector>

namespace achilles {

namespace {

constexpr std::size_t max_elements = 6;

class ImpactLawProof {
 public:
    ImpactLawProof(const ImpactLawTerms& terms, const Evaluator<Interval>& program, const Interval& e)
        : terms_(terms), program_(program), once_(Interval(1.0) + e) {
        std::size_t next = terms.rows * (terms.rows + 1);
        for (const ImpactLawTerms::Element& each : terms.elements) {
            const bool has_slip = each.slip >= 0;
            mu_.push_back(has_slip ? program.output(next) : Interval(0.0));
            mu_s_.push_back(has_slip ? program.output(next + 1) : Interval(0.0));
            if (has_slip) next += 2;
        }
    }

    // The first element whose slip may turn back, or the number of elements if no determinant was positive.
    std::optional<std::size_t> doubt(std::size_t from = 0) {
        if (from == terms_.elements.size()) return doubt_of_combination();
        const ImpactLawTerms::Element& each = terms_.elements[from];
        std::optional<std::size_t> found = doubt(from + 1);  // open; a joint that slides has a known force
        const auto in_state = [&](int gap, const Interval& part, int slip) {
            if (found) return;
            const std::size_t columns = columns_.size();
            if (gap >= 0) columns_.push_back({gap, each.slip, part, gap});
            if (slip >= 0) columns_.push_back({slip, -1, Interval(0.0), slip});
            found = doubt(from + 1);
            columns_.resize(columns);
        };
        const Interval mu = hull(mu_[from], mu_s_[from]);
        if (each.slip < 0 || is_joint(each.which)) {
            in_state(each.gap, Interval(0.0), is_joint(each.which) ? each.slip : -1);
        } else if (each.slides) {
            in_state(each.gap, Interval(mu_[from].hi()), -1);
            in_state(each.gap, Interval(-mu_[from].hi()), -1);
        } else {
            in_state(each.gap, Interval(0.0), each.slip);
            if (each.never_slides) return found;
            in_state(each.gap, mu, -1);
            in_state(each.gap, -mu, -1);
        }
        return found;
    }

 private:
    // An unknown impulse, along a row and a part of another; the row that it keeps.
    struct Column {
        int row, other;
        Interval part;
        int kept;
    };
    Interval W(int a, int b) const {
        return program_.output(static_cast<std::size_t>(a) * terms_.rows + static_cast<std::size_t>(b));
    }
    Interval effect(int row, const Column& column) const {
        const Interval along = W(row, column.row);
        return column.other < 0 ? along : along + column.part * W(row, column.other);
    }
    Interval rate(int row) const { return program_.output(terms_.rows * terms_.rows + static_cast<std::size_t>(row)); }

    // Elimination without exchanges: all leading minors are determinants of combinations, or means of such.
    std::optional<std::size_t> doubt_of_combination() {
        const std::size_t n = columns_.size();
        std::vector<std::vector<Interval>> A(n, std::vector<Interval>(n + 1, Interval(0.0)));
        for (std::size_t i = 0; i < n; ++i) {
            const int row = columns_[i].kept;
            for (std::size_t k = 0; k < n; ++k) A[i][k] = effect(row, columns_[k]);
            A[i][n] = is_gap(row) ? -(once_ * rate(row)) : -rate(row);
        }
        for (std::size_t i = 0; i < n; ++i) {
            if (!certainly_positive(A[i][i])) return terms_.elements.size();
            for (std::size_t r = i + 1; r < n; ++r) {
                const Interval factor = A[r][i] / A[i][i];
                for (std::size_t k = i + 1; k <= n; ++k) A[r][k] = A[r][k] - factor * A[i][k];
            }
        }
        std::vector<Interval> p(n);
        for (std::size_t i = n; i-- > 0;) {
            p[i] = A[i][n];
            for (std::size_t k = i + 1; k < n; ++k) p[i] = p[i] - A[i][k] * p[k];
            p[i] = p[i] / A[i][i];
        }
        for (std::size_t k = 0; k < terms_.elements.size(); ++k) {
            const ImpactLawTerms::Element& each = terms_.elements[k];
            if (!each.slides) continue;
            Interval change(0.0);
            for (std::size_t i = 0; i < n; ++i) change = change + effect(each.slip, columns_[i]) * p[i];
            if (!certainly_less(abs(change), abs(rate(each.slip)))) return k;
        }
        return std::nullopt;
    }
    bool is_gap(int row) const {
        return std::any_of(terms_.elements.begin(), terms_.elements.end(),
                           [row](const ImpactLawTerms::Element& each) { return each.gap == row; });
    }

    const ImpactLawTerms& terms_;
    const Evaluator<Interval>& program_;
    Interval once_;
    std::vector<Interval> mu_, mu_s_;  // of each element
    std::vector<Column> columns_;
};

}  // namespace

std::optional<BouncingObstacle> doubt_of_impact_law(const ImpactLawTerms& terms, Evaluator<Interval>& program,
                                                    std::uint32_t speed, const Interval& e) {
    if (terms.elements.empty()) return std::nullopt;
    constexpr std::string_view several = "is not proved to have only one motion at its impacts";
    if (terms.elements.size() > max_elements) return BouncingObstacle{terms.elements.back().which, several};
    program.input(speed) = Interval(0.0);
    program.run();
    // No impact adds kinetic energy, so |u| <= sqrt(2 T W_TT) at its end. A moving surface may add some.
    Interval highest(0.0);
    for (const ImpactLawTerms::Element& each : terms.elements) {
        if (!each.depends_on_speed) continue;
        for (const ImpactLawTerms::Element& other : terms.elements)
            if (other.has_moving_surface)
                return BouncingObstacle{each.which, "has a friction that depends on the slip, beside a moving surface"};
        const auto slip = static_cast<std::size_t>(each.slip);
        const Interval W_TT = program.output(slip * terms.rows + slip), T = program.output(program.output_count() - 1);
        highest = max(highest, sqrt(abs(W_TT * T)));
    }
    if (highest.hi() > 0.0) {
        program.input(speed) = Interval(0.0, highest.hi());
        program.run();
    }
    const auto doubt = ImpactLawProof(terms, program, e).doubt();
    if (!doubt) return std::nullopt;
    if (*doubt < terms.elements.size())
        return BouncingObstacle{terms.elements[*doubt].which, "is not proved to keep the direction of its slip"};
    return BouncingObstacle{terms.elements.front().which, several};
}

}  // namespace achilles
