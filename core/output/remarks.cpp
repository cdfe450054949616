#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/model.hpp"
#include "number/ground.hpp"
#include "output/output.hpp"

namespace achilles {

namespace {

Remark made_again(const Options& asked, const Options& used) {
    std::string what = fmt::format("tolerance {:g}", used.tolerance);
    for (const char* key : {"eps_q", "eps_v"})
        if (const Option& eps = option(key); eps.get(asked) != eps.get(used)) what += ", " + phrase(eps, used, "{:g}");
    return {fmt::format("made again at tolerance {:g}", used.tolerance),
            fmt::format("undecided at tolerance {:g}: the whole run was made again, at {}", asked.tolerance, what)};
}

// The largest that the gap of a contact has been at the ends of steps.
double largest_gap(const Trajectory& trajectory, std::size_t contact) {
    const Model& model = *trajectory.model;
    auto gap = model.evaluator(model.gap(contact), trajectory.run.parameters);
    const auto at = [&](const State& state) {
        set_state(gap, state);
        gap.run();
        return gap.output(0);
    };
    double largest = at(trajectory.run.start());
    for (const Piece& piece : trajectory.pieces)
        largest = std::max(largest, at(state_in(piece, trajectory.coefficients, model.dof(), piece.end)));
    return largest;
}

// eps has the units of the file, whatever the size of the motion: a bouncing that is small beside it is cut at once.
std::optional<Remark> cut_at_once(const Trajectory& trajectory) {
    constexpr double large_share = 0.01, wanted_share = 1e-4;
    std::vector<std::optional<double>> largest_of(trajectory.model->contacts());  // runs may have very many such events
    for (const Event& event : trajectory.events) {
        if (event.kind != Event::Kind::zeno || event.impacts != 1 || !event.certificate || is_plastic_landing(event) ||
            event.contacts.count() != 1)
            continue;
        std::size_t contact = 0;
        while (!event.contacts.contains(contact)) ++contact;
        const Certificate& c = *event.certificate;
        if (!largest_of[contact]) largest_of[contact] = largest_gap(trajectory, contact);
        const double bound = c.uniform_position.value_or(c.position_bound), largest = *largest_of[contact];
        if (!(bound > large_share * largest) || !(largest > 0.0)) continue;
        const double eps = std::max(least_tolerance, std::pow(10.0, std::floor(std::log10(wanted_share * largest))));
        return Remark{
            "eps is large here",
            fmt::format("eps_q = {:g} is large beside this motion: the bouncing was cut at its first impact, t "
                        "= {:.6g}, where the position is proved to {:.2g}, and the gap is never above {:.2g}: "
                        "try --eps {:g}",
                        trajectory.run.options.truncation.eps_q, event.truncation->t, bound, largest, eps)};
    }
    return std::nullopt;
}

}  // namespace

std::vector<Remark> remarks(const Trajectory& trajectory) {
    const Ground ground;
    std::vector<Remark> all;
    if (trajectory.made_again_by) all.push_back(made_again(trajectory.run.options, *trajectory.made_again_by));
    if (auto remark = cut_at_once(trajectory)) all.push_back(std::move(*remark));
    return all;
}

}  // namespace achilles
