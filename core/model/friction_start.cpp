// Model::check_friction(): friction at the start of a run.
#include <fmt/format.h>

#include <cmath>

#include "model/friction_law.hpp"
#include "model/model.hpp"
#include "model/undefined_term.hpp"
#include "system/input_error.hpp"

namespace achilles {

namespace {

// The values that friction has at the start of a run.
class FrictionAtStart {
 public:
    FrictionAtStart(const Model& model, const Run& run, const SlidingPlace& place)
        : model_(model),
          run_(run),
          graph_(model.equations().energy.graph()),
          law_(model.equations().friction.at(place.number)),
          place_(place) {
        const Expression none = graph_.number(0), sliding = graph_.adopt(law_.level);
        Expression h = none, hdot = none;
        if (!is_joint(place_.number)) {
            h = graph_.adopt(model.equations().gaps[place_.number]);
            hdot = graph_.adopt(model.equations().free.contacts[place_.number].hdot);
        }
        outputs_ = {graph_.adopt(law_.slip),         sliding, at_slip_zero(sliding, model.layout(), *place_.level),
                    graph_.adopt(law_.static_level), h,       hdot};
        for (const Expression w : law_.d) outputs_.push_back(graph_.adopt(w));
        program_ = Program(outputs_, model.layout().slots());
        values_ = model.evaluator<Interval>(program_, run.parameters);
        set_state(values_, run.start());
        Interval& speed = values_.input(model.layout().sliding_speed());
        speed = Interval(0.0);
        values_.run();
        speed = abs(values_.output(slip));
        values_.run();
    }

    // Throws Mistake.
    void check() const {
        if (!is_defined(slip)) throw undefined(slip, *place_.slip, "the slip" + of());
        if (!law_.never_slides) check_levels();
        const bool stays_closed = is_joint(place_.number) || (is_zero(gap) && is_zero(gap_rate));
        if (!stays_closed) return;
        std::size_t i = row;
        while (i < outputs_.size() && is_zero(i)) ++i;
        if (i == outputs_.size())
            throw Mistake{place_.slip->at,
                          fmt::format("the slip{} contains no rate at the start: its factors are 0", of()),
                          "choose another start: friction cannot act there"};
        if (law_.never_slides && !is_zero(slip))
            throw Mistake{place_.slip->at,
                          fmt::format("'{}' starts in contact with the slip {:.6g}, but never slides", place_.name,
                                      mid(values_.output(slip))),
                          "choose rates for which the slip is 0, or a finite friction"};
    }

 private:
    enum : std::size_t { slip, level, level_at_zero, static_level, gap, gap_rate, row };  // outputs

    std::string of() const { return fmt::format(" of '{}'", place_.name); }
    bool is_defined(std::size_t i) const { return std::isfinite(rad(values_.output(i))); }
    bool is_zero(std::size_t i) const { return std::abs(mid(values_.output(i))) <= 4.0 * rad(values_.output(i)); }

    Mistake undefined(std::size_t i, const Text& text, const std::string& what) const {
        const std::uint32_t speed[] = {model_.layout().sliding_speed()};
        const Expression size[] = {apply(Operation::sqrt, power(outputs_[slip], 2))};
        const Expression of_state = substitute(outputs_[i], speed, size);
        Mistake mistake = no_value(model_, run_, text.at, what, {&of_state, 1});
        const std::string written = to_text(size[0], model_.slot_names());  // which the file calls slip
        for (std::size_t at = 0; (at = mistake.message.find(written, at)) != std::string::npos;)
            mistake.message.replace(at, written.size(), "slip");
        return mistake;
    }

    void check_value(std::size_t i, const Text& text, const std::string& what) const {
        if (!is_defined(i)) throw undefined(i, text, what);
        if (certainly_negative(values_.output(i)))
            throw Mistake{text.at, fmt::format("{} is negative at the start: {:.6g}", what, mid(values_.output(i))),
                          "friction is 0 or more, whatever the direction of the slip"};
    }

    void check_levels() const {
        const char* const word = is_joint(place_.number) ? "level" : "friction";
        check_value(level, *place_.level, fmt::format("the {}{}", word, of()));
        check_value(level_at_zero, *place_.level, fmt::format("the {}{} at slip 0", word, of()));
        if (place_.static_level == nullptr) return;
        check_value(static_level, *place_.static_level, fmt::format("the static {}{}", word, of()));
        const Interval &sticking = values_.output(static_level), &sliding = values_.output(level_at_zero);
        if (certainly_less(sticking, sliding))
            throw Mistake{place_.static_level->at,
                          fmt::format("the static {0}{1} is {2:.6g} at the start, below its {0} at slip 0, {3:.6g}",
                                      word, of(), mid(sticking), mid(sliding)),
                          "the limit of sticking is at least the friction with which sliding begins"};
    }

    const Model& model_;
    const Run& run_;
    Graph graph_;  // a copy, because threads share the model
    const FrictionLaw& law_;
    const SlidingPlace& place_;
    std::vector<Expression> outputs_;
    Program program_;
    Evaluator<Interval> values_;
};

}  // namespace

void Model::check_friction(const Run& run, const SlidingPlace& place) const {
    FrictionAtStart(*this, run, place).check();
}

}  // namespace achilles
