#include "analysis/measures.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "expression/name_suggestions.hpp"
#include "expression/parse.hpp"
#include "model/read_expressions.hpp"
#include "number/float_environment.hpp"
#include "sensitivity/chain.hpp"
#include "simulate/sampler.hpp"
#include "system/units.hpp"

namespace achilles {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

bool is_settable(const SystemDescription& description, std::string_view name) {
    Run run = default_run(description);
    return find_value(description, run, name) != nullptr;
}

// The unit of a print, including times, speeds and gaps, whose unit does not follow from the expression.
std::string unit_of_print(const SystemDescription& description, const std::string& print) {
    const std::string word = print.substr(0, print.find('('));
    if (word.size() < print.size() && print.find(')') + 1 != print.size()) return "";
    if (is_settable(description, print)) return unit_of(description, print);
    const NamedRunQuantity* const one = run_quantity(word);
    if (one == nullptr || !why_absent(one->quantity, description).empty())
        return unit_of_expression(description, print);
    const bool several = description.constraints.size() > 1;
    switch (one->quantity.kind) {
        case RunQuantity::Kind::time:
            return "s";
        case RunQuantity::Kind::speed:
            return several ? "" : unit_of_expression(description, "gap'");
        case RunQuantity::Kind::least_gap:
            return several ? "" : unit_of_expression(description, "gap");
        case RunQuantity::Kind::count:
            return "";
    }
    return "";
}

// ---- derivatives ----

// The quantity and the name in a print d(QUANTITY, NAME).
struct DerivativeRequest {
    std::string quantity, name;
};

InputError refused_slope(const std::string& print, const std::string& why, const std::string& hint) {
    return {"--print " + shown(print), {}, why, hint};
}

constexpr const char* how_to_differentiate = "write d(QUANTITY, NAME), as in --print \"d(zeno_time(1), e)\"";

std::string without_spaces(const std::string& text) {
    const std::size_t first = text.find_first_not_of(' ');
    return first == text.npos ? "" : text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

// Parses "d(QUANTITY, NAME)"; nullopt for any other print.
std::optional<DerivativeRequest> read_slope(const std::string& print) {
    const std::size_t open = print.find('(');
    if (open == print.npos || without_spaces(print.substr(0, open)) != "d") return std::nullopt;
    std::size_t depth = 0, comma = print.npos, close = print.npos;
    for (std::size_t i = open; i < print.size() && close == print.npos; ++i) {
        if (print[i] == '(') ++depth;
        if (print[i] == ',' && depth == 1) comma = i;
        if (print[i] == ')' && --depth == 0) close = i;
    }
    if (comma == print.npos || close == print.npos)
        throw refused_slope(print, "a derivative needs a quantity and a name", how_to_differentiate);
    if (!without_spaces(print.substr(close + 1)).empty())
        throw refused_slope(print, "a derivative may not be part of an expression",
                            "print it and the other terms one by one");
    const DerivativeRequest request{without_spaces(print.substr(open + 1, comma - open - 1)),
                                    without_spaces(print.substr(comma + 1, close - comma - 1))};
    if (request.quantity.empty() || request.name.empty())
        throw refused_slope(print, "a derivative needs a quantity and a name", how_to_differentiate);
    return request;
}

// Throws InputError if the quantity never has derivatives.
void check_quantity(const SystemDescription& description, const std::string& print, const DerivativeRequest& request) {
    if (read_slope(request.quantity))
        throw refused_slope(print, "second derivatives are not computed",
                            "differences of first derivatives approximate them");
    for (const std::string& name : names_in(request.quantity)) {
        if (is_settable(description, name)) continue;
        if (name == "held" || name == "outcome" || name == "modes")
            throw refused_slope(print, fmt::format("'{}' is text, and has no derivative", name),
                                "print the quantity without d(...)");
        if (is_count_of_events(name))
            throw refused_slope(print, fmt::format("'{}' is a whole number, and has no derivative", name),
                                "print the quantity without d(...)");
        if (name == "least_gap" || name == "work" || name == "loss" || name == "heat")
            throw refused_slope(
                print, fmt::format("derivatives of '{}' are not computed", name),
                "print the quantity without d(...); differences of its values approximate its derivative");
    }
}

// The direction of differentiate() for a name. Throws InputError.
std::size_t direction_of(const SystemDescription& description, const std::string& print, const std::string& name) {
    std::vector<std::string> names;
    for (const auto& coordinate : description.coordinates) names.push_back(coordinate.name);
    for (const auto& coordinate : description.coordinates) names.push_back(coordinate.name + "'");
    for (const auto& parameter : description.parameters) names.push_back(parameter.name);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    const bool is_option = !options_of_axis(name).empty();
    throw refused_slope(print,
                        is_option
                            ? fmt::format("'{}' is an option: there are no derivatives with respect to options", name)
                            : why_not_settable(description, name),
                        "derivatives are with respect to a coordinate or rate at the start, or a parameter");
}

// Throws InputError if no run of the sweep has derivatives.
void check_slopes(const SweepSpec& sweep, const std::string& print) {
    if (sweep.at && !sweep.at->event)
        throw refused_slope(print, fmt::format("there are no derivatives at the zeros of '{}'", sweep.at->expression),
                            "there are derivatives with --at impact, --at zeno, --at release, and without --at");
    Chain::check(sweep.base);
}

// Throws InputError if all runs end before the section begins.
void refuse_late(const SweepSpec& sweep) {
    const bool varies = std::any_of(sweep.axes.begin(), sweep.axes.end(),
                                    [](const SweepAxis& axis) { return !options_of_axis(axis.name).empty(); });
    const double end = sweep.base.options.end_time;
    if (!varies && sweep.at && sweep.at->after && !(*sweep.at->after < end))
        throw InputError(fmt::format("--after {}", *sweep.at->after), {}, fmt::format("the runs end at {}", end));
}

// The program of a section's expression. If it does not compile, a word similar to the name of an event is reported as
// such.
Program section_program(const Model& model, const std::string& zero) {
    try {
        return compile_option("--at", zero, [&](std::span<const Text> one) { return model.compile_view(one); });
    } catch (const InputError&) {
        std::vector<std::string> events, written;
        for (const EventNames& names : possible_events(model)) {
            events.emplace_back(names.word);
            written.push_back("--at " + events.back());
        }
        const std::string best = nearest(zero, events), last = written.back();
        written.pop_back();
        if (best.empty() && zero.find("event") == zero.npos) throw;
        throw InputError(
            "--at " + shown(zero), {}, "unknown event",
            best.empty() ? fmt::format("write {} or {}", fmt::join(written, ", "), last) : "write --at " + best);
    }
}

// Words are not numbers, unless the system gives them another meaning.
RunMeasures::Column::Kind kind_of(const Model& model, const std::string& print) {
    using enum RunMeasures::Column::Kind;
    if (is_settable(model.description(), print)) return number;
    if (print == "modes" && model.has_friction()) return modes;
    return print == "held" ? held : print == "outcome" ? outcome : number;
}

}  // namespace

bool RunMeasures::prints_modes() const {
    return std::any_of(columns_.begin(), columns_.end(),
                       [](const Column& column) { return column.kind == Column::Kind::modes; });
}

RunMeasures::RunMeasures(std::shared_ptr<const Model> model, const SweepSpec& sweep) : model_(std::move(model)) {
    refuse_late(sweep);
    if (sweep.at && sweep.at->event && EventBase{*sweep.at->event}.is_friction() && !model_->has_friction())
        throw InputError(fmt::format("--at {}", names_of(*sweep.at->event).word), {},
                         "only systems with friction have this event");
    if (sweep.at && sweep.at->event == Event::Kind::collapse && (model_->contacts() < 2 || model_->has_friction()))
        throw InputError("--at collapse", {}, "only two contacts without friction can collapse together");
    if (sweep.at && sweep.at->event == Event::Kind::jump && !model_->has_jumps())
        throw InputError("--at jump", {}, "this system has no [[jump]]");
    if (sweep.at && sweep.at->event == Event::Kind::pass && !model_->has_conditional_contacts())
        throw InputError("--at pass", {}, "in this system every contact counts: none has a 'when'");
    const SystemDescription& description = model_->description();
    std::vector<Text> texts;
    std::vector<std::string> names, quantities;
    for (const std::string& print : sweep.prints) {
        if (const auto request = read_slope(print)) {
            add_slope(sweep, print, request->quantity, request->name, quantities);
            continue;
        }
        const Column::Kind kind = kind_of(*model_, print);
        columns_.push_back({kind, print, kind == Column::Kind::number ? unit_of_print(description, print) : ""});
        if (kind != Column::Kind::number) continue;
        slopes_.emplace_back();
        texts.push_back({print, {}});
        const std::vector<std::string> more = names_in(print);
        names.insert(names.end(), more.begin(), more.end());
    }
    for (const Text& text : texts)  // one by one, so that an error refers to its text
        compile_option("--print", text.text, [&](std::span<const Text> one) { return model_->compile_measures(one); });
    measures_ = model_->compile_measures(texts);
    if (!quantities.empty()) quantities_.emplace(model_, quantities, "--print");
    if (sweep.at && !sweep.at->event) {
        const std::string& zero = sweep.at->expression;
        zero_ = section_program(*model_, zero);
        zero_along_ = model_->compile_section({zero, {}});
        const std::vector<std::string> used = names_in(zero);
        zero_has_work_ = std::find(used.begin(), used.end(), "work") != used.end();
    }
    const auto asks = [&](std::string_view name) {
        return std::find(names.begin(), names.end(), name) != names.end() && !is_settable(description, name);
    };
    needs_least_gap_ = asks("least_gap");
    const bool jumps_tell_no_loss =
        model_->contacts() > 1 || sweep.base.options.truncation.reinitialization == Reinitialization::euclidean;
    needs_everything_ = sweep.at || quantities_ || needs_least_gap_ ||
                        (asks("work") && model_->equations().has_power()) || (asks("loss") && jumps_tell_no_loss) ||
                        (asks("loss") && model_->has_jumps()) ||
                        (model_->has_friction() && (asks("work") || asks("heat")));
}

void RunMeasures::add_slope(const SweepSpec& sweep, const std::string& print, const std::string& quantity,
                            const std::string& name, std::vector<std::string>& quantities) {
    const SystemDescription& description = model_->description();
    check_quantity(description, print, {quantity, name});
    const std::size_t direction = direction_of(description, print, name);
    check_slopes(sweep, print);
    const auto known = std::find(quantities.begin(), quantities.end(), quantity);
    slopes_.push_back(Slope{static_cast<std::size_t>(known - quantities.begin()), direction});
    if (known == quantities.end()) quantities.push_back(quantity);
    columns_.push_back({Column::Kind::number, print,
                        unit_of_quotient(unit_of_print(description, quantity), unit_of(description, name)), quantity,
                        name});
}

MeasureEvaluator::MeasureEvaluator(const RunMeasures& measures)
    : measures_(&measures), numbers_(measures.measures_.program) {
    if (measures.zero_) zero_.emplace(*measures.zero_);
}

// Sets the parameters and the quantities of the whole run.
void MeasureEvaluator::begin(const Trajectory& trajectory) {
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
            const FloatEnvironmentGuard ground;
            zero_bounds_ = PathBounds::of(*measures_->model_, *measures_->zero_along_, parameters_);
        }
    }
    if (measures_->needs_least_gap_) least_gap_ = least_gap(trajectory);
}

