// Eight runs in four vectors of the size that every processor has.
#include "series/lane_headers.hpp"

#define ACHILLES_LANE_BYTES 16
#include "series/lane_instances.hpp"
