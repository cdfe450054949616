// The page `validation` of the manual is that of the results, and every number on it agrees with its reference, or the
// page says why not. `test_validation --write` writes the page.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string_view>

#include "app/program.hpp"
#include "validation/comparison.hpp"

namespace achilles::validation {
namespace {

const std::string page_file = ACHILLES_SOURCE_DIR "/assets/manual/validation.md";

TEST(Agreement, CountsTheDigitsOfTheReference) {
    EXPECT_EQ(compare("0.734346", 0.73434639115, 11).text, "all 6 digits");
    EXPECT_EQ(compare("-0.190", -0.1900998, 11).text, "all 3 digits");
    EXPECT_EQ(compare("4.37", 4.390898, 11).text, "differs by 0.021");
    EXPECT_EQ(compare("4.000", 4.0038643, 11).text, "differs by 0.0039");
    EXPECT_EQ(compare("1.4142135623730950488", 1.4142135623730951, 12).text, "12 digits");
    EXPECT_TRUE(compare("1.4142135623", 1.4142135624, 12).agrees);
    EXPECT_FALSE(compare("1.4142135623", 1.4142135625, 12).agrees);
    EXPECT_FALSE(compare("2.5e-3", -2.5e-3, 5).agrees);
    EXPECT_THROW(compare("about 4", 4.0, 5), std::invalid_argument);
    EXPECT_THROW(compare("0", 0.0, 5), std::invalid_argument);
}

TEST(Validation, EveryNumberAgreesOrThePageSaysWhyNot) {
    std::size_t rows = 0;
    for (const Topic& topic : topics())
        for (const Command& command : topic.commands)
            for (const Row& row : command.rows) {
                SCOPED_TRACE(topic.title + ": achilles " + command.arguments + ": " + row.quantity);
                const double value = row.value(output_of(command.arguments));
                const Agreement agreement = compare(row.reference, value, row.digits);
                EXPECT_EQ(agreement.agrees, row.reason.empty()) << fmt::format("{:.17g}: {}", value, agreement.text);
                ++rows;
            }
    EXPECT_GE(rows, 50u);
}

TEST(Validation, ThePageIsThatOfTheResults) {
    EXPECT_EQ(test::content(page_file), page()) << "write it by build/release/test_validation --write";
}

}  // namespace
}  // namespace achilles::validation

int main(int argc, char** argv) {
    using namespace achilles::validation;
    if (argc > 1 && std::string_view(argv[1]) == "--write") {
        const std::string text = page();
        std::ofstream(page_file) << text;
        fmt::print("{}", text);
        return 0;
    }
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
