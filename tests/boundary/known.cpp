// Starts that were decided wrongly in the past, with the digits of the reports.
#include "boundary/families.hpp"
#include "core/systems.hpp"

namespace achilles::test {

namespace {

Question asked(std::shared_ptr<const Model> model, std::array<double, 2> q, std::array<double, 2> v, double end_time,
               bool in_contact = false) {
    Question result{std::move(model), {}, in_contact};
    result.run = result.model->default_run();
    result.run.q << q[0], q[1];
    result.run.v << v[0], v[1];
    result.run.options.end_time = end_time;
    return result;
}

}  // namespace

std::vector<KnownCase> known_cases() {
    std::vector<KnownCase> result;
    const auto add = [&](const std::string& name, const Question& question, Way way, double tolerance,
                         double min_end = 0.0) {
        result.push_back({name, question, way, tolerance, min_end});
    };

    const auto crest =
        asked(written("ab", "(a'^2 + b'^2)/2", "b", "b - 0.25*cos(a)", 0.5), {-1.1410500000000001, 0.10416005219094915},
              {2.0201237165063586, 0.45910920882362767}, 0.77, true);
    // (At 1e-8 dopri5 has no doubt and is right except for the times after the release: it is nearly a touch.)
    for (const Way way : ways) add("a dip of the force at the end of a step", crest, way, 1e-6);
    for (const Way way : {Way::taylor, Way::eight}) add("a dip of the force at the end of a step", crest, way, 1e-8);

    const auto low =
        asked(written("ab", "0.9453125*(a'^2 + b'^2)", "1.890625*b - 0.296875*a",
                      "b - 0.023681640625*sin(8.078125*a) - 0.09375*cos(1.484375*a)", 0.0625),
              {1.0480548592173542, 1.2339401331589663}, {-1.7332196105057307, -1.1107608947996346}, 0.9508598332279208);
    for (const double tolerance : tolerances) add("low impacts, hddot nears zero", low, Way::dopri5, tolerance);

    const auto fourth =
        asked(written("ab", "0.3046875*a'^2 + 0.4375*b'^2", "0.875*b - 0.296875*a",
                      "b - 0.08642578125*sin(5.875*a) + 0.21875*cos(0.875*a)", 0.0625),
              {-0.66499660396276272, 0.78582978907778978}, {1.4581090508588603, -1.3785151046714215}, 1.94655);
    for (const double tolerance : {1e-9, 1e-10, 1e-13})
        add("a fourth impact at 2.6e-7", fourth, Way::taylor, tolerance);

    const auto pendulum = asked(load("double_pendulum"), {-0.16239388192238202, 0.92954240928458709},
                                {0.36799511273198648, -1.1148232405731877}, 4.0);
    for (const Way way : ways) add("an impact stored under the floor", pendulum, way, 1e-6);

    const auto parabola = written("xy", "(x'^2 + y'^2)/2", "0", "y + (x - 1)^2 - 1e-12", 0.5);
    for (const Way way : ways) add("where the doubt is", asked(parabola, {0, 0}, {1, 0}, 2.0), way, 1e-10, 0.99);

    const auto growing = written("xy", "(x'^2 + y'^2)/2", "x*y", "y", 0.5);
    for (const Way way : ways)
        add("no force yet, but it grows", asked(growing, {0, 0}, {1, 0}, 1.0, true), way, 1e-10, 1.0);

    // A post that a step may miss from a distance.
    auto post = asked(
        written("xy", "0.783447265625*(x'^2 + y'^2)", "0.8310546875*y", "y - 0.433837890625*exp(-400*(x - 1)^2)", 0.0),
        {0.64387333732184582, 0.075524473986082988}, {0.56605409931475426, 0.56683650087298454}, 1.5355790056475376);
    auto short_post =
        asked(written("xy", "0.574951171875*(x'^2 + y'^2)", "1.47705078125*y", "y - 0.0888671875*exp(-400*(x - 1)^2)",
                      0.0625),
              {0.33713213844737661, 0.61312292785043887}, {0.8220358199025013, -0.47686400326187373}, 0.8);
    for (Question* question : {&post, &short_post}) {
        question->longest_true_step = 0.01;
        for (const Way way : ways)
            for (const double tolerance : tolerances) add("a thin post", *question, way, tolerance);
    }

    for (const char* gap : {"(2 + sin(x))*y", "y/(1 + x^2)", "exp(x)*y", "(2 + sin(x))*(y + 1)*y"}) {
        const auto flat = written("xy", "(x'^2 + y'^2)/2", "y", gap, 0.5);
        add("a gap that is a product", asked(flat, {0.3, 1.0}, {0.5, 0.0}, 6.0), Way::taylor, 1e-10, 6.0);
    }
    return result;
}

}  // namespace achilles::test
