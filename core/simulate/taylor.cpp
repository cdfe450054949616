#include "simulate/taylor.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace achilles {

namespace {

constexpr int highest = SeriesEvaluator::highest_order;
constexpr int guarded = 10;
constexpr double longest_near = 0x1p29;  // s: all powers up to the highest order are numbers
constexpr double largest_state = 1e150;  // of a state: its square is a number
constexpr int lowest = 5;                // a release is a triple root: the gap needs more terms than that

constexpr auto reciprocals = [] {
    std::array<double, highest + 1> table{};
    for (std::size_t k = 1; k < table.size(); ++k) table[k] = 1.0 / static_cast<double>(k);
    return table;
}();

// Within 0.09: exponent and mantissa as they stand in a positive double. A step made of it is known within 0.09/k.
double rough_log2(double x) { return static_cast<double>(std::bit_cast<std::int64_t>(x)) * 0x1p-52 - 1023.0; }

// The order p at which cost(p)/length(p) is least: a step of order p has a length of about (tolerance)^(1/p) times the
// radius of convergence. The weights are processor cycles, measured: a step on its own, a rule, a lane of inner sums.
int best_order(const SeriesProgram& program, double tolerance) {
    const double step = 1000.0, order = 40.0 + 2.0 * static_cast<double>(program.rules()),
                 square = 0.125 * static_cast<double>(program.inner_sums());
    // The logarithm of cost(p)/length(p) falls as long as its derivative, times p^2 cost(p), is below zero.
    const double digits = -std::log(tolerance);
    int p = lowest;
    while (p < highest - 1 && p * p * (order + 2.0 * square * p) < digits * (step + order * p + square * p * p)) ++p;
    return p;
}

// The sum of the terms' sizes, and that of the last two.
struct Sizes {
    double all, last;
};
Sizes sizes_of(const Polynomial& p) {
    double even = 0.0, odd = 0.0;
    const auto last = static_cast<std::size_t>(p.degree);
    for (std::size_t k = 1; k <= last; k += 2) {
        even += std::abs(p.c[k - 1]);
        odd += std::abs(p.c[k]);
    }
    if (last % 2 == 0) even += std::abs(p.c[last]);
    return {even + odd, std::abs(p.c[last]) + std::abs(p.c[last - 1])};
}

}  // namespace

Taylor::Taylor(const Model& model, const Run& run)
    : dof_(static_cast<std::size_t>(model.dof())),
      width_(2 * dof_ + 1),
      tolerance_(std::max(run.options.tolerance, 0x1p-53)),
      flight_(model.motion({}).series, run.parameters),
      contact_(model.motion(ContactSet::of(0)).series, run.parameters),
      flight_order_(best_order(model.motion({}).series, tolerance_)),
      contact_order_(best_order(model.motion(ContactSet::of(0)).series, tolerance_)),
      rows_((highest + 1) * width_, 0.0),
      units_(width_, 0.0) {}

void Taylor::initialize(ContactSet held, const State& state, const Gap& gap) {
    held_ = held;
    gap_ = gap;
    to_ = state;
    evaluated_ = true;
}

// Where h_0 + h_1 t + h_2 t^2 comes down to zero, or `longest`: after a release, say, all three are nothing.
double Taylor::parabola_root(double longest) const {
    const double h0 = std::max(gap_.h, 0.0), h1 = gap_.hdot, h2 = row(2)[2 * dof_];
    if (!(h2 < 0.0) || (h0 == 0.0 && h1 <= 0.0)) return longest;
    const double root = std::sqrt(h1 * h1 - 4.0 * h0 * h2);
    return std::min(longest, h1 > 0.0 ? (h1 + root) / (-2.0 * h2) : 2.0 * h0 / (root - h1));
}

// m_k: the largest coefficient of order k in units of its tolerance.
double Taylor::size(const double* c) const {
    double largest = 0.0;
    for (std::size_t i = 0; i < width_; ++i) largest = std::max(largest, std::abs(c[i]) * units_[i]);
    return largest;
}

// The same, and which it is. NaN or infinity if one of them is.
Taylor::Magnitude Taylor::magnitude(const double* c) const {
    const double* const units = units_.data();
    double largest = 0.0, sum = 0.0;
    std::size_t component = 0;
    for (std::size_t i = 0; i < width_; ++i) {
        const double size = std::abs(c[i]) * units[i];
        const bool larger = size > largest;
        largest = larger ? size : largest;
        component = larger ? i : component;
        sum += size;
    }
    return {sum < std::numeric_limits<double>::infinity() ? largest : sum, component};
}

