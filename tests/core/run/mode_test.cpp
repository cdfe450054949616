#include "run/mode.hpp"

#include <gtest/gtest.h>

#include <map>
#include <type_traits>
#include <vector>

namespace achilles {
namespace {

constexpr auto open = ContactState::open, held = ContactState::held;

// Every mode of four contacts, whose numbers are spread over the sixteen possible ones.
std::vector<std::pair<Mode, ContactSet>> some_modes() {
    constexpr std::size_t places[] = {0, 3, 7, 15};
    std::vector<std::pair<Mode, ContactSet>> modes;
    for (unsigned bits = 0; bits < 16; ++bits) {
        Mode mode;
        ContactSet set;
        for (unsigned k = 0; k < 4; ++k)
            if ((bits >> k & 1u) != 0) {
                mode = mode.with(places[k], held);
                set = set.with(places[k]);
            }
        modes.emplace_back(mode, set);
    }
    return modes;
}

TEST(Mode, StartsAsFreeFlight) {
    EXPECT_TRUE(Mode().is_free());
    EXPECT_TRUE(Mode().held().empty());
    for (std::size_t i = 0; i < max_contacts; ++i) {
        EXPECT_EQ(Mode().state(i), open);
        EXPECT_FALSE(Mode().is_held(i));
    }
    EXPECT_EQ(Mode::holding({}), Mode());
    EXPECT_TRUE(std::has_unique_object_representations_v<Mode>);  // no padding
}

TEST(Mode, KnowsWhichOpenContactsAct) {
    for (const auto& [mode, set] : some_modes()) {
        const ContactSet two = ContactSet::of(3).with(15);
        const Mode acting = mode.with_acting(two);
        EXPECT_EQ(acting.acting(), two.without(set));
        EXPECT_EQ(acting.held(), set);
        EXPECT_TRUE(acting.implied().empty());
        EXPECT_EQ(acting == mode, two.without(set).empty());
        EXPECT_TRUE(acting.with(two, held).acting().empty());
        EXPECT_EQ(acting.with(two, held), mode.with(two, held));
        EXPECT_EQ(acting.without(two), mode.without(two));
    }
}

TEST(Mode, KnowsWhichHeldContactsAreSilent) {
    for (const auto& [mode, set] : some_modes()) {
        const ContactSet two = ContactSet::of(3).with(15);
        const Mode silent = mode.with_silent(two);
        EXPECT_EQ(silent.silent(), two.within(set));
        EXPECT_EQ(silent.held(), set);
        EXPECT_TRUE(silent.acting().empty());
        EXPECT_EQ(silent.seen_by_forces(), set.without(two));
        EXPECT_EQ(mode.with_acting(two).seen_by_forces(), set.with(two));
        EXPECT_EQ(silent == mode, two.within(set).empty());
        EXPECT_EQ(silent.with_silent({}), mode);
        EXPECT_EQ(silent.without(two), mode.without(two));
        EXPECT_EQ(silent.with(two, held), mode.with(two, held));
        EXPECT_EQ(silent < mode || mode < silent, silent != mode);
    }
}

TEST(Mode, KnowsTheStateOfEveryContact) {
    for (const auto& [mode, set] : some_modes()) {
        EXPECT_EQ(mode, Mode::holding(set));
        EXPECT_EQ(mode.held(), set);
        EXPECT_EQ(mode.is_free(), set.empty());
        EXPECT_EQ(mode.contacts_in(held), set);
        EXPECT_EQ(mode.contacts_in(open).with(set).count(), static_cast<int>(max_contacts));
        for (std::size_t i = 0; i < max_contacts; ++i) {
            EXPECT_EQ(mode.state(i), set.contains(i) ? held : open);
            EXPECT_EQ(mode.is_held(i), set.contains(i));
            EXPECT_NE(mode.contacts_in(open).contains(i), set.contains(i));
        }
    }
}

// The two states without a contact law yet are stored and read, too. Friction will need four states.
TEST(Mode, HasRoomForFourStates) {
    for (const auto& [mode, set] : some_modes())
        for (const unsigned other : {2u, 3u}) {
            const auto state = static_cast<ContactState>(other);
            const Mode more = mode.with(5, state);
            EXPECT_EQ(more.state(5), state);
            EXPECT_EQ(more.held(), set.with(5));
            EXPECT_EQ(more.contacts_in(state), ContactSet::of(5));
            EXPECT_EQ(more.contacts_in(held), set);
            EXPECT_EQ(more.without(5), mode);
            EXPECT_EQ(more.with(5, held), mode.with(5, held));
            EXPECT_NE(more, mode.with(5, held));
            EXPECT_EQ(more.only(set), mode);
            EXPECT_EQ(more.only(ContactSet::of(5)), Mode().with(5, state));
        }
}

TEST(Mode, ForgetsAnImpliedSlipWithItsContact) {
    for (const std::size_t i : {std::size_t{0}, std::size_t{7}, std::size_t{8}, std::size_t{15}}) {
        const Mode both = Mode::holding(ContactSet::of(i).with(3)), implied = both.with_implied_slip(i);
        EXPECT_TRUE(both.implied().empty());
        EXPECT_EQ(implied.implied(), ContactSet::of(i));
        EXPECT_EQ(implied.held(), both.held());
        EXPECT_EQ(implied.state(i), held);
        EXPECT_TRUE(implied.slipping().empty());
        EXPECT_TRUE(implied.joints().empty());
        EXPECT_EQ(implied.with(3, ContactState::slip_plus).implied(), ContactSet::of(i));
        EXPECT_EQ(implied.with(i, held), both);
        EXPECT_EQ(implied.without(i), both.without(i));
    }
}

TEST(Mode, KeepsJointsApartFromContacts) {
    const Mode mode = Mode::holding(ContactSet::of(15)).with(joint_number(0), ContactState::slip_minus);
    EXPECT_EQ(mode.held(), ContactSet::of(15));
    EXPECT_EQ(mode.joints(), ContactSet::of(joint_number(0)));
    EXPECT_EQ(mode.slipping(), ContactSet::of(joint_number(0)));
    EXPECT_TRUE(mode.without(15).is_free());
    EXPECT_NE(mode.without(15), Mode());
    EXPECT_EQ(mode.only({}), mode.without(15));
}

TEST(Mode, ChangesTheContactsThatAreNamed) {
    for (const auto& [a, set] : some_modes())
        for (const auto& [b, other] : some_modes()) {
            EXPECT_EQ(a.with(other, held).held(), set.with(other));
            EXPECT_EQ(a.without(other).held(), set.without(other));
            EXPECT_EQ(a.only(other).held(), set.without(set.without(other)));
            EXPECT_EQ(a == b, set == other);
        }
}

// Modes are ordered like their sets of held contacts, so maps keyed by mode keep the order that they had when keyed by
// set.
TEST(Mode, IsOrderedAsWhatItHolds) {
    std::map<Mode, ContactSet> modes;
    for (const auto& [mode, set] : some_modes()) modes.emplace(mode, set);
    EXPECT_EQ(modes.size(), 16u);
    for (auto at = modes.begin(); std::next(at) != modes.end(); ++at) EXPECT_LT(at->second, std::next(at)->second);
}

TEST(ContactSet, GivesItsContactsInAscendingOrder) {
    for (const auto& [mode, set] : some_modes()) {
        std::vector<std::size_t> found, wanted;
        for (const std::size_t i : set) found.push_back(i);
        for (std::size_t i = 0; i < max_contacts; ++i)
            if (set.contains(i)) wanted.push_back(i);
        EXPECT_EQ(found, wanted);
        EXPECT_EQ(mode.held().count(), static_cast<int>(found.size()));
    }
}

}  // namespace
}  // namespace achilles
