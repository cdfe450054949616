// Parses and solves orbit requests.
#include "analysis/orbit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "analysis/return_map.hpp"
#include "analysis/sweep.hpp"
#include "expression/name_suggestions.hpp"
#include "expression/parse.hpp"
#include "model/read_expressions.hpp"
#include "sensitivity/chain.hpp"
#include "simulate/simulate.hpp"

namespace achilles {

namespace {

// Splits NAME=REST. Throws InputError about the flag.
std::pair<std::string, std::string> named(const std::string& where, const std::string& text, const char* example) {
    const std::size_t equals = text.find('=');
    if (equals == text.npos || equals == 0) throw InputError(where, {}, "a name and a value are expected", example);
    std::string name = text.substr(0, equals);
    std::erase(name, ' ');
    return {name, text.substr(equals + 1)};
}

// The index of a name in a list. Throws InputError if it is not there.
template <class Named>
std::size_t place_of(const std::string& where, const std::string& name, const std::vector<Named>& all,
                     const char* what) {
    std::vector<std::string> names;
    for (const Named& one : all) names.push_back(one.name);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
        throw InputError(where, {}, fmt::format("there is no {} '{}'{}", what, shown(name), did_you_mean(name, names)),
                         fmt::format("the {}s are: {}", what, fmt::join(names, ", ")));
    return static_cast<std::size_t>(found - names.begin());
}

double limit(const std::string& where, const std::string& text) {
    try {
        return read_number(text).value;
    } catch (const ParseError& error) {
        throw InputError(where, {}, error.what());
    }
}

OrbitRequest::ContinuationRange read_along(const std::string& text, const SystemDescription& description,
                                           const Run& run) {
    const std::string where = "--continue " + shown(text);
    const auto [name, range] = named(where, text, "write --continue e=0.1:0.9");
    OrbitRequest::ContinuationRange along;
    along.parameter = place_of(where, name, description.parameters, "parameter");
    const std::size_t colon = range.find(':');
    if (colon == range.npos)
        throw InputError(where, {}, "a range is expected", fmt::format("write --continue {}=LOW:HIGH", name));
    along.low = limit(where, range.substr(0, colon));
    along.high = limit(where, range.substr(colon + 1));
    if (!(along.low < along.high)) throw InputError(where, {}, "the range must have LOW below HIGH");
    const double value = run.parameters[along.parameter];
    if (!(value >= along.low && value <= along.high))
        throw InputError(
            where, {}, fmt::format("the search starts at {} = {}, outside this range", name, value),
            fmt::format("start inside it, for example with --set {}={}", name, 0.5 * (along.low + along.high)));
    return along;
}

// Starts the run at this state, with the same duration.
void begin_at(Run& run, const State& state, bool with_time) {
    run.q = state.q;
    run.v = state.v;
    if (!with_time) return;
    run.options.end_time += state.t - run.options.start_time;
    run.options.start_time = state.t;
}

// Tightens the tolerances that were not set explicitly to those of tightest_options(), because they determine the
// accuracy of the orbit.
void make_exact(Options& options, const std::set<std::string_view>& set_by_user) {
    const Options exact = tightest_options();
    for (const Option& option : all_options())
        if (option.is_tolerance && !set_by_user.contains(option.key))
            option.set(options, std::min(std::get<double>(option.get(options)), std::get<double>(option.get(exact))));
}

// Checks that the contacts that [orbit] lists as inactive are those with a negative gap at its start.
void check_inactive(const Model& model, const Run& run) {
    const SystemDescription& system = model.description();
    for (std::size_t i = 0; i < model.contacts(); ++i) {
        if (!model.is_conditional(i)) continue;
        auto gap = model.evaluator(model.gap(i), run.parameters);
        set_state(gap, run.start());
        gap.run();
        const double h = gap.output(0);
        const bool is_listed = system.orbit->inactive->contains(i);
        constexpr double rounding = 1e-9;
        if (std::abs(h) > rounding && is_listed != (h < 0.0))
            throw system.error(system.orbit->at,
                               fmt::format("'{}' is {}inactive in [orbit], but its gap is {:.6g} there",
                                           system.constraints[i].name, is_listed ? "" : "not ", h),
                               "the contacts that do not count at the start are those with a negative gap");
    }
}

void read_closing(const OrbitOptions& typed, const Model& model, ReturnCondition& closing) {
    const auto check = [&](const char* flag, const std::string& text) {
        compile_option(flag, text, [&](std::span<const Text> one) { return model.compile_of_parameters(one); });
    };
    if (!typed.period.empty()) {
        check("--period", typed.period);
        closing.period = {typed.period, {}};
    }
    for (const std::string& shift : typed.shifts) {
        const std::string where = "--shift " + shown(shift);
        const auto [name, text] = named(where, shift, "write --shift x=2*pi");
        const std::size_t place = place_of(where, name, model.description().coordinates, "coordinate");
        if (text != free_shift) check("--shift", text);
        closing.shift[place] = {text, {}};
    }
}

}  // namespace

std::string to_text(const OrbitOptions& typed) {
    std::vector<Flag> flags;
    const auto add = [&](const char* flag, const std::string& value) {
        if (!value.empty()) flags.push_back({flag, value});
    };
    add("--from", typed.from);
    add("--period", typed.period);
    for (const std::string& shift : typed.shifts) add("--shift", shift);
    add("--continue", typed.along);
    return to_text(flags);
}

OrbitOptions read_orbit(std::string_view text) {
    OrbitOptions typed;
    const std::vector<std::string> known{"--from", "--period", "--shift", "--continue"};
    for (const Flag& flag : read_flags(text, "orbit")) {
        std::string* const place = flag.name == "--from"       ? &typed.from
                                   : flag.name == "--period"   ? &typed.period
                                   : flag.name == "--continue" ? &typed.along
                                   : flag.name == "--shift"    ? &typed.shifts.emplace_back()
                                                               : nullptr;
        if (place == nullptr)
            throw InputError(
                "orbit", {},
                fmt::format("'{}' is not expected here{}", shown(flag.name), did_you_mean(flag.name, known)));
        if (!place->empty()) throw InputError(shown(flag.name), {}, "it is given twice");
        *place = flag.value;
    }
    return typed;
}

OrbitRequest parse_orbit_request(const OrbitOptions& typed, const Run& run, const std::shared_ptr<const Model>& model) {
    const SystemDescription& description = model->description();
    OrbitRequest question;
    OrbitProblem& whole = question.problem;
    whole.run = run;
    make_exact(whole.run.options, typed.options);
    whole.closing.shift.resize(description.coordinates.size());
    const bool has_clock = !model->equations().autonomous && !typed.options.contains("start_time");
    const auto& orbit = description.orbit;
    if (orbit) {
        whole.closing.period = orbit->period;
        if (!orbit->shift.empty()) whole.closing.shift = orbit->shift;
    }
    if (!typed.guess && !typed.from.empty() && typed.from != "start" && typed.from != "end")
        throw InputError("--from " + shown(typed.from), {}, "start or end is expected");
    question.from_end = !typed.guess && typed.from == "end";
    if (typed.guess) {
        begin_at(whole.run, typed.guess->state, has_clock);
        if (typed.guess->period && typed.period.empty() && whole.closing.period.text.empty())
            whole.closing.period = {fmt::format("{}", *typed.guess->period), {}};
    } else if (orbit && typed.from.empty()) {
        State guess = run.start();
        for (std::size_t i = 0; i < orbit->q.size(); ++i) {
            guess.q[static_cast<Eigen::Index>(i)] = orbit->q[i];
            guess.v[static_cast<Eigen::Index>(i)] = orbit->v[i];
        }
        guess.t = orbit->t.value_or(guess.t);
        begin_at(whole.run, guess, has_clock);
        // Explicit settings take precedence over the guess.
        for (const std::string& setting : typed.settings) assign(whole.run, description, setting);
        if (orbit->inactive) check_inactive(*model, whole.run);
    }
    whole.is_guess = typed.guess || question.from_end || (orbit && typed.from.empty());
    read_closing(typed, *model, whole.closing);
    if (!typed.along.empty()) question.along = read_along(typed.along, description, whole.run);
    Chain::check(whole.run);
    // Reports errors in the request before the search.
    [[maybe_unused]] const ReturnMap possible(model, whole.run, whole.closing);
    return question;
}

OrbitResult solve_orbit_request(OrbitRequest question, const std::shared_ptr<const Model>& model, OrbitMonitor* watch) {
    OrbitProblem& problem = question.problem;
    problem.watch = watch;
    OrbitResult answer;
    if (question.from_end) {
        RunMonitor first;
        if (watch != nullptr) first.stop = watch->stop;
        const Trajectory run = simulate(model, problem.run, &first, Recording::final_state);
        State end = run.end;
        end.t = run.end_time;
        begin_at(problem.run, end, !model->equations().autonomous);
    }
    static_cast<OrbitSearchResult&>(answer) = find_orbit(model, problem);
    if (const auto& along = question.along; along && answer.orbit)
        answer.branch = follow(model, problem, *answer.orbit, along->parameter, along->low, along->high);
    return answer;
}

}  // namespace achilles
