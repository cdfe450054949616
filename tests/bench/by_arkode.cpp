// The SUNDIALS ARKODE program: ERKStep with the dopri5 table and ARKODE's root finding; memory is kept between runs.
// The first step of a flight comes from its predicted duration. Roots before a quarter of that (or shortly after a
// release) are ignored. A plastic impact ends the sequence, and the state in contact is projected.
#include <arkode/arkode_erkstep.h>
#include <nvector/nvector_serial.h>

#include <algorithm>
#include <stdexcept>
#include <sundials/sundials_context.hpp>

#include "bench/by_hand.hpp"

namespace achilles::bench {
namespace {

void check(int flag) {
    if (flag < 0) throw std::runtime_error("ARKODE failed with flag " + std::to_string(flag));
}

template <class Problem>
class Arkode final : public Program {
 public:
    Arkode() : y_(N_VNew_Serial(4, context_)) {
        arkode_ = ERKStepCreate(flight, 0.0, y_, context_);
        check(ERKStepSetUserData(arkode_, this));
        check(ERKStepSetTableNum(arkode_, ARKODE_DORMAND_PRINCE_7_4_5));
        check(ERKStepSetMaxNumSteps(arkode_, 1000000));
        check(ERKStepRootInit(arkode_, 1, crossing));
        check(ERKStepSetNoInactiveRootWarn(arkode_));
        int downwards = -1;
        check(ERKStepSetRootDirection(arkode_, &downwards));
    }
    Arkode(const Arkode&) = delete;
    Arkode& operator=(const Arkode&) = delete;
    ~Arkode() override {
        ERKStepFree(&arkode_);
        N_VDestroy(y_);
    }

    Result run(const Values& start, const Settings& settings) override {
        settings_ = settings;
        check(ERKStepSStolerances(arkode_, settings.tolerance, settings.tolerance));
        std::copy(start.begin(), start.end(), data());
        left_ = settings.end_time;
        blind_ = hint_ = 0.0;
        natural_ = 0.0;  // ARKODE chooses
        result_ = {};
        contact_ = false;
        while (left_ > 0.0) {
            if (contact_) {
                stay();
            } else {
                fly();
            }
        }
        result_.end = values();
        return result_;
    }

 private:
    static int flight(double, N_Vector y, N_Vector rate, void*) { return derivative(Problem::flight, y, rate); }
    static int contact(double, N_Vector y, N_Vector rate, void*) { return derivative(Problem::contact, y, rate); }
    template <class Rates>
    static int derivative(const Rates& rates, N_Vector y, N_Vector rate) {
        Values in, out;
        std::copy_n(NV_DATA_S(y), 4, in.begin());
        rates(in, out);
        std::copy_n(out.begin(), 4, NV_DATA_S(rate));
        return 0;
    }
    // The function whose descent through zero is the event.
    static int crossing(double t, N_Vector y, double* out, void* self) {
        const auto& own = *static_cast<const Arkode*>(self);
        Values in;
        std::copy_n(NV_DATA_S(y), 4, in.begin());
        if (own.contact_) {
            *out = -Problem::normal_acceleration(in);
        } else {
            *out = t > own.blind_ ? Problem::gap(in) : 1.0;
        }
        return 0;
    }

    double* data() { return NV_DATA_S(y_); }
    Values values() {
        Values y;
        std::copy_n(data(), 4, y.begin());
        return y;
    }
    void put(const Values& y) { std::copy(y.begin(), y.end(), data()); }

    // Time starts from 0 in every segment, so that the shortest flight has full relative accuracy.
    void begin() {
        check(ERKStepReInit(arkode_, contact_ ? contact : flight, 0.0, y_));
        check(ERKStepSetStopTime(arkode_, left_));
        const double first = hint_ > 0.0 && natural_ > 0.0 ? std::min(hint_, natural_) : std::max(hint_, natural_);
        check(ERKStepSetInitStep(arkode_, std::min(first, left_)));
    }

    void keep_step(bool hinted) {
        double next = 0.0;
        check(ERKStepGetCurrentStep(arkode_, &next));
        natural_ = hinted ? std::max(natural_, next) : next;
    }

    void fly() {
        begin();
        const bool hinted = hint_ > 0.0;
        double t = 0.0;
        const int flag = ERKStepEvolve(arkode_, left_, y_, &t, ARK_NORMAL);
        check(flag);
        left_ -= t;
        if (flag != ARK_ROOT_RETURN) {
            left_ = 0.0;
            return;
        }
        keep_step(hinted);
        Values y = values();
        const double hdot = Problem::gap_rate(y);
        Values plastic = y;
        bounce<Problem>(plastic, hdot, 0.0);
        if (-hdot < settings_.cut && Problem::normal_acceleration(plastic) < 0.0) {
            project<Problem>(plastic);
            put(plastic);
            contact_ = true;
            ++result_.zenos;
            return;
        }
        ++result_.impacts;
        bounce<Problem>(y, hdot, Problem::e);
        put(y);
        const double a = -Problem::normal_acceleration(y), expected = a > 0.0 ? -2.0 * Problem::e * hdot / a : 0.0;
        hint_ = 1.05 * expected;
        blind_ = a > 0.0 ? 0.25 * expected : 1e-3;
    }

    // Integrates to the next projection or to the release. (ERKStepReset instead of ERKStepReInit lost digits.)
    void stay() {
        hint_ = 0.0;
        begin();
        while (true) {
            double t = 0.0;
            const int flag = ERKStepEvolve(arkode_, left_, y_, &t, ARK_ONE_STEP);
            check(flag);
            Values y = values();
            const bool over = flag == ARK_ROOT_RETURN || flag == ARK_TSTOP_RETURN;
            const double drift = std::max(std::abs(Problem::gap(y)), std::abs(Problem::gap_rate(y)));
            if (!over && drift <= settings_.tolerance) continue;
            project<Problem>(y);
            put(y);
            keep_step(false);
            left_ = flag == ARK_TSTOP_RETURN ? 0.0 : left_ - t;
            if (flag == ARK_ROOT_RETURN) {
                ++result_.releases;
                contact_ = false;
                blind_ = 0.05;
            }
            return;
        }
    }

    sundials::Context context_;
    void* arkode_ = nullptr;
    N_Vector y_;
    Settings settings_;
    bool contact_ = false;
    double left_ = 0.0;     // from the start of this segment to the end of the run
    double natural_ = 0.0;  // the next step by the error control; 0: unknown
    double hint_ = 0.0;     // bound on the first step of the next flight; 0: none
    double blind_ = 0.0;    // no root is looked for before this time of the flight
    Result result_;
};

}  // namespace

template <class Problem>
std::unique_ptr<Program> by_arkode() {
    return std::make_unique<Arkode<Problem>>();
}
template std::unique_ptr<Program> by_arkode<Ball>();
template std::unique_ptr<Program> by_arkode<Pendulum>();

}  // namespace achilles::bench
