// What a series program has besides, for its slopes.
#pragma once

#include <mutex>

#include "series/slope_order_code.hpp"
#include "series/slope_plan.hpp"

namespace achilles {

struct SlopeProgram {
    std::once_flag made;
    SlopePlan plan;
    std::shared_ptr<const SlopeOrderCode> code;  // may be none
};

}  // namespace achilles