void MeasureEvaluator::measure(const Sample& sample, std::span<const EventRecord> passed,
                               std::span<const Quantity> differentiated, std::vector<double>& numbers) {
    using Kind = RunQuantity::Kind;
    const std::size_t first = measures_->model_->layout().count();
    const std::vector<RunQuantity>& quantities = measures_->measures_.quantities;
    std::array<int, event_names.size()> counts{};
    for (std::size_t i = 0; i < quantities.size(); ++i)
        numbers_.input(first + i) = quantities[i].kind == Kind::least_gap ? least_gap_
                                    : quantities[i].kind == Kind::count   ? 0.0
                                                                          : nothing;
    for (const EventRecord& one : passed) {
        const int k = ++counts[static_cast<std::size_t>(one.kind)];
        for (std::size_t i = 0; i < quantities.size(); ++i) {
            const RunQuantity& quantity = quantities[i];
            if (quantity.event != one.kind || (quantity.k != 0 && quantity.k != k)) continue;
            double& input = numbers_.input(first + i);
            input = quantity.kind == Kind::count ? k : quantity.kind == Kind::speed ? one.impact_speed : one.t;
        }
    }
    forces_->run_view(numbers_, sample);
    std::size_t next = 0;  // output of the program
    for (const auto& slope : measures_->slopes_) {
        const double number =
            slope ? differentiated[slope->quantity].derivatives[static_cast<Eigen::Index>(slope->direction)]
                  : numbers_.output(next++);
        numbers.push_back(std::isfinite(number) ? number : nothing);
    }
}

