// orbit: a periodic run, its multipliers, its branch.
#include "study/orbit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/commands/commands.hpp"
#include "cli/commands/common.hpp"
#include "cli/terminal.hpp"
#include "expression/nearest.hpp"
#include "figure/orbit_figure.hpp"
#include "model/behind.hpp"
#include "output/orbit.hpp"
#include "output/output.hpp"
#include "pictures/pdf.hpp"
#include "pictures/picture_ending.hpp"
#include "pictures/picture_job.hpp"
#include "pictures/take_away.hpp"
#include "pictures/views.hpp"
#include "simulate/simulate.hpp"

namespace achilles {

namespace {

struct OrbitArguments {
    std::string system, from, period, along, json, out;
    std::vector<std::string> shifts, settings, views;
    OptionOverrides overrides;
    PublicationStyle style;
    PictureSize size;
    PaperSize page;
};

// NAME=REST. Throws InputError about the option.
std::pair<std::string, std::string> named(const char* option, const std::string& text, const char* example) {
    const std::size_t equals = text.find('=');
    if (equals == text.npos || equals == 0)
        throw InputError(fmt::format("{} {}", option, shown(text)), {}, "a name and a value are expected", example);
    std::string name = text.substr(0, equals);
    name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
    return {name, text.substr(equals + 1)};
}

// What is asked for: the file's [orbit], and over it what the command line says. An orbit is as exact as its runs: they are made
// as exactly as double precision allows, unless it says otherwise.
OrbitAsked asked_orbit(const OrbitArguments& arguments, const SystemDescription& description, const Model& model,
                       PictureJob& job) {
    OrbitAsked asked;
    Run& run = asked.run = asked_run(description, arguments.settings, arguments.overrides);
    const Options exact = exact_options();
    for (const Option& option : all_options())
        if (option.is_tolerance && arguments.overrides.given(option) == nullptr)
            option.set(run.options,
                       std::min(std::get<double>(option.get(run.options)), std::get<double>(option.get(exact))));
    const auto given_time = [&] { return arguments.overrides.given(option("start_time")) != nullptr; };
    const auto begin_at = [&](double t) {
        if (given_time() || model.equations().autonomous) return;
        run.options.end_time += t - run.options.start_time;
        run.options.start_time = t;
    };
    asked.closing.shift.resize(description.coordinates.size());
    if (const auto& orbit = description.orbit) {
        asked.closing.period = orbit->period;
        if (!orbit->shift.empty()) asked.closing.shift = orbit->shift;
        if (arguments.from.empty()) {
            asked.is_guess = true;
            for (std::size_t i = 0; i < orbit->q.size(); ++i) {
                run.q[static_cast<Eigen::Index>(i)] = orbit->q[i];
                run.v[static_cast<Eigen::Index>(i)] = orbit->v[i];
            }
            // What is set goes over the guess as well.
            for (const std::string& setting : arguments.settings) assign(run, description, setting);
            if (orbit->t) begin_at(*orbit->t);
        }
    }
    if (!arguments.period.empty()) asked.closing.period = {arguments.period, {}};
    for (const std::string& shift : arguments.shifts) {
        const auto [name, text] = named("--shift", shift, "write --shift x=2*pi");
        std::vector<std::string> names;
        for (const auto& coordinate : description.coordinates) names.push_back(coordinate.name);
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end())
            throw InputError("--shift " + shown(shift), {},
                             fmt::format("there is no coordinate '{}'{}", shown(name), did_you_mean(name, names)),
                             fmt::format("the coordinates are: {}", fmt::join(names, ", ")));
        behind("--shift", text, [&](std::span<const Text> one) { return model.compile_of_parameters(one); });
        asked.closing.shift[static_cast<std::size_t>(found - names.begin())] = {text, {}};
    }
    if (!arguments.period.empty())
        behind("--period", arguments.period,
               [&](std::span<const Text> one) { return model.compile_of_parameters(one); });
    if (arguments.from.empty() || arguments.from == "start") return asked;
    if (arguments.from != "end") {
        const OrbitGuess guess =
            orbit_guess(job.inputs().data(arguments.from), arguments.from, description.coordinates.size());
        asked.is_guess = true;
        run.q = guess.state.q;
        run.v = guess.state.v;
        begin_at(guess.state.t);
        if (guess.period && asked.closing.period.text.empty())
            asked.closing.period = {fmt::format("{}", *guess.period), {}};
        return asked;
    }
    return asked;
}

// --from end: the search begins where the run is at its end.
void go_to_the_end(const std::shared_ptr<const Model>& model, OrbitAsked& asked) {
    const Trajectory run = simulate(model, asked.run, nullptr, Keep::end);
    const double length = asked.run.options.end_time - asked.run.options.start_time;
    asked.run.q = run.end.q;
    asked.run.v = run.end.v;
    if (!model->equations().autonomous) {
        asked.run.options.start_time = run.end_time;
        asked.run.options.end_time = run.end_time + length;
    }
    asked.is_guess = true;
}

struct Along {
    std::size_t parameter = 0;
    double low = 0.0, high = 0.0;
};
Along asked_branch(const std::string& text, const SystemDescription& description, const Run& run) {
    const std::string where = "--continue " + shown(text);
    const auto [name, range] = named("--continue", text, "write --continue e=0.1:0.9");
    std::vector<std::string> names;
    for (const auto& parameter : description.parameters) names.push_back(parameter.name);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
        throw InputError(where, {}, fmt::format("there is no parameter '{}'{}", shown(name), did_you_mean(name, names)),
                         fmt::format("the parameters are: {}", fmt::join(names, ", ")));
    const std::size_t colon = range.find(':');
    if (colon == range.npos)
        throw InputError(where, {}, "a range is expected", fmt::format("write --continue {}=LOW:HIGH", name));
    Along along;
    along.parameter = static_cast<std::size_t>(found - names.begin());
    along.low = number_from(where, range.substr(0, colon));
    along.high = number_from(where, range.substr(colon + 1));
    if (!(along.low < along.high)) throw InputError(where, {}, "the range must have LOW below HIGH");
    const double value = run.parameters[along.parameter];
    if (!(value >= along.low && value <= along.high))
        throw InputError(where, {}, fmt::format("{} = {}, where the search begins, does not lie in it", name, value),
                         fmt::format("--set {}={} begins inside", name, 0.5 * (along.low + along.high)));
    return along;
}

int run(const OrbitArguments& arguments, PictureJob& job) {
    const SystemDescription description = job.inputs().system(arguments.system);
    const auto model = std::make_shared<const Model>(description);
    OrbitAsked asked = asked_orbit(arguments, description, *model, job);
    // A guess may lie below a surface, on which it is put, and out of the sliders' ranges: all else is as of any run.
    const Run told = asked.is_guess ? asked_run(description, arguments.settings, arguments.overrides) : asked.run;
    check_asked(*model, told, arguments.settings);
    warn(description, told);
    std::optional<Along> along;
    if (!arguments.along.empty()) along = asked_branch(arguments.along, description, asked.run);
    const std::vector<ViewDescription> views = views_of(description, arguments.views);
    std::string format;
    if (!arguments.out.empty()) {
        format = format_for(arguments.out, "");
        if (format == "pdf") need_pdf_writer("--out " + arguments.out);
        check(arguments.page, "--width-mm");
        if (format == "png") job.check_size(arguments.size.width, arguments.size.height);
        job.add(arguments.out);
    }
    const std::string text = arguments.json.empty() ? "-" : arguments.json;
    if (text != arguments.out) job.add(text);
    if (arguments.from == "end") go_to_the_end(model, asked);
    ReturnMap(model, asked.run, asked.closing);  // what is wrong with the question is told before the work

    const OrbitSearch found = find_orbit(model, asked);
    if (!found.orbit) {
        print_clean(stderr, "achilles: no periodic run was found: {}\n", found.why);
        return stopped_early;
    }
    std::optional<Branch> branch;
    if (along) branch = follow(model, asked, *found.orbit, along->parameter, along->low, along->high);
    const Branch* const followed = branch ? &*branch : nullptr;
    if (text != arguments.out)
        job.put_text(text, arguments.json.empty() ? printable(orbit_text(*found.orbit, followed))
                                                  : to_json(*found.orbit, followed));
    if (!arguments.out.empty()) {
        PublicationStyle style = arguments.style;
        style.ordered = !arguments.views.empty();
        style.shape = double{1} * arguments.size.width / arguments.size.height;
        const Figure figure =
            branch ? compose_branch(*found.orbit, *branch, views, style) : publication(found.orbit->run, views, style);
        job.put(arguments.out, "", {{arguments.system, &found.orbit->run}}, [&](const Notes& notes) {
            const PictureSize size = size_of(page_for(arguments.page, format), arguments.size, figure, format);
            job.check_size(size.width, size.height);
            return picture_of(figure, size, notes, format);
        });
    }
    job.commit();
    return reached_end;
}

}  // namespace

