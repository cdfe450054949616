#include "session/influences.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <utility>

#include "model/model.hpp"
#include "study/measures.hpp"

namespace achilles {

namespace {

// Of one that the sliders set, with the range of its slider and where it stands.
Influences::Of influence(const std::string& name, const std::array<double, 2>& range, double value,
                         const Quantity& quantity, const Derivatives& derivatives) {
    const auto at = std::find(derivatives.directions.begin(), derivatives.directions.end(), name);
    const auto k = static_cast<std::size_t>(at - derivatives.directions.begin());
    Influences::Of one{name, quantity.derivatives[static_cast<Eigen::Index>(k)], 0.0, ""};
    const double reach =
        goes_by_ratios(range[0], range[1]) ? value * std::log(range[1] / range[0]) : range[1] - range[0];
    one.over_slider = one.derivative * reach;
    if (std::isfinite(one.derivative)) return one;
    one.reason = !derivatives.refused[k].empty() ? derivatives.refused[k]
                 : !quantity.refused.empty()     ? quantity.refused
                                                 : "it does not exist there";
    return one;
}

}  // namespace

bool goes_by_ratios(double low, double high) { return low > 0.0 && high / low >= 100.0; }

const Influences::Of* Influences::find(const std::string& name) const {
    const auto found = std::find_if(all.begin(), all.end(), [&](const Of& one) { return one.name == name; });
    return found == all.end() ? nullptr : &*found;
}

double Influences::largest() const {
    double most = 0.0;
    for (const Of& one : all)
        if (std::isfinite(one.over_slider)) most = std::max(most, std::abs(one.over_slider));
    return most;
}

Influences influences_on(const std::string& quantity, const std::shared_ptr<const Trajectory>& run) {
    const Derivatives derivatives = differentiate(*run);
    Influences result{run, Quantities(run->model, {quantity}).of(*run, derivatives).front(), {}, {}};
    Sweep sweep;
    sweep.prints = {quantity};
    result.unit = RunMeasures(run->model, sweep).columns().front().unit;
    const SystemDescription& system = run->model->description();
    const auto add = [&](const std::string& name, const std::array<double, 2>& range, double value) {
        result.all.push_back(influence(name, range, value, result.quantity, derivatives));
    };
    for (std::size_t i = 0; i < system.parameters.size(); ++i)
        add(system.parameters[i].name, system.parameters[i].range, run->run.parameters[i]);
    for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
        const CoordinateDescription& c = system.coordinates[i];
        add(c.name, c.range, run->run.q[static_cast<Eigen::Index>(i)]);
        add(c.name + "'", c.rate_range, run->run.v[static_cast<Eigen::Index>(i)]);
    }
    // What is rounding beside the others is none.
    const double size = std::max(result.largest(), std::abs(result.quantity.value));
    for (Influences::Of& one : result.all)
        if (std::abs(one.over_slider) < 1e-12 * size) one.derivative = one.over_slider = 0.0;
    return result;
}

std::string default_quantity(const Trajectory& run) {
    const auto count = std::count_if(run.events.begin(), run.events.end(),
                                     [](const Event& event) { return event.kind == Event::Kind::zeno; });
    if (count > 0) return "zeno_time(" + std::to_string(count) + ")";
    return run.model->description().coordinates.front().name;
}

double TangentLine::at(double other_x) const {
    return y + slope * (logarithmic ? x * std::log(other_x / x) : other_x - x);
}

bool InfluencesJob::ask(const std::shared_ptr<const Trajectory>& run, const std::string& quantity) {
    if (asked_ && asked_->run == run && asked_->quantity == quantity) return false;
    asked_ = Asked{run, quantity};
    problem_.clear();
    if (made_ != nullptr && (made_->quantity.expression != quantity || made_->run->model != run->model)) made_.reset();
    if (!begun_) begin();
    return true;
}

void InfluencesJob::forget() {
    if (begun_) worker_.start([](const std::stop_token&) { return std::shared_ptr<const Influences>(); });
    asked_.reset(), begun_.reset(), made_.reset();
    problem_.clear();
}

void InfluencesJob::begin() {
    begun_ = asked_;
    worker_.start([asked = *asked_](const std::stop_token&) -> std::shared_ptr<const Influences> {
        return std::make_shared<const Influences>(influences_on(asked.quantity, asked.run));
    });
}

void InfluencesJob::update(Patience patience) {
    using Clock = std::chrono::steady_clock;
    const auto began = Clock::now();
    const auto left = [&]() -> Patience {
        if (!patience) return patience;
        return std::max(0.0, *patience - std::chrono::duration<double>(Clock::now() - began).count());
    };
    while (begun_) {
        std::shared_ptr<const Influences> made;
        std::string problem;
        try {
            const auto taken = worker_.take(left());
            if (!taken) return;
            made = *taken;
        } catch (const InputError& error) {
            problem = error.message + (error.hint.empty() ? "" : ": " + error.hint);
        } catch (const std::bad_alloc&) {
            problem = "there is not enough memory for the derivatives of this run";
        }
        const Asked of = *std::exchange(begun_, std::nullopt);
        if (of.quantity == asked_->quantity && of.run->model == asked_->run->model) {
            made_ = made;
            problem_ = problem;
        }
        if (of == *asked_) return;
        begin();
        if (left() == 0.0) return;  // each is seen, however soon the next is made
    }
}

}  // namespace achilles