// Where order_ is not finite: back to the last order before the first that is not.
StepFailure Taylor::leave_out_infinite() {
    int finite = 0;
    while (finite + 1 < order_ && magnitude(row(finite + 1)).m < std::numeric_limits<double>::infinity()) ++finite;
    order_ = finite;
    power_ = std::pow(target_, order_);
    reached_ = false;
    return order_ >= lowest ? StepFailure::none : StepFailure::left_the_domain;
}

// The series at the state where the stepper stands, to the order that is needed.
StepFailure Taylor::expand(double longest) {
    ++evaluations_;
    const bool flying = held_.empty();
    SeriesEvaluator& series = flying ? flight_ : contact_;
    const std::size_t w = 2 * dof_;
    current_state();
    double* const c = row(0);
    for (std::size_t i = 0; i < dof_; ++i) {
        c[i] = to_.q[static_cast<Eigen::Index>(i)];
        c[dof_ + i] = to_.v[static_cast<Eigen::Index>(i)];
    }
    for (std::size_t i = 0; i < w; ++i) {
        if (!(std::abs(c[i]) < largest_state)) return StepFailure::not_a_number;
        units_[i] = 1.0 / (tolerance_ * (1.0 + std::abs(c[i])));
    }
    series.begin(c);
    for (std::size_t i = 0; i < dof_; ++i)
        if (!(series.start(dof_ + 1 + i) > 0.0)) return StepFailure::left_the_domain;
    c[w] = flying ? gap_.h : series.start(dof_);
    units_[w] = 1.0 / (tolerance_ * (1.0 + std::abs(c[w])));

    // Order 1: q' = v, v' = f; what is watched in flight moves at the gap's rate.
    double* const first = row(1);
    for (std::size_t i = 0; i < dof_; ++i) {
        first[i] = c[dof_ + i];
        first[dof_ + i] = series.start(i);
    }
    series.extend(1, first);
    first[w] = flying ? gap_.hdot : series.output(dof_);

    return extend(series, longest);
}

// A flight is short where its parabola is; what is watched must be known well against its height. No order below
// `lowest` is the last, so these are not looked at.
void Taylor::extend_flight(SeriesMotion& motion, double longest) {
    constexpr double never_small = 1e300;
    motion.largest = row(1) + dof_;
    motion.power = never_small;
    order_ = flight_.extend(motion, 2, lowest - 1);
    target_ = std::min(longest, 1.05 * parabola_root(longest));
    power_ = target_;
    for (int k = 1; k < order_; ++k) power_ *= target_;
    const double height = std::abs(gap_.h) + std::abs(gap_.hdot) * target_;
    if (height > 0.0 && height < 1.0) units_[2 * dof_] = 1.0 / (tolerance_ * height);
}

// Orders from 2 on, until two in a row are small, or as many as pay.
StepFailure Taylor::extend(SeriesEvaluator& series, double longest) {
    const int most = held_.empty() ? flight_order_ : contact_order_;
    SeriesMotion motion;
    motion.row = row(1);
    order_ = 1;
    power_ = target_ = longest;
    if (held_.empty()) extend_flight(motion, longest);
    for (bool small = false;;) {  // the last term was
        const auto [m, largest] = magnitude(row(order_));
        if (!(m < std::numeric_limits<double>::infinity())) return leave_out_infinite();
        const bool now = m * power_ <= 1.0;
        reached_ = small && now;
        if (order_ >= most || (order_ >= lowest && reached_ && (m > 0.0 || three_before_vanish())))
            return StepFailure::none;
        // One large component is enough to go on, if it is not the end.
        const int before = order_;
        motion.largest = row(order_) + largest;
        motion.power = units_[largest] * power_;
        motion.target = target_;
        order_ = series.extend(motion, before + 1, most);
        power_ = motion.power / units_[largest];
        small = now && order_ == before + 1;
    }
}

// Symmetry may hide three terms in a row, not four.
bool Taylor::three_before_vanish() const {
    return size(row(order_ - 1)) + size(row(order_ - 2)) + size(row(order_ - 3)) == 0.0;
}

