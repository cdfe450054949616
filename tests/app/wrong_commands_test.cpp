// Runs the wrong command lines and files of wrong_commands.txt and checks the program's answers.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "app/program.hpp"
#include "cli/commands/commands.hpp"

namespace achilles::test {
namespace {

const char* const table_file = ACHILLES_SOURCE_DIR "/tests/app/wrong_commands.txt";

// A command line, or replaced lines of drop.toml, and the expected answer.
struct Row {
    std::string head, command;
    std::vector<std::string> answer;
    std::vector<std::pair<std::string, std::string>> edits;
};
struct Table {
    std::map<std::string, std::string> files;
    std::vector<Row> rows;
};

// Converts "\x89PNG\n" to bytes.
std::string unescaped(const std::string& text) {
    std::string bytes;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '\\' || i + 1 == text.size()) {
            bytes += text[i];
        } else if (text[++i] == 'x') {
            bytes += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
            i += 2;
        } else {
            bytes += text[i] == 'n' ? '\n' : text[i] == 'r' ? '\r' : text[i] == 't' ? '\t' : text[i];
        }
    }
    return bytes;
}

Table read_table() {
    Table table;
    std::ifstream stream(table_file);
    std::string line, file;
    const auto rest = [&] { return line.size() > 2 ? line.substr(2) : ""; };
    while (std::getline(stream, line)) {
        const std::string mark = line.substr(0, 2);
        const bool is_answered = !table.rows.empty() && !table.rows.back().answer.empty();
        if (mark == "$ " || (mark == "- " && (table.rows.empty() || is_answered))) table.rows.emplace_back();
        if (table.rows.empty()) {
            if (mark == "@ ") {
                const std::size_t space = line.find(' ', 2);
                file = line.substr(2, space - 2);
                table.files[file] = space == line.npos ? "" : unescaped(line.substr(space + 1));
            }
            if (mark == "| ") table.files[file] += rest() + "\n";
            continue;
        }
        Row& row = table.rows.back();
        if (line.empty()) continue;
        row.head += line + "\n";
        if (mark == "$ ") row.command = rest();
        if (mark == "- ") row.edits.emplace_back(rest(), "");
        if (mark == "+ ") row.edits.back().second += (row.edits.back().second.empty() ? "" : "\n") + rest();
        if (mark == "> ") row.answer.push_back(rest());
    }
    return table;
}

// Splits a command; words with spaces are in double quotes.
std::vector<std::string> words_in(const std::string& command) {
    std::vector<std::string> words;
    bool is_open = false, is_quoted = false;
    for (const char c : command + " ") {
        if (c == '"') {
            is_quoted = !is_quoted;
            if (!is_open) words.emplace_back();
            is_open = true;
        } else if (c == ' ' && !is_quoted) {
            is_open = false;
        } else {
            if (!is_open) words.emplace_back();
            is_open = true;
            words.back() += c;
        }
    }
    return words;
}

// Runs it in this process, with output redirected to files.
Answer answer_to(const std::string& command, const Folder& streams) {
    const auto redirect = [&](std::FILE* stream, const char* name) {
        std::fflush(stream);
        const int kept = ::dup(::fileno(stream));
        std::FILE* const file = std::fopen((streams.path() / name).c_str(), "wb");
        ::dup2(::fileno(file), ::fileno(stream));
        std::fclose(file);
        return kept;
    };
    const auto restore = [](std::FILE* stream, int kept) {
        std::fflush(stream);
        ::dup2(kept, ::fileno(stream));
        ::close(kept);
    };
    const int out = redirect(stdout, "out"), err = redirect(stderr, "err");
    const int status = run_program(words_in(command));
    restore(stdout, out);
    restore(stderr, err);
    return {status, content(streams.path() / "out"), content(streams.path() / "err")};
}

std::string edited(std::string text, const Row& row) {
    for (const auto& [from, to] : row.edits) {
        const std::size_t at = text.find(from + "\n");
        if (at == text.npos) return "no line '" + from + "' to change";
        text.replace(at, from.size() + (to.empty() ? 1 : 0), to);
    }
    return text;
}

class WrongCommands : public testing::Test {
 protected:
    void SetUp() override {
        ::setenv("DISPLAY", "", 1);
        ::unsetenv("WAYLAND_DISPLAY");
        before_ = std::filesystem::current_path();
        std::filesystem::current_path(folder_.path());
        std::filesystem::create_directory("systems");
        std::filesystem::create_directory("empty");
        for (const auto& [name, text] : table_.files) folder_.put(name, text);
        folder_.put("f.toml", "");
        std::filesystem::copy_file(folder_.path() / "drop.toml", folder_.path() / "systems/drop.toml");
    }
    void TearDown() override { std::filesystem::current_path(before_); }

    const Table table_ = read_table();
    const Folder folder_, streams_;
    std::filesystem::path before_;
};

TEST_F(WrongCommands, AreAnsweredWithWhatToType) {
    const std::size_t files = folder_.files().size();
    const std::regex bad_words("\\b(who|told|tells|asked|somebody|is none)\\b");
    std::string answers;
    for (const Row& row : table_.rows) {
        if (!row.edits.empty()) folder_.put("f.toml", edited(table_.files.at("drop.toml"), row));
        const Answer answer = answer_to(row.edits.empty() ? row.command : "check f.toml", streams_);
        answers += row.head + answer.err + "\n";
        EXPECT_EQ(answer.status, 2) << row.head;
        EXPECT_EQ(answer.out, "") << row.head;
        EXPECT_FALSE(row.answer.empty()) << row.head;
        for (const std::string& part : row.answer)
            EXPECT_NE(answer.err.find(part), std::string::npos) << row.head << answer.err;
        EXPECT_LE(std::count(answer.err.begin(), answer.err.end(), '\n'), 5) << row.head << answer.err;
        EXPECT_EQ(answer.err.find(folder_.path().string()), std::string::npos) << row.head << answer.err;
        EXPECT_EQ(answer.err.find(ACHILLES_BINARY_DIR), std::string::npos) << row.head << answer.err;
        EXPECT_FALSE(std::regex_search(answer.err, bad_words)) << row.head << answer.err;
        EXPECT_EQ(folder_.files().size(), files) << row.head << "leaves a file";
    }
    EXPECT_GE(table_.rows.size(), 200U);
    // For reading the program's messages.
    if (const char* const place = std::getenv("ACHILLES_WRITE_ANSWERS")) std::ofstream(place) << answers;
}

}  // namespace
}  // namespace achilles::test
