// The table of options: every row reads and writes its own member, and no member is missing.
#include "run/options.hpp"

#include <gtest/gtest.h>

#include <set>

namespace achilles {
namespace {

// A valid value that is not the default.
OptionValue another(const Option& option) {
    const OptionValue usual = option.get({});
    if (const auto* number = std::get_if<double>(&usual)) return *number == 0.0 ? 1.0 : 2.0 * *number;
    if (const auto* whole = std::get_if<int>(&usual)) return *whole + 1;
    return option.words[usual == OptionValue(option.words[0]) ? 1 : 0];
}

TEST(Options, EachHasAPlaceOfItsOwn) {
    std::set<std::string_view> keys, flags;
    for (const Option& one : all_options()) {
        SCOPED_TRACE(one.key);
        EXPECT_TRUE(keys.insert(one.key).second);
        EXPECT_TRUE(flags.insert(one.flag).second);
        EXPECT_TRUE(is_valid_value(one, one.get({}))) << "the default";
        ASSERT_TRUE(is_valid_value(one, another(one)));
        Options changed;
        one.set(changed, another(one));
        EXPECT_EQ(one.get(changed), another(one));
        EXPECT_NE(changed, Options{});
        for (const Option& other : all_options()) {
            if (&other == &one) continue;
            EXPECT_EQ(other.get(changed), other.get({})) << other.key;
        }
    }
}

TEST(Options, TheTableHasThemAll) {
    Options all;
    for (const Option& one : all_options()) one.set(all, another(one));
    EXPECT_NE(all.start_time, Options{}.start_time);
    EXPECT_NE(all.end_time, Options{}.end_time);
    EXPECT_NE(all.tolerance, Options{}.tolerance);
    EXPECT_NE(all.method, Options{}.method);
    EXPECT_NE(all.max_impacts, Options{}.max_impacts);
    EXPECT_NE(all.max_steps, Options{}.max_steps);
    EXPECT_NE(all.memory, Options{}.memory);
    EXPECT_NE(all.simultaneous, Options{}.simultaneous);
    EXPECT_NE(all.energy_gain, Options{}.energy_gain);
    EXPECT_NE(all.max_events, Options{}.max_events);
    EXPECT_NE(all.truncation.eps_q, Options{}.truncation.eps_q);
    EXPECT_NE(all.truncation.eps_v, Options{}.truncation.eps_v);
    EXPECT_NE(all.truncation.eps_t, Options{}.truncation.eps_t);
    EXPECT_NE(all.truncation.conditions, Options{}.truncation.conditions);
    EXPECT_NE(all.truncation.reinitialization, Options{}.truncation.reinitialization);
}

TEST(Options, WhatIsNotAllowedIsTold) {
    Options options;
    EXPECT_TRUE(validation_errors(options).empty());
    options.tolerance = -1.0;
    options.max_steps = 0;
    options.truncation.eps_t = 1.0 / 0.0;
    EXPECT_EQ(validation_errors(options), (std::vector<std::string>{"tolerance must be a positive number, but it is -1",
                                                                    "max_steps must be at least 1",
                                                                    "eps_t must be a positive number, but it is inf"}));
}

// The start time is arbitrary; the end time is after it.
TEST(Options, TimesHaveAnOrder) {
    Options options;
    options.start_time = -20.0;
    options.end_time = -10.0;
    EXPECT_TRUE(is_valid_value(option("start_time"), options.start_time));
    EXPECT_TRUE(validation_errors(options).empty());
    options.end_time = options.start_time;
    EXPECT_EQ(validation_errors(options), std::vector<std::string>{"the end time -20 is not after the start time -20"});
    options.start_time = 1.0 / 0.0;
    EXPECT_EQ(validation_errors(options),
              (std::vector<std::string>{"start_time must be a finite number, but it is inf",
                                        "the end time -20 is not after the start time inf"}));
    EXPECT_FALSE(is_valid_value(option("tolerance"), -1.0));
}

// Whatever the times before and after, the start is before the end between the two commands.
TEST(Options, AreSetInAnOrderInWhichTheEndStaysAfterTheStart) {
    const double times[] = {-7.0, -2.0, 0.0, 3.0, 9.0};
    for (const double start : times)
        for (const double end : times)
            for (const double new_start : times)
                for (const double new_end : times) {
                    Options from, to;
                    from.start_time = start, from.end_time = end, to.start_time = new_start, to.end_time = new_end;
                    if (!validation_errors(from).empty() || !validation_errors(to).empty()) continue;
                    Options now = from;
                    for (const auto group : options_by_command(from, to))
                        for (const Option& one : group) {
                            one.set(now, one.get(to));
                            EXPECT_TRUE(validation_errors(now).empty()) << validation_errors(now)[0];
                        }
                    EXPECT_EQ(now, to);
                }
}

TEST(Options, AreToldInOneOrderButForTheFirst) {
    std::string keys;
    for (const Option* one : options_in_report_order({"tolerance", "method"})) keys += std::string(one->key) + " ";
    EXPECT_EQ(keys,
              "tolerance method start_time end_time max_impacts max_steps memory simultaneous energy_gain max_events "
              "conditions "
              "reinitialization eps_q eps_v eps_t ");
}

TEST(Options, ACommandSetsThoseThatShareIt) {
    EXPECT_EQ(options_set_by("eps").size(), 3u);
    EXPECT_EQ(options_set_by("end").size(), 1u);
    EXPECT_TRUE(options_set_by("seek").empty());
}

}  // namespace
}  // namespace achilles