// As far as it is wanted, or to where the last two terms reach 1. By symmetry they may be much smaller than the first
// ones left out; the two before them tell: half of the step is within their reach. In a series that was cut early these
// are large by right.
double Taylor::natural_step() {
    if (reached_ && order_ < guarded) return target_;
    const int counted = std::min(order_, order_ < guarded ? 2 : 4);
    std::array<double, 4> terms{};
    bool all = true;
    double power = power_;
    for (int i = 0; i < counted; ++i, power /= target_) {
        const int k = order_ - i;
        const double m = terms[static_cast<std::size_t>(i)] = size(row(k));
        all = all && m * power <= (i < 2 ? 1.0 : static_cast<double>(std::int64_t{1} << k));
    }
    if (all) return target_;
    double exponent = std::numeric_limits<double>::infinity();  // of 2
    for (int i = 0; i < counted; ++i) {
        const double m = terms[static_cast<std::size_t>(i)];
        if (m > 0.0)
            exponent = std::min(
                exponent, (i < 2 ? 0.0 : 1.0) - rough_log2(m) * reciprocals[static_cast<std::size_t>(order_ - i)]);
    }
    return std::exp2(exponent);
}

// The even and the odd terms by themselves: half as many sums wait for one another. Two components at a time; q and v
// stand side by side, so there is no odd one.
void Taylor::evaluate(double duration) {
    span_ = duration;
    evaluated_ = true;
    if (duration > longest_near) return evaluate_far(duration);
    using Pair [[gnu::vector_size(2 * sizeof(double))]] = double;
    const double square = duration * duration;
    std::array<double, 2 * max_coordinates> reached;
    for (std::size_t i = 0; i < 2 * dof_; i += 2) {
        const auto of_order = [&](int k) {
            Pair pair;
            std::memcpy(&pair, row(k) + i, sizeof pair);
            return pair;
        };
        Pair even{}, odd{};
        int k = order_;
        if (k % 2 == 0) even = of_order(k--);
        for (; k > 0; k -= 2) {
            odd = odd * square + of_order(k);
            even = even * square + of_order(k - 1);
        }
        const Pair both = even + duration * odd;
        std::memcpy(reached.data() + i, &both, sizeof both);
    }
    std::copy_n(reached.data(), dof_, to_.q.data());
    std::copy_n(reached.data() + dof_, dof_, to_.v.data());
}

StepFailure Taylor::do_step(double longest, double, double least) {
    if (const StepFailure failure = expand(longest); failure != StepFailure::none) return failure;
    const double step = std::min(longest, natural_step());
    if (!(step > least)) return StepFailure::step_too_small;
    span_ = step > longest_near ? within_numbers(step) : step;
    if (span_ == 0.0) return StepFailure::not_a_number;
    evaluated_ = false;
    return StepFailure::none;
}

// An end that nobody asks for, since the step is made again, is not evaluated.
const State& Taylor::current_state() {
    if (!evaluated_) evaluate(span_);
    return to_;
}

// Row k at t, where powers of t may overflow: nothing times infinity is no number, but nothing.
double Taylor::far_term(int k, std::size_t component, double t) const {
    const double c = row(k)[component];
    return c == 0.0 ? 0.0 : c * std::pow(t, k);
}

void Taylor::evaluate_far(double duration) {
    const auto sum = [&](std::size_t component) {
        double value = 0.0;
        for (int k = order_; k >= 0; --k) value += far_term(k, component, duration);
        return value;
    };
    for (std::size_t i = 0; i < dof_; ++i) {
        to_.q.data()[i] = sum(i);
        to_.v.data()[i] = sum(dof_ + i);
    }
}

// A step this long, which only what is nearly a straight line has, or as much of it as stays among the numbers that
// expand() takes. Zero where next to nothing of it does.
double Taylor::within_numbers(double step) {
    constexpr double shorter = 0x1p-8;
    const auto size_at = [&](double t) {
        double sum = 0.0;
        for (int k = 0; k <= order_; ++k)
            for (std::size_t i = 0; i < width_; ++i) sum += std::abs(far_term(k, i, t));
        return sum;
    };
    const bool is_at_the_end = size_at(0.0) > 0.5 * shorter * largest_state;
    while (step > longest_near && !(size_at(step) < largest_state)) step = is_at_the_end ? 0.0 : shorter * step;
    return step;
}

StepFailure Taylor::redo_step(double duration, double least) {
    if (!(duration > least)) return StepFailure::step_too_small;
    evaluate(duration);
    return StepFailure::none;
}