void add_orbit(CLI::App& program, int& status, PictureJob& job) {
    const auto arguments = std::make_shared<OrbitArguments>();
    CLI::App* command =
        program.add_subcommand("orbit", "A periodic run, with its multipliers, and its branch in a parameter");
    add_system_argument(*command, arguments->system);
    const auto add = [&](const char* flag, std::string& place, const char* type, const char* about) {
        command->add_option(flag, place, about)->type_name(type);
    };
    add("--from", arguments->from, "start|end|FILE",
        "where the search begins: the start of the run, its end, or the state in a file that orbit --json or simulate "
        "--json wrote (default: [orbit] of the system, else the start)");
    add("--period", arguments->period, "EXPRESSION",
        "that of a drive, an expression in the parameters: 2*pi/om; without a drive a guess");
    command
        ->add_option("--shift", arguments->shifts,
                     "a coordinate that has moved on by so much after a period: x=2*pi; may be given again")
        ->type_name("NAME=EXPRESSION")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    add("--continue", arguments->along, "NAME=LOW:HIGH",
        "follow its branch in a parameter, both ways, through folds; it ends where a Zeno point is lost");
    add("--json", arguments->json, "F", "where to write all of it as JSON, instead of text; - is standard output");
    add("--out", arguments->out, "F.png|F.svg|F.pdf", "a picture of one period, or of the branch");
    add_view_option(*command, arguments->views, "of --out: a view of the system; may be given again (default: all)");
    command->add_flag("--transparent", arguments->style.transparent, "of --out: no background");
    command->add_flag("--dark", arguments->style.dark, "of --out: light on dark, for a screen");
    add_page_options(*command, arguments->page);
    add_size_options(*command, arguments->size.width, arguments->size.height, arguments->size.scale);
    add_run_options(*command, arguments->settings, arguments->overrides);
    command->callback([arguments, &status, &job] { status = run(*arguments, job); });
}

}  // namespace achilles
