// Neighbours in memory that are worked on at once.
#pragma once

#include <cstddef>
#include <cstring>

namespace achilles {

// Numbers that stand one after the other in memory and are worked on at once: so many doubles as one vector; of other
// numbers each is taken by itself.
template <class Number, std::size_t most>
struct Pack {
    static constexpr std::size_t count = 1;
    using Value = Number;
    static const Number& load(const Number* from) { return *from; }
    template <class Place>
    static void store(const Number& value, Place* to) {
        *to = value;
    }
};
template <std::size_t most>
struct Pack<double, most> {
    static constexpr std::size_t count = most;
    using Value [[gnu::vector_size(most * sizeof(double))]] = double;
    static Value load(const double* from) {
        Value value;
        std::memcpy(&value, from, sizeof value);
        return value;
    }
    static void store(const Value& value, double* to) { std::memcpy(to, &value, sizeof value); }
};

}  // namespace achilles
