// Taylor coefficients of motions by machine code and by loops.
#include "series/series_over.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "core/machine_code.hpp"
#include "core/systems.hpp"

namespace achilles {
namespace {

// The coefficients of a system's motion, made by so many orders at a time: order 21 of q and v alone.
std::vector<double> coefficients_of(const Model& model, Mode mode, int at_once) {
    const Run run = model.default_run();
    const auto n = static_cast<std::size_t>(model.dof());
    SeriesOver<double> series(model.motion(mode).series);
    series.fix(run.parameters);
    std::vector<double> state(run.q.begin(), run.q.end());
    state.insert(state.end(), run.v.begin(), run.v.end());
    constexpr int last = 20;
    if (at_once < last) {
        series.begin(state.data(), 0.25);
        for (int k = 1; k <= last + 1; k += at_once) series.extend(k, std::min(k + at_once - 1, last + 1));
    } else {
        series.expand(state.data(), 0.25, last);
    }
    std::vector<double> all;
    for (int k = 0; k <= last + 1; ++k)
        for (std::size_t i = 0; i < 2 * n + (k > last ? 0 : model.contacts()); ++i)
            all.push_back(series.coefficient(k, i));
    return all;
}

TEST(SeriesOver, HasTheSameBitsByMachineCodeAndByAnyNumberOfOrdersAtOnce) {
    const auto expect_same = [](const std::string& name) {
        SCOPED_TRACE(name);
        const auto model = test::load(name);
        for (const Mode mode : {Mode(), Mode::holding(ContactSet::of(0))}) {
            if (model->contacts() == 0 && !mode.is_free()) continue;
            const std::vector<double> by_code = coefficients_of(*model, mode, 20);
            const test::MachineCodeSwitch off("0");
            const auto without = test::load(name);
            for (const int at_once : {1, 3, 20}) {
                const std::vector<double> by_loops = coefficients_of(*without, mode, at_once);
                ASSERT_EQ(by_code.size(), by_loops.size());
                EXPECT_EQ(std::memcmp(by_code.data(), by_loops.data(), by_code.size() * sizeof(double)), 0) << at_once;
            }
        }
    };
    for (const std::string& name : test::all_systems()) expect_same(name);
    for (const char* name : test::reference_systems) expect_same(name);
}

TEST(SpareTables, AreLentAgainForTheSameSize) {
    constexpr std::size_t size = 3 << 15, larger_size = 4 << 15;
    void* const table = borrow_table(size);
    return_table(table, size);
    void* const larger = borrow_table(larger_size);
    EXPECT_NE(larger, table);
    return_table(larger, larger_size);
    void* const again = borrow_table(size);
    EXPECT_EQ(again, table);
    void* const second = borrow_table(size);
    EXPECT_NE(second, table);
    return_table(second, size);
    return_table(again, size);
}

}  // namespace
}  // namespace achilles
