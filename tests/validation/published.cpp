// The comparisons of the manual's page `validation`: what the literature says, and where the output of a command has it.
#include <cmath>
#include <iterator>
#include <numbers>
#include <stdexcept>

#include "validation/comparison.hpp"

namespace achilles::validation {

namespace {

using nlohmann::json;
using Value = std::function<double(const Output&)>;

constexpr double degree = std::numbers::pi / 180.0;

// The number at a JSON pointer.
Value at(const std::string& pointer) {
    return [=](const Output& output) { return output.json.at(json::json_pointer(pointer)).get<double>(); };
}

// The event of a kind with this number, from 0 on; from -1 backwards they are counted from the end.
const json& event_of(const Output& output, const std::string& kind, int number) {
    std::vector<const json*> found;
    for (const json& event : output.json.at("events"))
        if (event.at("kind") == kind) found.push_back(&event);
    const int count = static_cast<int>(found.size()), place = number < 0 ? count + number : number;
    if (place < 0 || place >= count) throw std::runtime_error("there are only " + std::to_string(count) + " " + kind);
    return *found[static_cast<std::size_t>(place)];
}
Value event(const std::string& kind, int number, const std::string& pointer) {
    return [=](const Output& output) {
        return event_of(output, kind, number).at(json::json_pointer(pointer)).get<double>();
    };
}

// The last row of a table.
Value last_row(const std::string& column) {
    return [=](const Output& output) {
        const auto& heading = output.table.front();
        for (std::size_t i = 0; i < heading.size(); ++i)
            if (heading[i] == column) return std::stod(output.table.back().at(i));
        throw std::runtime_error("there is no column " + column);
    };
}

Value times(double factor, const Value& value) {
    return [=](const Output& output) { return factor * value(output); };
}
Value sum(const Value& a, const Value& b) {
    return [=](const Output& output) { return a(output) + b(output); };
}
Value constant(double value) {
    return [=](const Output&) { return value; };
}
Value absolute(const Value& value) {
    return [=](const Output& output) { return std::abs(value(output)); };
}
// The square of the size of a multiplier, which is its size over two periods.
Value squared_multiplier(const std::string& number) {
    return [=](const Output& output) {
        const json& z = output.json.at("multipliers").at(std::stoul(number));
        return z.at(0).get<double>() * z.at(0).get<double>() + z.at(1).get<double>() * z.at(1).get<double>();
    };
}

Topic rimless_wheel() {
    return {"Rimless wheel",
            "T. McGeer, Passive dynamic walking, Int. J. Robotics Research 9 (1990) 62-82. Slope 6 degrees, eight "
            "spokes; closed forms.",
            {{"orbit rimless_wheel --json -",
              {{"rate after a strike, rad/s", "cos(2a)/sin(2a) sqrt(4 g/l sin(s) sin(a))", "1.252857313378577439",
                event("jump", 0, "/v_after/0"), 12},
               {"multiplier", "cos(2a)^2", "0.5000000000000000", at("/multipliers/1/0"), 12},
               {"time per spoke, s", "elliptic integral", "0.718560916754147305", at("/period"), 12}}}}};
}

Topic simplest_walker() {
    const std::string differences =
        "Garcia's multipliers come from differences of runs whose tolerance is 1e-10, and are off by 0.0011. The state "
        "agrees to that tolerance.";
    const std::string unstable =
        "The same holds for the unstable short step: the state was searched to 1e-10, its multiplier by differences.";
    return {
        "The simplest walking model",
        "M. Garcia, A. Chatterjee, A. Ruina & M. Coleman, J. Biomech. Eng. 120 (1998) 281-288, slope 0.009 rad unless "
        "it "
        "says otherwise; the states and multipliers are those of the program of the paper (M. Garcia, 1998).",
        {{"orbit simplest_walker --json -",
          {{"stance angle after the strike, rad", "program of the paper", "0.20031090049483", event("jump", 0, "/q/0"),
            11, differences},
           {"its rate", "program of the paper", "-0.19983247291764", event("jump", 0, "/v_after/0"), 11, differences},
           {"multiplier, real part", "program of the paper", "-0.19120868949940", at("/multipliers/1/0"), 11,
            differences},
           {"multiplier, imaginary part", "program of the paper", "0.55633363687106", absolute(at("/multipliers/1/1")),
            11, differences},
           {"stance angle after the strike, rad", "extrapolation", "0.2003109005442470893602", event("jump", 0, "/q/0"),
            12},
           {"its rate", "extrapolation", "-0.1998324730049523545376", event("jump", 0, "/v_after/0"), 12},
           {"period", "extrapolation", "3.88246375285137413757", at("/period"), 13},
           {"multiplier, real part", "extrapolation", "-0.1900998410658881", at("/multipliers/1/0"), 12},
           {"multiplier, imaginary part", "extrapolation", "0.5575987766820683", absolute(at("/multipliers/1/1")),
            12}}},
         {"orbit simplest_walker --from start --set theta=0.1939 --set phi=0.3879 --set \"theta'=-0.2039\" --set "
          "\"phi'=-0.0151\" --period 3.1 --json -",
          {{"stance angle of the short step, rad", "program of the paper", "0.19393736960624", event("jump", 0, "/q/0"),
            11, unstable},
           {"its rate", "program of the paper", "-0.20386692731962", event("jump", 0, "/v_after/0"), 11, unstable},
           {"larger multiplier", "program of the paper", "4.000", at("/multipliers/1/0"), 9, unstable},
           {"smaller multiplier", "program of the paper", "0.459", at("/multipliers/2/0"), 9}}},
         {"orbit simplest_walker --continue slope=0.008:0.016 --json -",
          {{"slope of the first period doubling, rad", "text", "0.0151", at("/branch/flips/0/value"), 9}}}}};
}

Topic compass_gait() {
    const std::string map =
        "The report estimates the multipliers of two steps from perturbed runs. Those of one step are -0.1997 +- "
        "0.5445 i "
        "and 0.1316.";
    const std::string diagram =
        "The report gives three digits and no method. Two descriptions of the walker, compass_gait and "
        "compass_gait_floating, take the same steps, and an independent program finds the same slope.";
    return {"Compass gait",
            "A. Goswami, B. Thuilot & B. Espiau, Int. J. Robotics Research 17 (1998) 1282-1301; sections and figures "
            "of their "
            "INRIA report 2996 (1996). Legs of 5 kg with a = b = 0.5 m, hip of 10 kg, slope 3 degrees.",
            {{"orbit compass_gait --json -",
              {{"time of a step, s", "Fig. C.4, read off", "0.735", at("/period"), 11},
               {"time of a step, s", "independent program", "0.734346", at("/period"), 11},
               {"length of a step, m", "independent program", "0.53545",
                [](const Output& output) {
                    const json& q = event_of(output, "jump", 0).at("q");
                    return 2.0 * std::sin(-(q.at(0).get<double>() + q.at(1).get<double>()) / 2.0);
                },
                11},
               {"multipliers of two steps, size", "eq. (3.44)", "0.332", squared_multiplier("1"), 9, map},
               {"third multiplier of two steps", "eq. (3.44)", "0.014", squared_multiplier("3"), 9, map}}},
             {"orbit compass_gait_floating --json -",
              {{"time of two steps, s", "twice the above", "1.46869278231", at("/period"), 12},
               {"way of two steps, m", "twice the above", "1.07089083086", at("/shift/x"), 11}}},
             {"orbit compass_gait --continue slope=0.05:0.08 --json -",
              {{"slope of the first period doubling, degrees", "Sec. 4.2.4", "4.37",
                times(1.0 / degree, at("/branch/flips/0/value")), 10, diagram},
               {"slope of the first period doubling, degrees", "independent program", "4.390898",
                times(1.0 / degree, at("/branch/flips/0/value")), 10}}},
             {"orbit compass_gait --from start --set slope=4.6*pi/180 --set stance=0.029 --set swing=0.3758 --set "
              "\"stance'=0.5505\" --set \"swing'=1.6328\" --period 1.504 --continue slope=0.077:0.09 --json -",
              {{"slope of the second period doubling, degrees", "Sec. 4.2.4", "4.9",
                times(1.0 / degree, at("/branch/flips/0/value")), 10}}},
             {"simulate compass_gait --set a=0 --set b=1 --set mH=1000 --set m=1 --set g=1 --set slope=0.009 --set "
              "stance=-0.191161072169750 --set swing=-0.209161072169750 --set \"stance'=0.199906060087682\" --set "
              "\"swing'=-0.184100586859717\" --end 100 --tolerance 1e-14 --json -",
              {{"feet of mass 1, hip of 1000: stance angle, rad", "P. A. Bhounsule, passivewalker.m (2009)",
                "0.200161072169750", sum(constant(0.009), times(-1.0, event("jump", -1, "/q/0"))), 11},
               {"its rate", "the same", "-0.199906060087682", times(-1.0, event("jump", -1, "/v_after/0")), 11},
               {"rate of the angle between the legs", "the same", "-0.015805473227965",
                times(-1.0, sum(event("jump", -1, "/v_after/0"), event("jump", -1, "/v_after/1"))), 10}}}}};
}

Topic rocking_block() {
    return {
        "Rocking block",
        "G. W. Housner, The behavior of inverted pendulum structures during earthquakes, Bull. Seismol. Soc. Am. 53 "
        "(1963) 403-417. A block of 1 m by 4 m that starts at 0.15 rad.",
        {{"simulate rocking_block --json -",
          {{"rate after an impact over that before", "1 - 3/2 sin(alpha)^2 = 31/34", "0.9117647058823529",
            [](const Output& output) {
                const json& impact = event_of(output, "impact", 0);
                return impact.at("v_after").at(2).get<double>() / impact.at("v_before").at(2).get<double>();
            },
            12},
           {"quarter of the first period, s", "arcosh(1/(1 - phi/alpha))/p", "0.847348192157377",
            event("impact", 0, "/t"), 11,
            "Housner's formula for the period is that of a slender block, whose moment of the weight is linear in "
            "the angle."},
           {"quarter of the first period, s", "elliptic integral", "0.848437408890095", event("impact", 0, "/t"),
            11}}}}};
}

Topic woodpecker() {
    const std::string stepping =
        "The published state is the start of a simulation by time stepping near the periodic run, with four digits. "
        "Its "
        "sleeve starts 0.9 micrometers inside the pole. Achilles gives the state on the periodic run at this angle.";
    return {"Woodpecker toy",
            "R. I. Leine, Ch. Glocker & D. H. van Campen, Proc. ASME DETC 2001, VIB-21608, with its data; the state is "
            "that of the example Woodpecker of Siconos.",
            {{"orbit woodpecker --json -",
              {{"period, s", "extrapolation", "0.14597606514375182353", at("/period"), 12},
               {"fall in a period, m", "extrapolation", "-0.019445379284716526658", at("/shift/y"), 12},
               {"multiplier", "extrapolation", "-0.8391556530475859", at("/multipliers/2/0"), 11}}},
             {"sweep woodpecker --over y=0:0.001:2 --at \"0 - phi - 0.2788\" --after 9.8 --end 10 --tolerance 1e-13 "
              "--print \"y'\" --print \"phi'\" --csv -",
              {{"speed of the sleeve where phi = -0.2788, m/s", "WoodPeckerConsts.h", "-0.3411", last_row("y'"), 7,
                stepping},
               {"rate of the bird there, rad/s", "WoodPeckerConsts.h", "-7.4583", last_row("phi'"), 7, stepping}}}}};
}

Topic stick_slip_belt() {
    return {
        "Stick-slip on a belt",
        "After R. I. Leine, D. H. van Campen, A. de Kraker & L. van den Steen, Nonlinear Dynamics 16 (1998) 41-54: a "
        "coefficient 1/(1 + 3 |u|).",
        {{"orbit stick_slip_belt --from end --json -",
          {{"period, s", "extrapolation", "12.00103129483057864690", at("/period"), 12},
           {"time of slip, s", "extrapolation", "4.295999525480154883",
            [](const Output& output) {
                return output.json.at("period").get<double>() - (event_of(output, "slip", 0).at("t").get<double>() -
                                                                 event_of(output, "stick", 0).at("t").get<double>());
            },
            11}}}}};
}

Topic friction() {
    return {
        "Dry friction in closed form",
        "Textbook mechanics; the stick: Y. Wang & M. T. Mason, Two-dimensional rigid-body collisions with friction, "
        "J. Applied Mechanics 59 (1992) 635-642; the rod: P. Painleve, Comptes Rendus 121 (1895) 112-115.",
        {{"simulate block_on_incline --json -",
          {{"time at which it stops, s", "v/(g (sin(alpha) + mu cos(alpha)))", "0.421922556739427941",
            event("stick", 0, "/t"), 12},
           {"place, m", "-v^2/(2 g (...))", "-0.843845113478855816", event("stick", 0, "/q/0"), 12}}},
         {"simulate spun_disc --json -",
          {{"time at which it rolls, s", "(v + r omega)/(3 mu g)", "1.698946653075093442", event("stick", 0, "/t"), 12},
           {"its speed then, m/s", "(2 v - r omega)/3", "-1.333333333333333", at("/end/v/0"), 12}}},
         {"simulate impacting_stick --json -",
          {{"spin after an impact that ends the slip, rad/s", "closed form", "-7.474691674243159041",
            event("impact", 0, "/v_after/2"), 12}}},
         {"simulate impacting_stick --set mu=0.3 --json -",
          {{"spin after an impact that slides, rad/s", "closed form", "-8.642536515611207181",
            event("impact", 0, "/v_after/2"), 12}}},
         {"simulate painleve_rod --end 0.2 --json -",
          {{"angle at which the motion ends, degrees", "tan(phi) = (3 mu - sqrt(9 mu^2 - 16))/2", "45.00000000000000",
            times(1.0 / degree, at("/end/q/2")), 10}}}}};
}

Topic vibrating_table() {
    return {
        "Ball on a vibrating table",
        "P. J. Holmes, J. Sound Vib. 84 (1982) 173-189; without his approximation: J. M. Luck & A. Mehta, Phys. Rev. E "
        "48 (1993) 3988-3997. One impact per cycle, restitution 0.7; amplitudes in m.",
        {{"orbit ball_on_vibrating_table --from start --set e=0.7 --set a=0.05 --set y=0.1737 --set \"y'=-1.837\" "
          "--period 2*pi/om --continue a=0.02:0.1 --json -",
          {{"amplitude at which the orbit appears", "pi (1 - e)/(1 + e) g/om^2", "0.0348073682052323",
            at("/branch/folds/0/value"), 10},
           {"amplitude of the period doubling", "closed form", "0.0735031858607882", at("/branch/flips/0/value"),
            10}}}}};
}

Topic collapses() {
    struct Reference {
        const char *command, *source, *times[5], *end;
    };
    const Reference references[] = {
        {"simulate slider_crank_clearance --tolerance 1e-14 --eps 1e-12 --json -",
         "quadruple precision",
         {"0.0026925044362526", "0.025872753460352", "0.039763085917002", "0.062029177841626", "0.071896685653581"},
         "7.588340739596945"},
        {"simulate slider_crank_clearance --tolerance 1e-14 --eps 1e-12 --set e=0.1 --json -",
         "quadruple precision",
         {"0.0026925035908552", "0.025872753460032", "0.039763085916443", "0.062029177840777", "0.07189668565255"},
         "7.588340739675127"},
        {"simulate slider_crank_friction --tolerance 1e-14 --eps 1e-12 --json -",
         "Runge-Kutta",
         {"0.0026925044307", "0.0258943678395", "0.03981508743462", "0.06214192419839", "0.0720577573868"},
         "7.573849471527"}};
    std::vector<Command> commands;
    for (const Reference& reference : references) {
        Command command{reference.command, {}};
        for (int k = 0; k < 5; ++k)
            command.rows.push_back({"time of collapse " + std::to_string(k + 1) + ", s", reference.source,
                                    reference.times[k], event("collapse", k, "/t"), 10});
        command.rows.push_back({"crank at t = 0.0838 s, rad", reference.source, reference.end, at("/end/q/0"), 11});
        commands.push_back(command);
    }
    return {"Slider-crank with clearance",
            "P. Flores, R. Leine & Ch. Glocker, Multibody System Dynamics 23 (2010) 165-190, with the data of Table 1: "
            "without friction at the restitutions 0.4 and 0.1, then with the friction 0.01 of the guide. There the "
            "reference is a program of its own: Runge-Kutta steps of order 8, impact by impact.",
            commands};
}

Topic three_balls() {
    return {
        "Three balls in a row",
        "B. Bernu & R. Mazighi, J. Phys. A 23 (1990) 5745-5754, and S. McNamara & W. R. Young, Phys. Fluids A 4 (1992) "
        "496-504: three balls collapse if e < 7 - 4 sqrt(3) = 0.0718. Achilles proves the collapse if e < 9 - 4 "
        "sqrt(5) = "
        "0.0557. Between the two values it says that it cannot decide.",
        {{"simulate three_balls --eps 1e-12 --json -",
          {{"time of the collapse, s", "closed form", "0.1250000000000000", event("collapse", 0, "/t"), 9},
           {"speed afterwards, m/s", "1/3", "0.3333333333333333", at("/end/v/1"), 11},
           {"ratio of the speeds per two impacts", "closed form", "0.1600000000000000",
            event("collapse", 0, "/speed_ratio"), 11},
           {"ratio of the gaps per two impacts", "closed form", "0.01562500000000000",
            event("collapse", 0, "/gap_ratio"), 11}}}}};
}

// The number of steps after which a walk repeats, by the stance angle of its last strikes.
int steps_per_period(const Output& output) {
    constexpr int most = 32;
    constexpr double same = 1e-6;
    const auto stance = [&](int from_end) { return event_of(output, "jump", -from_end).at("q").at(0).get<double>(); };
    for (int steps = 1; steps < most; ++steps) {
        bool repeats = true;
        for (int i = 1; i <= most && repeats; ++i) repeats = std::abs(stance(i) - stance(i + steps)) < same;
        if (repeats) return steps;
    }
    return 0;
}

Topic cascade() {
    const std::string start = " --set stance=0.029 --set swing=0.3758 --set \"stance'=0.5505\" --set \"swing'=1.6328\"";
    std::vector<Command> commands;
    for (const auto& [slope, steps] : {std::pair{"4.3", "1"}, {"4.6", "2"}, {"4.95", "4"}, {"5.03", "8"}})
        commands.push_back({std::string("simulate compass_gait --tolerance 1e-12 --end 240 --json - --set slope=") +
                                slope + "*pi/180" + start,
                            {{"steps in a period", "Sec. 4.2.4", steps,
                              [](const Output& output) { return double{1} * steps_per_period(output); }, 12}}});
    return {"The compass gait on steeper slopes",
            "The same sources: the gait doubles its period again and again as the slope grows, until it is chaotic. "
            "`achilles sweep compass_gait --over slope=0.07:0.0899:600 --at jump --after 150 --end 180 --print stance" +
                start + " --out cascade.svg` draws the whole diagram.",
            commands};
}

Topic impact_oscillator() {
    return {
        "Impact oscillator",
        "S. W. Shaw & P. J. Holmes, J. Sound Vib. 90 (1983) 129-155: one impact in each cycle of the drive, in closed "
        "form. With c = cos(2 pi omega/om): mu1 mu2 = e^2, mu1 + mu2 = -2 e c - (1 + e)^2 (1 + c) (om^2/omega^2 - "
        "1)/2.",
        {{"orbit impact_oscillator --from end --set om=25 --period 2*pi/om --continue om=24:26 --json -",
          {{"impact speed, m/s", "closed form", "3.1955181441076620425", event("impact", 0, "/impact_speed"), 12},
           {"multiplier", "closed form", "-0.92348494032063168969", at("/multipliers/0/0"), 12},
           {"the other one", "closed form", "-0.38982768887926736458", at("/multipliers/1/0"), 12},
           {"frequency of the period doubling, rad/s", "mu = -1", "24.68892981308790991", at("/branch/flips/0/value"),
            10}}}}};
}

Topic impact_pair() {
    return {
        "Impact pair",
        "C. N. Bapat, N. Popplewell & K. McLachlan, J. Sound Vib. 87 (1983) 19-40: two impacts in each cycle, in "
        "closed form. At the phase phi of the left one, d = 2 a sin phi + pi a cos phi (1 + e)/(1 - e). Half a "
        "cycle has the factors m with m1 m2 = e^2 and m1 + m2 = 2 e + (1 - e^2) (pi/2) tan phi, and a whole one "
        "their squares. One of them is 1, and the halves become unequal, where tan phi = -(2/pi) (1 + e)/(1 - e).",
        {{"orbit impact_pair --json -",
          {{"impact speed, m/s", "closed form", "1.74661909448292072519724966639", event("impact", 0, "/impact_speed"),
            12},
           {"multiplier, real part", "closed form", "-0.155711973344056563977729466857615", at("/multipliers/0/0"), 12},
           {"its imaginary part", "closed form", "0.324582472350710610703404190036851", at("/multipliers/0/1"), 12}}},
         {"orbit impact_pair --set a=0.036 --json -",
          {{"multiplier near the loss of symmetry", "closed form", "0.913286909231236283175150694152729",
            at("/multipliers/0/0"), 11},
           {"the other one", "closed form", "0.141905023153229507072857327060989", at("/multipliers/1/0"), 11}}}}};
}

Topic superball() {
    return {"Superball",
            "R. L. Garwin, American J. Physics 37 (1969) 88-92: a ball thrown under a table comes back after three "
            "impacts with 333/343 of its speed and the spin 130/343 v/r.",
            {{"simulate superball --json -",
              {{"speed after the third impact, m/s", "-333/343 v", "-2.9125364431486880466",
                event("jump", 2, "/v_after/0"), 12},
               {"its spin, rad/s", "130/343 v/r", "45.481049562682215743", event("jump", 2, "/v_after/2"), 12}}}}};
}

Topic bouncing_balls() {
    return {
        "Bouncing balls of other programs",
        "HyPro, benchmark Bouncing ball: 10 m above the floor, c = 0.75. heyoka.py, example The wavy ramp, which it "
        "stops where the impacts come too fast; the reference bounces in 50 digits until its flights take 1e-20 s.",
        {{"simulate ball_on_floor --eps 1e-12 --set y=10.06 --set e=0.75 --set \"x'=0\" --end 12 --json -",
          {{"speed of the first impact times c, m/s", "c sqrt(2 g h)", "10.505355776935876816",
            times(0.75, event("impact", 0, "/impact_speed")), 12},
           {"Zeno time, s", "sqrt(2 h/g) (1 + c)/(1 - c)", "9.9949018604894512688", event("zeno", 0, "/t"), 11}}},
         {"simulate wavy_ramp --eps 1e-11 --tolerance 1e-13 --json -",
          {{"third impact, s", "50 digits", "0.5291839436819040729627", event("impact", 2, "/t"), 12},
           {"tenth impact, s", "50 digits", "2.231877267322334167864", event("impact", 9, "/t"), 11},
           {"Zeno time, s", "50 digits", "4.739023057207340706034", event("zeno", 0, "/t"), 10},
           {"place at the Zeno point, m", "50 digits", "3.704001422523984322947", event("zeno", 0, "/q/0"), 10},
           {"speed from there on, m/s", "50 digits", "1.137311845513256657", at("/end/v/0"), 10}}}}};
}

Topic ball_on_sine() {
    const char* const numbers[4][4] = {{"0.35", "2.548936", "3.700511", "10.080307"},
                                       {"0.46", "2.674176", "3.721844", "11.893891"},
                                       {"0.505", "2.731917", "3.733161", "12.546131"},
                                       {"0.52", "2.752971", "3.737297", "12.798791"}};
    std::vector<Command> commands;
    for (const auto& of : numbers)
        commands.push_back({std::string("simulate ball_on_sine --eps 1e-9 --tolerance 1e-12 --json - --set e=") + of[0],
                            {{"first Zeno time, s", "quadruple precision", of[1], event("zeno", 0, "/t"), 10},
                             {"release, s", "quadruple precision", of[2], event("release", 0, "/t"), 10},
                             {"second Zeno time, s", "quadruple precision", of[3], event("zeno", 1, "/t"), 10}}});
    return {"The ball of the paper with other restitutions",
            "Y. Or & A. D. Ames, American Control Conference 2009, Fig. 4, has e = 0.5, which `achilles help paper` "
            "compares. These four restitutions come close to other courses of events.",
            commands};
}

}  // namespace

std::vector<Topic> topics() {
    return {rimless_wheel(),  simplest_walker(),   compass_gait(),    cascade(),
            rocking_block(),  woodpecker(),        stick_slip_belt(), friction(),
            superball(),      impact_oscillator(), impact_pair(),     vibrating_table(),
            bouncing_balls(), collapses(),         three_balls(),     ball_on_sine()};
}

}  // namespace achilles::validation
