#include "study/measures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "expression/parse.hpp"
#include "model/behind.hpp"
#include "number/ground.hpp"
#include "simulate/least_gap.hpp"
#include "system/units.hpp"

namespace achilles {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

bool is_settable(const SystemDescription& description, std::string_view name) {
    Run run = default_run(description);
    return find_value(description, run, name) != nullptr;
}

// A unit that the expression alone does not tell: of times, speeds and gaps.
std::string unit_of_print(const SystemDescription& description, const std::string& print) {
    const std::string word = print.substr(0, print.find('('));
    if (word.size() < print.size() && print.find(')') + 1 != print.size()) return "";
    const bool several = description.constraints.size() > 1;
    if (is_settable(description, print)) return unit_of(description, print);
    if (word == "zeno_time" || word == "impact_time" || word == "release_time") return "s";
    if (word == "impact_speed") return several ? "" : unit_of_expression(description, "gap'");
    if (word == "least_gap") return several ? "" : unit_of_expression(description, "gap");
    return unit_of_expression(description, print);
}

// Whether all runs end before anything is asked.
void refuse_late(const Sweep& sweep) {
    const bool varies = std::any_of(sweep.axes.begin(), sweep.axes.end(),
                                    [](const SweepAxis& axis) { return !options_of_axis(axis.name).empty(); });
    const double end = sweep.base.options.end_time;
    if (!varies && sweep.at && sweep.at->after && !(*sweep.at->after < end))
        throw InputError(fmt::format("--after {}", *sweep.at->after), {}, fmt::format("the runs end at {}", end));
}

}  // namespace

RunMeasures::RunMeasures(std::shared_ptr<const Model> model, const Sweep& sweep) : model_(std::move(model)) {
    refuse_late(sweep);
    const SystemDescription& description = model_->description();
    std::vector<Text> texts;
    std::vector<std::string> names;
    for (const std::string& print : sweep.prints) {
        const bool is_word = (print == "held" || print == "outcome") && !is_settable(description, print);
        const Column::Kind kind = !is_word          ? Column::Kind::number
                                  : print == "held" ? Column::Kind::held
                                                    : Column::Kind::outcome;
        columns_.push_back({kind, print, kind == Column::Kind::number ? unit_of_print(description, print) : ""});
        if (kind != Column::Kind::number) continue;
        texts.push_back({print, {}});
        const std::vector<std::string> more = names_in(print);
        names.insert(names.end(), more.begin(), more.end());
    }
    for (const Text& text : texts)  // so that what is wrong is told of one
        behind("--print", text.text, [&](std::span<const Text> one) { return model_->compile_measures(one); });
    measures_ = model_->compile_measures(texts);
    if (sweep.at && sweep.at->kind == Section::Kind::zero) {
        const std::string& zero = sweep.at->expression;
        zero_ = behind("--at", zero, [&](std::span<const Text> one) { return model_->compile_view(one); });
        zero_along_ = model_->compile_section({zero, {}});
        const std::vector<std::string> asked = names_in(zero);
        zero_has_work_ = std::find(asked.begin(), asked.end(), "work") != asked.end();
    }
    const auto asks = [&](std::string_view name) {
        return std::find(names.begin(), names.end(), name) != names.end() && !is_settable(description, name);
    };
    needs_least_gap_ = asks("least_gap");
    const bool jumps_tell_no_loss =
        model_->contacts() > 1 || sweep.base.options.truncation.reinitialization == Reinitialization::euclidean;
    needs_everything_ = sweep.at || needs_least_gap_ || (asks("work") && model_->equations().has_power()) ||
                        (asks("loss") && jumps_tell_no_loss);
}

Measuring::Measuring(const RunMeasures& measures) : measures_(&measures), numbers_(measures.measures_.program) {
    if (measures.zero_) zero_.emplace(*measures.zero_);
}