void MeasureEvaluator::at_end(const Trajectory& trajectory, std::vector<double>& numbers) {
    begin(trajectory);
    Sample sample;
    sample.t = trajectory.end_time;
    sample.phase = trajectory.end_phase;
    sample.mode = trajectory.end_mode;
    sample.contact = !sample.mode.is_free();
    sample.load_bearing = trajectory.phases.back().load_bearing;
    sample.state = trajectory.end;
    sample.work = trajectory.work;
    sample.loss = trajectory.loss;
    sample.heat = trajectory.heat;
    const bool has_events = !trajectory.events.empty();
    if (has_events) sequence_ = sequence_of(trajectory);
    std::vector<Quantity> differentiated;
    if (measures_->quantities_) {
        derivatives_ = differentiate(trajectory);
        // The time of an early stop depends on all variables, so the end has no derivatives.
        if (trajectory.outcome.kind != Outcome::Kind::end_time) derivatives_->end.reset();
        differentiated = measures_->quantities_->of(trajectory, *derivatives_);
    }
    measure(sample, has_events ? sequence_ : trajectory.passages, differentiated, numbers);
}

std::vector<SectionPoint> MeasureEvaluator::moments(const Trajectory& trajectory, const Section& section) {
    begin(trajectory);
    sequence_ = sequence_of(trajectory);
    if (measures_->quantities_) derivatives_ = differentiate(trajectory);
    if (!zero_) return events_of(trajectory, section);
    const auto value = [&](const Sample& sample) {
        forces_->run_view(*zero_, sample);
        return zero_->output(0);
    };
    return zeros_of(trajectory, section, {value, measures_->zero_has_work_, zero_bounds_ ? &*zero_bounds_ : nullptr});
}

