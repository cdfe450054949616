// Unsaved text survives its window, and nothing else is kept.
#include "journal/recovery.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "app/hands.hpp"
#include "app/program.hpp"

namespace achilles::test {
namespace {

namespace fs = std::filesystem;

class Recoveries : public testing::Test {
 protected:
    void SetUp() override { ::setenv("XDG_STATE_HOME", folder.path().c_str(), 1); }
    void TearDown() override { ::unsetenv("XDG_STATE_HOME"); }
    std::size_t kept() const {
        const fs::path place = folder.path() / "achilles";
        return fs::exists(place) ? static_cast<std::size_t>(std::distance(fs::directory_iterator(place), {})) : 0;
    }
    const Folder folder;
};

TEST_F(Recoveries, LeadToTheTextWhereverItBelongs) {
    for (const char* const opening : {"new", "open ball_on_floor"}) {
        Session session = test::session("ball_on_sine"), again = test::session("double_pendulum");
        session.apply(parse_command(opening));
        const std::string text = session.document().text + "# \"typed\"\n\tand not saved";
        session.apply(command::SetText{text});
        Recovery recovery;
        recovery.keep(session.document(), "half of it");
        recovery.keep(session.document(), text);
        EXPECT_EQ(kept(), 1U);
        const std::vector<RecoveredText> left = left_unsaved();
        ASSERT_EQ(left.size(), 1U);
        EXPECT_EQ(left[0].name, session.document().name);
        for (const Command& step : left[0].steps) again.apply(step);
        EXPECT_EQ(again.error(), "");
        EXPECT_EQ(again.document().text, text);
        EXPECT_EQ(again.document().name, session.document().name);
        EXPECT_EQ(again.document().saved, session.document().saved);
        recovery.forget();
        EXPECT_EQ(kept(), 0U);
        EXPECT_TRUE(left_unsaved().empty());
    }
}

TEST_F(Recoveries, EachWindowHasItsOwnFileAndForeignFilesAreIgnored) {
    Session session = test::session("ball_on_sine");
    session.apply(command::SetText{"one"});
    Recovery one, two;
    one.keep(session.document(), "one");
    two.keep(session.document(), "two");
    EXPECT_EQ(left_unsaved().size(), 2U);
    folder.put("achilles/notes.journal", "new\ntext \"x\"\n");
    folder.put("achilles/unsaved-999999999-1.journal", "save /etc/passwd overwrite\ntext \"x\"\nundo\n");
    folder.put("achilles/unsaved-999999999-2.journal", "sett");
    EXPECT_EQ(left_unsaved().size(), 2U);
    two.forget();
    ASSERT_EQ(left_unsaved().size(), 1U);
    EXPECT_EQ(left_unsaved()[0].steps.back(), Command(command::SetText{"one"}));
}

// Without a writable folder, editing continues.
TEST_F(Recoveries, FailInSilence) {
    ::setenv("XDG_STATE_HOME", "/proc/nowhere", 1);
    Session session = test::session("ball_on_sine");
    Recovery recovery;
    recovery.keep(session.document(), "text");
    EXPECT_TRUE(left_unsaved().empty());
}

TEST(RecoveryQuestion, IsAnsweredByEachOfItsButtons) {
    using RecoveryChoice = RecoveryQuestion::RecoveryChoice;
    for (const auto& [name, answer] :
         {std::pair{"dialog Recover", RecoveryChoice::recover}, std::pair{"dialog Discard", RecoveryChoice::discard},
          std::pair{"dialog Later", RecoveryChoice::later}}) {
        Hands hands("ball_on_sine");
        hands.state.recovery_question = RecoveryQuestion{"mine.toml", "2026-11-22 11:40", RecoveryChoice::none};
        hands.rest(3);
        hands.click(name);
        EXPECT_EQ(hands.state.recovery_question->answer, answer) << name;
    }
}

}  // namespace
}  // namespace achilles::test