// Its parameters, and what is of the whole run.
void Measuring::begin(const Trajectory& trajectory) {
    const Run& run = trajectory.run;
    if (!forces_ || parameters_ != run.parameters) {
        parameters_ = run.parameters;
        forces_.emplace(*measures_->model_, parameters_);
        for (Evaluator<double>* evaluator : {&numbers_, zero_ ? &*zero_ : nullptr}) {
            if (evaluator == nullptr) continue;
            for (std::size_t i = 0; i < parameters_.size(); ++i)
                evaluator->input(measures_->model_->layout().parameter(i)) = parameters_[i];
            evaluator->fix();
        }
        if (measures_->zero_along_) {
            const Ground ground;
            zero_bounds_ = BoundsAlong::of(*measures_->model_, *measures_->zero_along_, parameters_);
        }
    }
    if (measures_->needs_least_gap_) least_gap_ = least_gap(trajectory);
}

void Measuring::measure(const Sample& sample, std::span<const Passage> passed, std::vector<double>& numbers) {
    using Kind = RunQuantity::Kind;
    using Of = Event::Kind;
    const std::size_t first = measures_->model_->layout().count();
    const std::vector<RunQuantity>& quantities = measures_->measures_.quantities;
    std::array<int, 3> counts{};
    for (std::size_t i = 0; i < quantities.size(); ++i) numbers_.input(first + i) = nothing;
    for (const Passage& one : passed) {
        const int k = ++counts[static_cast<std::size_t>(one.kind)];
        for (std::size_t i = 0; i < quantities.size(); ++i) {
            const RunQuantity& quantity = quantities[i];
            const bool is_it =
                (quantity.kind == Kind::zeno_time && one.kind == Of::zeno) ||
                (quantity.kind == Kind::release_time && one.kind == Of::release) ||
                (quantity.kind <= Kind::impact_speed && quantity.kind >= Kind::impact_time && one.kind == Of::impact);
            if (!is_it || (quantity.k != 0 && quantity.k != k)) continue;
            numbers_.input(first + i) = quantity.kind == Kind::impact_speed ? one.impact_speed : one.t;
        }
    }
    for (std::size_t i = 0; i < quantities.size(); ++i) {
        const auto count = [&](Of kind) { return static_cast<double>(counts[static_cast<std::size_t>(kind)]); };
        double& input = numbers_.input(first + i);
        if (quantities[i].kind == Kind::impacts) input = count(Of::impact);
        if (quantities[i].kind == Kind::zeno_points) input = count(Of::zeno);
        if (quantities[i].kind == Kind::releases) input = count(Of::release);
        if (quantities[i].kind == Kind::least_gap) input = least_gap_;
    }
    forces_->run_view(numbers_, sample);
    for (std::size_t i = 0; i < numbers_.output_count(); ++i)
        numbers.push_back(std::isfinite(numbers_.output(i)) ? numbers_.output(i) : nothing);
}

void Measuring::at_end(const Trajectory& trajectory, std::vector<double>& numbers) {
    begin(trajectory);
    Sample sample;
    sample.t = trajectory.end_time;
    sample.phase = trajectory.end_phase;
    sample.held = trajectory.end_held;
    sample.contact = !sample.held.empty();
    sample.carriers = trajectory.phases.back().carriers;
    sample.state = trajectory.end;
    sample.work = trajectory.work;
    sample.loss = trajectory.loss;
    const bool has_events = !trajectory.events.empty();
    if (has_events) sequence_ = sequence_of(trajectory);
    measure(sample, has_events ? sequence_ : trajectory.passages, numbers);
}

std::vector<Moment> Measuring::moments(const Trajectory& trajectory, const Section& section) {
    begin(trajectory);
    sequence_ = sequence_of(trajectory);
    if (!zero_) return events_of(trajectory, section);
    const auto value = [&](const Sample& sample) {
        forces_->run_view(*zero_, sample);
        return zero_->output(0);
    };
    return zeros_of(trajectory, section, {value, measures_->zero_has_work_, zero_bounds_ ? &*zero_bounds_ : nullptr});
}

void Measuring::at(const Trajectory&, const Moment& moment, std::vector<double>& numbers) {
    measure(moment.sample, std::span(sequence_).first(moment.events), numbers);
}

}  // namespace achilles