void MeasureEvaluator::at(const Trajectory& trajectory, const SectionPoint& moment, std::vector<double>& numbers) {
    std::vector<Quantity> differentiated;
    if (measures_->quantities_)
        differentiated =
            measures_->quantities_->at(trajectory, *derivatives_, moment.events - 1, moment.sample.load_bearing);
    measure(moment.sample, std::span(sequence_).first(moment.events), differentiated, numbers);
}

RunEnd RunEnd::from(std::uint8_t code) {
    RunEnd end;
    end.code_ = std::min<std::uint8_t>(code, 1 + static_cast<std::uint8_t>(Outcome::Kind::cancelled));
    return end;
}

std::string_view RunEnd::text() const {
    return code_ == 0 ? "cannot start" : to_text(static_cast<Outcome::Kind>(code_ - 1));
}

std::uint64_t signature_of(std::span<const EventRecord> sequence, RunEnd end) {
    std::uint64_t hash = mixed(end.code());
    ContactSet settling;  // contacts that come to rest without another event in between
    for (std::size_t i = sequence.size(); i-- > 0;) {
        const EventRecord& passage = sequence[i];
        if (passage.is_zeno())
            settling = settling.with(passage.contacts);
        else if (passage.is_impact() && passage.contacts.without(settling).empty())
            continue;
        else
            settling = {};
        hash = mixed(hash ^ std::bit_cast<std::uint32_t>(passage.contacts));
        hash = mixed(hash ^ static_cast<std::uint64_t>(passage.kind));
    }
    return hash;
}

}  // namespace achilles
