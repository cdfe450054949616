// Everything that lane_steps.hpp uses and that other files use too. The source file of a vector size includes it before
// the pragma that selects them. Templates of these headers are then not compiled for these vectors, even if they are
// instantiated below the pragma, because other files may share them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <type_traits>
#include <vector>

#include "contacts/contact_law.hpp"
#include "number/angle.hpp"
#include "number/double8.hpp"
#include "number/polynomial.hpp"
#include "program/machine.hpp"
#include "program/program.hpp"
#include "series/lane_kinds.hpp"
#include "series/lane_stepper.hpp"
#include "series/order.hpp"
#include "series/series.hpp"