Polynomial Taylor::event_function() const {
    Polynomial p;
    p.degree = order_;
    const std::size_t w = 2 * dof_;
    if (span_ > longest_near) {
        for (int k = 0; k <= order_; ++k) p.c[static_cast<std::size_t>(k)] = far_term(k, w, span_);
        return p;
    }
    double even = 1.0, odd = span_;
    const double square = span_ * span_;
    for (std::size_t k = 0; k <= static_cast<std::size_t>(order_); k += 2, even *= square, odd *= square) {
        p.c[k] = row(static_cast<int>(k))[w] * even;
        if (k < static_cast<std::size_t>(order_)) p.c[k + 1] = row(static_cast<int>(k) + 1)[w] * odd;
    }
    return p;
}

std::uint32_t Taylor::coefficients(std::vector<double>& coefficients) const {
    const std::size_t block = 2 * dof_;
    int degree = order_;
    while (degree > 1 && std::all_of(row(degree), row(degree) + block, [](double x) { return x == 0.0; })) --degree;
    const std::size_t first = coefficients.size();
    coefficients.resize(first + static_cast<std::size_t>(degree + 1) * block);
    double* to = coefficients.data() + first;
    const double* c = row(0);
    double power = 1.0;
    for (int k = 0; k <= degree; ++k, c += width_, to += block, power *= span_)
        for (std::size_t i = 0; i < block; ++i) to[i] = c[i] * power;
    return static_cast<std::uint32_t>(degree);
}

// The terms fall at least by half from one to the next in a step that the tolerance allows, so what is left out is less
// than the last two together, with the rounding of all, and about the tolerance, which is in units of the flight's
// height. A dip within that, and within what the steps before have made, can be neither claimed nor denied.
double Taylor::own_remainder(double size, double last_terms) const {
    return std::max(last_terms + 4.0 * 0x1p-53 * size, 2.0 / units_[2 * dof_]);
}

// How fast the error of the state moves what is watched: the gap's rate, or hddot itself.
double Taylor::drifting() const {
    const std::size_t w = 2 * dof_;
    const double size = held_.empty() ? 2.0 * std::abs(row(2)[w]) + 6.0 * std::abs(row(3)[w])
                                      : std::abs(row(0)[w]) + std::abs(row(1)[w]);
    return gap_.state_error * (1.0 + std::min(size, Gap::steepest));
}

// Of what is watched, at the end of the step.
double Taylor::earlier_error() const {
    if (!held_.empty()) return drifting();
    return gap_.error + (gap_.rate_error + 0.5 * drifting() * span_) * span_;
}

double Taylor::remainder(const Polynomial& p) const {
    const Sizes sizes = sizes_of(p);
    return own_remainder(sizes.all, sizes.last) + earlier_error();
}

// The end is better known than the remainder says of the whole step. But what is left out is wrong in the rate too, as
// many times as there are orders, and moves the gap for a step; terms at the level of rounding tell nothing of what
// is left out. The weights are measured with bench_floor's dips: right or undecided, and at a tolerance of 1e-14 right,
// but for 2 of 3300.
void Taylor::add_error(const Polynomial& p, Gap& end) const {
    const Sizes sizes = sizes_of(p);
    const double left_out = 0.16 * std::max(0.0, sizes.last - 1024.0 * 0x1p-53 * sizes.all);
    end.error = earlier_error() + 0.125 * own_remainder(sizes.all, sizes.last) + left_out;
    end.rate_error = drifting() * span_ + static_cast<double>(p.degree + 1) * left_out / span_;
    end.state_error = gap_.state_error;
}

// By Abel's sums, as first_descent() would find, without the polynomial.
bool Taylor::stays_negative() const {
    const double* c = row(0) + 2 * dof_;
    double term = *c, before = 0.0, sum = term, highest_sum = term, size = std::abs(term), power = 1.0;
    for (int k = 1; k <= order_; ++k) {
        c += width_;
        power *= span_;
        before = term;
        term = *c * power;
        sum += term;
        highest_sum = std::max(highest_sum, sum);
        size += std::abs(term);
    }
    return highest_sum < -(own_remainder(size, std::abs(term) + std::abs(before)) + earlier_error());
}

std::unique_ptr<Stepper> make_taylor(const Model& model, const Run& run) {
    return std::make_unique<Taylor>(model, run);
}

}  // namespace achilles
