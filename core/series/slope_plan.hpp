// How the series of a program rise where what they are made of does: the recurrences of series.hpp, differentiated.
//
// They are linear then, and have fewer products than those of the values: c = a b rises by a b' + b a', s = sin a by c a', and
// r = sqrt a so that 2 r r' = a'. Each is, the values being known,
//     d_0 r'_k = lead a'_k + by sum_j u_j x'_{k-j} (+ by sum_j y_j z'_{k-j}),    0 <= j <= k,
// where r'_k itself, if the right side has it, counts as 0.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace achilles {

class MachineCode;
class SeriesProgram;
struct SlopeTables;

struct SlopePlan {
    // What is multiplied: order 0 is a register's, order k > 0 is coefficient `scale` times that of a series.
    struct Factor {
        std::uint32_t series = 0, value = 0, scale = 0;
        auto operator<=>(const Factor&) const = default;  // NOLINT(modernize-use-nullptr): its 0 is no pointer
    };
    std::vector<Factor> factors;              // by series
    std::vector<std::uint32_t> first_factor;  // of each series, and behind the last

    struct Product {
        std::uint32_t known, rising;  // factors: u and x'
    };
    struct Rule {
        enum class Kind : std::uint8_t { sum, product, power } kind = Kind::sum;
        std::uint32_t result = 0;  // a series
        // A sum of three terms at most: coefficient times series. Series 0 is none.
        std::array<std::uint32_t, 3> series{}, coefficient{};
        // Else the result, a' and d_0 as factors; where there is no d_0, 1.
        std::uint32_t own = 0, leading = 0, divisor = 0;
        double lead = 0.0, by = 1.0;
        bool divides = false;
        bool hidden = false;  // order 0 is not the program's
        std::array<Product, 2> products{};
        std::uint8_t count = 0;  // of products
        // Of a power r = a^b of a number b: r, a and b are `own`, `divisor` and `leading`.
    };
    std::vector<Rule> rules;

    // What is differentiated, as the rules say.
    std::uint32_t series = 0;            // how many
    std::vector<std::uint32_t> outputs;  // accelerations, then event functions
    std::uint32_t events = 0;
    std::size_t coordinates() const { return outputs.size() - events; }
    std::size_t states() const { return 2 * coordinates() + events; }

    // The factors of which more than order 0 is multiplied, as what is known.
    std::vector<std::uint32_t> known_factors() const;

    SlopePlan() = default;
    explicit SlopePlan(const SeriesProgram& program);
};

// The rules of a slope plan as machine code, for AVX-512: the same bits as slope_order.hpp.
//
// After q and v all products of lower orders are added up in one pass, each row of slopes loaded once; then come the rules.
class SlopeOrderCode {
 public:
    // Nothing where that is not to be had.
    static std::shared_ptr<const SlopeOrderCode> of(const SlopePlan& plan);

    // What SlopeKind::make_order makes.
    void make_order(const SlopeTables& tables, std::size_t k) const { function_(&tables, k); }

 private:
    using Function = void(const SlopeTables* tables, std::size_t k);
    std::shared_ptr<const MachineCode> code_;
    Function* function_ = nullptr;
};

// What a series program has besides, for its slopes.
struct SlopeProgram {
    std::once_flag made;
    SlopePlan plan;
    std::shared_ptr<const SlopeOrderCode> code;  // may be none
};

}  // namespace achilles
