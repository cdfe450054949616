// Memory of a run: a step allocates none after the first step of its mode, and the record of a typical run is small.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>
#include <set>

#include "core/systems.hpp"
#include "simulate/event_stepper.hpp"
#include "simulate/execution.hpp"

namespace {

thread_local long allocations = 0;

}  // namespace

// Counts the allocations of the test program, which are otherwise those of the C++ library.
void* operator new(std::size_t size) {
    ++allocations;
    if (void* const memory = std::malloc(size == 0 ? 1 : size)) return memory;
    throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    ++allocations;
    return std::malloc(size == 0 ? 1 : size);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace achilles {
namespace {

struct Allocations {
    long by_steps = 0, by_records = 0;  // of steps that end without an event: to make them, and to accept them
    int steps = 0;                      // such steps in a mode that occurred before
};

Allocations allocations_of(const std::string& system, Method method, Recording keep) {
    const auto model = test::load(system);
    Run run = model->default_run();
    run.options.method = method;
    ContactCache surfaces(*model, run);
    ExecutionAutomaton execution(model, run, surfaces, nullptr, keep, ExecutionAutomaton::AmbiguityPolicy::retry_tight);
    EventStepper stepper(*model, run, surfaces);
    Allocations found;
    std::set<Mode> known;
    while (const StepRequest* request = execution.next()) {
        const bool is_first = known.insert(request->mode).second;
        const long before = allocations;
        const StepResult& result = stepper.step(*request);
        const long made = allocations;
        const bool counts = !is_first && result.end == StepResult::StepOutcome::no_event;
        execution.accept(result);
        if (!counts) continue;
        ++found.steps;
        found.by_steps += made - before;
        found.by_records += allocations - made;
    }
    return found;
}

TEST(Allocations, NoneInAStepAfterTheFirstOfItsMode) {
    for (const char* const system : {"ball_on_sine", "double_pendulum", "ball_on_vibrating_table"})
        for (const Method method : test::both_methods) {
            const Allocations found = allocations_of(system, method, Recording::final_state);
            EXPECT_GT(found.steps, 3) << system;
            EXPECT_EQ(found.by_steps, 0) << system << ", " << to_text(method);
            EXPECT_EQ(found.by_records, 0) << system << ", " << to_text(method);
        }
}

// The heap keeps less than 128 kB that is free at its end. More is returned to the system, and the next run obtains it
// again, which takes a tenth of its time.
TEST(Allocations, TypicalRecordsNeedNoMoreMemoryAndStaySmall) {
    for (const char* const system : {"ball_on_sine", "double_pendulum"}) {
        const Allocations found = allocations_of(system, Method::taylor, Recording::full);
        EXPECT_GT(found.steps, 3) << system;
        EXPECT_EQ(found.by_records, 0) << system;
        const auto model = test::load(system);
        const Trajectory trajectory = simulate(model, model->default_run());
        EXPECT_LT(trajectory.events.capacity() * sizeof(Event) + trajectory.pieces.capacity() * sizeof(DenseSegment) +
                      trajectory.coefficients.capacity() * sizeof(double),
                  std::size_t{124} << 10)
            << system;
    }
}

}  // namespace
}  // namespace achilles
