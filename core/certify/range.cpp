#include "certify/range.hpp"

#include <algorithm>

namespace achilles {

Range::Range(Evaluator<Interval> value, Evaluator<Interval> gradient, std::vector<std::uint32_t> slots)
    : value_(std::move(value)), gradient_(std::move(gradient)), slots_(std::move(slots)), slopes_(slots_.size()) {}

Interval Range::evaluate(const std::vector<Interval>& box) {
    for (std::size_t i = 0; i < slots_.size(); ++i) value_.input(slots_[i]) = box[i];
    value_.run();
    return value_.output(0);
}

// Encloses the expression over the face of the box that contains its minimum (or maximum); only the lower (upper) end
// is used. Variables in which the expression is monotone are set to that face. Over the others, plain evaluation and
// the mean-value form are intersected.
Interval Range::bound(const std::vector<Interval>& box, bool upper) {
    face_ = middle_ = box;
    Interval spread(0.0);
    bool point = true;
    for (std::size_t i = 0; i < box.size(); ++i) {
        const bool rises = slopes_[i].lo() >= 0.0, falls = slopes_[i].hi() <= 0.0;
        if (rises || falls) {
            face_[i] = middle_[i] = Interval(rises == upper ? box[i].hi() : box[i].lo());
        } else {
            point = false;
            middle_[i] = Interval(mid(box[i]));
            spread = spread + slopes_[i] * (box[i] - middle_[i]);
        }
    }
    const Interval plain = evaluate(face_);
    if (point || !plain.is_defined()) return plain;
    const Interval mean_value = evaluate(middle_) + spread;
    if (!mean_value.is_defined()) return plain;
    return {std::max(plain.lo(), mean_value.lo()), std::min(plain.hi(), mean_value.hi())};
}

// Mean-value form from the center, with the slopes over the whole box. An undefined slope makes it undefined.
Interval Range::over_part(const std::vector<Interval>& part) const {
    Interval sum = at_center_;
    for (std::size_t i = 0; i < part.size(); ++i) sum = sum + slopes_[i] * (part[i] - center_[i]);
    return sum;
}

Interval Range::over(const std::vector<Interval>& box) {
    for (std::size_t i = 0; i < slots_.size(); ++i) gradient_.input(slots_[i]) = box[i];
    gradient_.run();
    bool smooth = true;
    at_center_ = Interval::undefined();
    for (std::size_t i = 0; i < slots_.size(); ++i) {
        slopes_[i] = gradient_.output(i);
        smooth = smooth && slopes_[i].is_defined();
    }
    constexpr double hardly = 1.0 / 16.0;  // below this, using monotonicity gains less than 1 percent
    if (smooth) {
        center_.resize(box.size());
        for (std::size_t i = 0; i < box.size(); ++i) center_[i] = Interval(mid(box[i]));
        at_center_ = evaluate(center_);
        const Interval near = over_part(box);
        if (near.is_defined() && width(near) <= hardly * mig(near)) return near;
    }
    const Interval plain = evaluate(box);
    if (!plain.is_defined() || !smooth) return plain;
    const Interval least = bound(box, false), greatest = bound(box, true);
    return {std::max(plain.lo(), least.lo()), std::min(plain.hi(), greatest.hi())};
}

}  // namespace achilles
