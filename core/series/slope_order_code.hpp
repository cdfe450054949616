// The rules of a slope plan as machine code, for AVX-512: the same bits as slope_order.hpp.
#pragma once

#include <memory>

#include "series/slope_kinds.hpp"

namespace achilles {

class MachineCode;

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

}  // namespace achilles
