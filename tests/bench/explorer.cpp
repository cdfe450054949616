// Response times of the explorer: medians, of processor time where one thread works, else of wall time.
// bench_explorer            all limits: drawing lists of a frame 5 ms, slider to picture 16 ms, first frame 200 ms
// bench_explorer everything only the first part: all panels open at once, while values change     bench_explorer sweep
// a map of 512 x 512 runs: its first picture, 64 x 64 of them (taskset -c 0: on one core), 100 ms;
// the whole map, 6 s on two cores     bench_explorer bars       derivatives of the last Zeno time of the paper's runs,
// 16 ms (also in the first part)     bench_explorer window     changing values in a real window (xvfb-run has a
// display): the longest frame while runs                               of 100 000 impacts are simulated one after the
// other
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>

#include "app/open.hpp"
#include "bench/measure.hpp"
#include "figure/mechanism_scene.hpp"
#include "model/read_system.hpp"
#include "surface/interface.hpp"
#include "surface/window.hpp"

namespace achilles {
namespace {

double wall_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class Work>
double median_ms(int times, double (*clock)(), const Work& work) {
    std::vector<double> all;
    for (int i = 0; i < times; ++i) {
        const double begin = clock();
        work(i);
        all.push_back(1e3 * (clock() - begin));
    }
    return bench::median(all);
}

void say(const std::string& what, double milliseconds, double bar) {
    fmt::print("{:<58} {:8.2f} ms   {}\n", what, milliseconds,
               bar <= 0.0 ? "" : fmt::format("bar {:g} ms: {}", bar, milliseconds <= bar ? "met" : "NOT MET"));
}

struct Desk {
    explicit Desk(const std::string& system, std::initializer_list<const char*> journal = {})
        : session(test::session(system)), interface(test::surface(width, height)) {
        for (const char* line : journal) session.apply(parse_command(line));
        const Interface::Active active(interface);
        for (int i = 0; i < 5; ++i) frame();
    }
    void frame() {
        apply(Input{});
        interface.frame([&] { explorer(session, panels); }, width, height, 1.0 / 60.0);
    }
    static constexpr int width = 1600, height = 1000;
    Session session;
    PanelState panels = test::panels();
    Interface interface;
};

void frames() {
    for (const auto& [what, system, change] : {std::tuple{"the paper's ball", "ball_on_sine", "end 20"},
                                               std::tuple{"the paper's pendulum", "double_pendulum", "end 20"},
                                               std::tuple{"bouncing for ever", "ball_on_floor", "end 100000"}}) {
        Desk desk(system, {"grid 3 2", std::string(system) == "ball_on_floor" ? "set e 1" : "pause", change});
        const Interface::Active active(desk.interface);
        for (int i = 0; i < 3; ++i) desk.frame();
        const double still = median_ms(60, bench::thread_seconds, [&](int) { desk.frame(); });
        say(fmt::format("{} ({} impacts): lists of a frame, 6 plots", what,
                        desk.session.trajectory().statistics.impacts),
            still, 5.0);
        desk.session.apply(parse_command("show equations"));
        for (int i = 0; i < 3; ++i) desk.frame();
        say("    the same with the equations", median_ms(60, bench::thread_seconds, [&](int) { desk.frame(); }), 5.0);
        desk.session.apply(parse_command("hide equations"));
        desk.session.apply(parse_command("show energy"));
        for (int i = 0; i < 3; ++i) desk.frame();
        say("    the same with the energy", median_ms(60, bench::thread_seconds, [&](int) { desk.frame(); }), 5.0);
        desk.session.apply(parse_command("hide energy"));
        for (const char* line : {"camera zeno", "show strobe", "step 8"}) desk.session.apply(parse_command(line));
        for (int i = 0; i < 3; ++i) desk.frame();
        say("    the same near a Zeno point, with the poses at events",
            median_ms(60, bench::thread_seconds, [&](int) { desk.frame(); }), 5.0);
        for (const char* line : {"camera fit", "hide strobe"}) desk.session.apply(parse_command(line));
        desk.session.apply(parse_command("select 1"));
        for (int i = 0; i < 3; ++i) desk.frame();
        say("    the same with an event chosen", median_ms(60, bench::thread_seconds, [&](int) { desk.frame(); }), 5.0);
    }
}

// Equations, energy, poses at events, and three runs of which two are pinned. Measures the response to a changed value,
// with the waiting times of a window but without drawing.
void everything() {
    for (const auto& [what, system, change] : {std::tuple{"the paper's ball", "ball_on_sine", "end 20"},
                                               std::tuple{"bouncing for ever", "ball_on_floor", "end 100000"}}) {
        const bool is_long = std::string(system) == "ball_on_floor";
        Desk desk(system, {"grid 3 2", is_long ? "set e 1" : "pause", change, "pin", "set g 9", "pin", "set g 8",
                           "show equations", "show energy", "show strobe"});
        const Interface::Active active(desk.interface);
        for (int i = 0; i < 3; ++i) desk.frame();
        say(fmt::format("{}, everything open: lists of a frame", what),
            median_ms(60, bench::thread_seconds, [&](int) { desk.frame(); }), 5.0);
        desk.session.set_patience(1.0 / 40.0);
        double longest_change = 0.0, longest_arrival = 0.0;
        int arrived = 0;
        for (int i = 0; i < 40 || (arrived < 3 && i < 4000); ++i) {
            const bool was_under_way = desk.session.under_way() != nullptr;
            const double begin = wall_seconds();
            desk.session.update();
            const bool arrives = was_under_way && desk.session.under_way() == nullptr;
            if (i % 10 == 0 && !was_under_way) desk.session.apply(command::Set{"g", 8.0 + 1e-3 * (i % 97)});
            desk.frame();
            (arrives ? longest_arrival : longest_change) =
                std::max(arrives ? longest_arrival : longest_change, 1e3 * (wall_seconds() - begin));
            arrived += arrives ? 1 : 0;
            if (was_under_way && !arrives) std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        say("    the longest frame with a change of a value", longest_change, 50.0);
        if (arrived > 0) say("    the longest frame that takes a run in", longest_arrival, 50.0);
    }
}

void sliders() {
    for (const char* system : {"ball_on_sine", "double_pendulum", "triple_pendulum"}) {
        Desk desk(system, {"grid 3 2"});
        const Interface::Active active(desk.interface);
        const double all = median_ms(60, wall_seconds, [&](int i) {
            desk.session.apply(command::Set{"g", 1.0 + 0.01 * i});
            desk.frame();
        });
        say(fmt::format("{}: slider to new picture, 6 plots", system), all, 1e3 / 60.0);
        const double text = median_ms(30, bench::thread_seconds, [&](int i) {
            parse_system(desk.session.document().text + std::string(static_cast<std::size_t>(i), '\n'), "text");
            const Model model(desk.session.description());
        });
        say(fmt::format("{}: a typed text read and derived", system), text, 0.0);
    }
}

// Derivatives of the last Zeno time of the paper's runs by every parameter and initial value: the time for a finished
// run, and the time from a slider to the bars under all sliders.
void bars() {
    for (const char* system : {"ball_on_sine", "double_pendulum"}) {
        Desk desk(system, {"grid 3 2", "show depend"});
        const Interface::Active active(desk.interface);
        desk.session.settle();
        const auto run = std::make_shared<const Trajectory>(simulate(desk.session.model(), desk.session.run()));
        const std::string quantity = default_quantity(*run);
        std::size_t directions = 0;
        const double made =
            median_ms(40, bench::thread_seconds, [&](int) { directions = sensitivities_of(quantity, run).all.size(); });
        say(fmt::format("{}: {} by {} values", system, quantity, directions), made, 1e3 / 60.0);
        const double g = *desk.session.value("g");
        int late = 0;
        const double all = median_ms(60, wall_seconds, [&](int i) {
            desk.session.apply(command::Set{"g", g * (1.0 + 1e-4 * i)});
            desk.session.update();
            late += desk.session.sensitivities_are_current() ? 0 : 1;
            desk.frame();
        });
        say(fmt::format("    slider to new bars, 6 plots ({} of 60 a frame late)", late), all, 1e3 / 60.0);
        const double alone =
            median_ms(40, bench::thread_seconds, [&](int) { simulate(desk.session.model(), run->run); });
        say("    the run alone", alone, 0.0);
    }
}

void start() {
    say("session, fonts and lists of the first frame",
        median_ms(7, wall_seconds,
                  [](int) {
                      PanelState panels = test::panels();
                      const Session session = test::session("ball_on_sine");
                      Interface interface(test::surface(Desk::width, Desk::height));
                      const Interface::Active active(interface);
                      apply(Input{});
                      interface.frame([&] { explorer(session, panels); }, Desk::width, Desk::height, 1.0 / 60.0);
                  }),
        200.0);
    say("the same, drawn offscreen and read",
        median_ms(5, wall_seconds,
                  [](int) {
                      PanelState panels = test::panels();
                      const Session session = test::session("ball_on_sine");
                      Offscreen surface(test::surface(Desk::width, Desk::height));
                      surface.frame([&] { explorer(session, panels); }, 1);
                  }),
        500.0);
    for (const bool is_long : {false, true}) {
        Offscreen surface(test::surface(Desk::width, Desk::height));
        Session session = test::session("ball_on_floor");
        session.apply(parse_command("grid 3 2"));
        if (is_long)
            for (const char* line : {"set e 1", "end 100000"}) session.apply(parse_command(line));
        PanelState panels = test::panels();
        say(fmt::format("a frame with 6 plots, {} impacts, drawn and read", session.trajectory().statistics.impacts),
            median_ms(9, wall_seconds, [&](int) { surface.frame([&] { explorer(session, panels); }, 1); }), 0.0);
    }
}

// Runs of 100 000 impacts are requested, canceled, shown and discarded as in explore.cpp.
void window() {
    Session session = test::session("ball_on_floor", 1.0 / 40.0);
    session.apply(parse_command("grid 3 2"));
    session.apply(parse_command("end 100000"));
    PanelState panels = test::panels();
    panels.in_window = true;
    SurfaceOptions options = test::surface(Desk::width, Desk::height);
    Window window(options, "Achilles");
    session.on_ready(Window::wake);
    std::vector<double> idle, busy, fed;
    double last = 0.0;
    int frame = 0, arrived = 0;
    window.run([&] {
        const double now = wall_seconds();
        const bool was_under_way = session.under_way() != nullptr;
        if (frame > 10) (was_under_way ? busy : idle).push_back(1e3 * (now - last));
        last = now;
        session.update();
        if (was_under_way && session.under_way() == nullptr) {
            ++arrived;
            fed.push_back(1e3 * (wall_seconds() - now));
        }
        explorer(session, panels);
        ++frame;
        // Drags: a new value in some frames, and pauses in which a run can finish.
        if (frame > 20 && frame % 30 < 4) session.apply(command::Set{"e", 1.0 - 1e-12 * (frame % 30)});
        if (frame > 150 || arrived > 6) window.close();
    });
    const auto report = [](const char* what, std::vector<double> all) {
        if (all.empty()) return fmt::print("{}: none\n", what);
        fmt::print("{:<44} {:5} frames, median {:7.1f} ms, longest {:7.1f} ms\n", what, all.size(), bench::median(all),
                   *std::max_element(all.begin(), all.end()));
    };
    fmt::print("{} impacts in the run that is shown; {} runs arrived\n", session.trajectory().statistics.impacts,
               arrived);
    report("frames while nothing runs", idle);
    report("frames while a run is under way", busy);
    report("taking a finished run in", fed);
}

double process_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// A step of a slider in its parts. What is drawn by software is measured on all threads.
void steps() {
    for (const double end : {20.0, 200.0, 2000.0}) {
        Session session = test::session("ball_on_sine");
        session.apply(command::SetEndTime{end});
        PanelState panels = test::panels();
        panels.in_window = true;
        Offscreen surface(test::surface(Desk::width, Desk::height));
        const FrameFunction draw = [&] { explorer(session, panels); };
        surface.frame(draw, 5);
        const auto e = [](int i) { return 0.5 + 0.004 * i; };
        std::vector<double> parts[8];
        for (int i = 1; i <= 20; ++i) {
            Run run = session.run();
            run.parameters[2] = e(i);
            double last = process_seconds();
            const auto pass = [&](std::size_t part) {
                const double now = process_seconds();
                parts[part].push_back(1e3 * (now - last));
                last = now;
            };
            const Trajectory trajectory = simulate(session.model(), run);
            pass(0);
            const std::vector<Sample> samples = plot_samples(trajectory);
            pass(1);
            const MechanismScene scene(session.mechanism(), trajectory, samples);
            pass(2);
            session.plotted().compose(trajectory, samples, session.theme());
            pass(3);
            estimate_error(trajectory);
            pass(4);
            session.apply(command::Set{"e", e(i)});
            session.settle();
            last = process_seconds();
            surface.step(draw);
            pass(5);
            surface.step(draw);
            pass(6);
            surface.frame(draw, 1);
            pass(7);
        }
        fmt::print("end {} s, processor time, ms:", end);
        for (std::size_t part = 0; part < 8; ++part) {
            constexpr const char* names[] = {"run",      "samples",     "scene",       "plots",
                                             "estimate", "first lists", "lists again", "lists, pixels and reading"};
            fmt::print(" {} {:.1f},", names[part], bench::median(parts[part]));
        }
        fmt::print("\n");
    }
}

// A map from the change of a slider on, as the panel receives its parts.
void sweep() {
    const std::pair<const char*, const char*> maps[] = {
        {"ball_on_sine", "--over x=0:6:512 --over x'=0:3:512 --print x"},
        {"double_pendulum", "--over e=0.1:0.9:512 --over theta1=0.2:1:512 --print theta1"}};
    for (const auto& [system, text] : maps) {
        Session session = test::session(system);
        std::vector<double> first;
        double all = 0.0;
        for (int round = 0; round < 5; ++round) {
            SweepSpec sweep = read_sweep(text, session.description());
            sweep.base.options.end_time += 1e-9 * round;  // so that the sweep differs from the one before
            SweepJob job;
            const double begin = wall_seconds();
            job.ask(session.model(), sweep);
            while (!job.data() || !job.is_current() || job.data()->count() < 4096) job.update(0.0005);
            first.push_back(1e3 * (wall_seconds() - begin));
            if (round > 0) continue;
            job.update({});
            all = 1e3 * (wall_seconds() - begin);
        }
        say(std::string(system) + ": a map's first 64 x 64", bench::median(first), 100.0);
        say("    all 512 x 512", all, 6000.0);
    }
}

}  // namespace
}  // namespace achilles

int main(int count, char** words) {
    if (count > 1 && std::string(words[1]) == "window") {
        achilles::window();
        return 0;
    }
    if (count > 1 && std::string(words[1]) == "sweep") {
        achilles::sweep();
        return 0;
    }
    if (count > 1 && std::string(words[1]) == "steps") {
        achilles::steps();
        return 0;
    }
    if (count > 1 && std::string(words[1]) == "bars") {
        achilles::bars();
        return 0;
    }
    achilles::everything();
    if (count > 1) return 0;
    achilles::frames();
    achilles::sliders();
    achilles::bars();
    achilles::start();
}
