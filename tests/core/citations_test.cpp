// Follows the citations of the theory: comments, README, the manual and the chapters themselves cite numbered sections
// of the Markdown files of core, by file name and number.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace achilles {
namespace {

namespace fs = std::filesystem;

// Texts by file path.
using Texts = std::map<std::string, std::string>;

bool ends_with(std::string_view text, std::string_view end) {
    return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_space(char c) { return c == ' ' || c == '\n'; }
bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-'; }

// Position of the comment in a line of code; the line's size if there is none. String literals within the line are
// respected.
std::size_t comment_in(std::string_view line) {
    bool in_string = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (in_string && line[i] == '\\') {
            ++i;
        } else if (line[i] == '"' && (in_string || i == 0 || (line[i - 1] != '\'' && line[i - 1] != '\\'))) {
            in_string = !in_string;
        } else if (!in_string && line.substr(i, 2) == "//") {
            return i;
        }
    }
    return line.size();
}

// The comments of a code text, at unchanged positions. Code becomes ';' and the slashes of comments become spaces, so
// that a sentence may continue on the next line.
std::string comments_of(const std::string& code) {
    std::string comments;
    std::istringstream lines(code);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t begin = comment_in(line);
        for (std::size_t i = 0; i < begin; ++i) comments += line[i] == ' ' ? ' ' : ';';
        if (begin < line.size()) comments += "  " + line.substr(begin + 2);
        comments += '\n';
    }
    return comments;
}

// Parses a section number such as 4 or 3.2 and moves `at` past it; "" if there is none.
std::string number_at(std::string_view text, std::size_t& at) {
    const std::size_t begin = at;
    while (at < text.size() && is_digit(text[at])) ++at;
    if (at > begin && at + 1 < text.size() && text[at] == '.' && is_digit(text[at + 1]))
        for (++at; at < text.size() && is_digit(text[at]);) ++at;
    return std::string(text.substr(begin, at - begin));
}

// Parses a list of numbers after white space: "4", "1, 2 and 7", "4 to 6".
std::vector<std::string> numbers_after(std::string_view text, std::size_t at) {
    const auto skip_space = [&] {
        const std::size_t begin = at;
        while (at < text.size() && is_space(text[at])) ++at;
        return at > begin;
    };
    std::vector<std::string> numbers;
    while (skip_space() && at < text.size() && is_digit(text[at])) {
        numbers.push_back(number_at(text, at));
        const bool at_comma = at < text.size() && text[at] == ',';
        if (at_comma) {
            ++at;
            continue;
        }
        skip_space();
        const std::size_t word = text.substr(at, 3) == "and" ? 3 : text.substr(at, 2) == "to" ? 2 : 0;
        if (word == 0) break;
        at += word;
    }
    return numbers;
}

// The numbers of a chapter's headings, in order: "## 3. The name" and "### 3.2 The name".
std::vector<std::string> sections_of(const std::string& chapter) {
    std::vector<std::string> sections;
    std::istringstream lines(chapter);
    for (std::string line; std::getline(lines, line);) {
        std::size_t at = line.find_first_not_of('#');
        if (at < 2 || at > 3 || line[at] != ' ') continue;
        const std::string number = number_at(line, ++at);
        if (!number.empty()) sections.push_back(number);
    }
    return sections;
}

// Checks the citations in all texts, including the chapters themselves.
class Citations {
 public:
    explicit Citations(const Texts& texts) {
        for (const auto& [path, text] : texts)
            if (fs::path(path).parent_path() == "core" && path != "core/README.md" && ends_with(path, ".md"))
                read_chapter(path, text);
        for (const auto& [path, text] : texts) {
            path_ = path;
            is_code_ = !ends_with(path, ".md");
            text_ = is_code_ ? comments_of(text) : text;
            look();
        }
        if (count_ == 0) faults_.emplace_back("there is not one citation");
    }

    int count() const { return count_; }
    const std::vector<std::string>& faults() const { return faults_; }

 private:
    void read_chapter(const std::string& path, const std::string& text) {
        auto& sections = chapters_[fs::path(path).filename().string()];
        for (const std::string& section : sections_of(text))
            if (!sections.insert(section).second) faults_.push_back(path + ": two sections " + section);
    }

    void blame(std::size_t at, const std::string& what) {
        const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at), '\n');
        faults_.push_back(path_ + ":" + std::to_string(line) + ": " + what);
    }

    // Word by word. A period belongs to a word if letters follow, as in a file name.
    void look() {
        for (std::size_t at = 0, end = 0; at < text_.size(); at = std::max(end, at + 1)) {
            end = at;
            if (!is_word(text_[at])) continue;
            while (end < text_.size() &&
                   (is_word(text_[end]) || (text_[end] == '.' && end + 1 < text_.size() && is_word(text_[end + 1]))))
                ++end;
            look_at(text_.substr(at, end - at), at, end);
        }
    }

    void look_at(const std::string& word, std::size_t at, std::size_t end) {
        const bool is_old = word == "INTERFACE" || word.substr(0, 6) == "THEORY";
        if (is_old) return blame(at, word + " is nothing that stands here");
        if (word.substr(0, 6) == "theory" && ends_with(word, ".md")) return follow(word, at, end);
        if (word != "section" && word != "sections" && word != "Section" && word != "Sections") return;
        const std::string file = fs::path(path_).filename().string();
        if (chapters_.count(file) != 0)
            check(file, numbers_after(text_, end), at);
        else if (!numbers_after(text_, end).empty())
            blame(at, "a section of no file");
    }

    // Documents may cite a whole file; comments must name a section.
    void follow(const std::string& file, std::size_t at, std::size_t end) {
        if (chapters_.count(file) == 0) return blame(at, "there is no " + file);
        const auto numbers = numbers_after(text_, end);
        if (numbers.empty() && is_code_) return blame(at, file + " without a section");
        check(file, numbers, at);
        count_ += static_cast<int>(numbers.size());
    }

    void check(const std::string& file, const std::vector<std::string>& numbers, std::size_t at) {
        for (const std::string& number : numbers)
            if (chapters_[file].count(number) == 0) blame(at, file + " has no section " + number);
    }

    std::map<std::string, std::set<std::string>> chapters_;  // sections by file name
    std::string path_, text_;                                // the text under examination
    bool is_code_ = false;
    int count_ = 0;
    std::vector<std::string> faults_;
};

Texts source_tree() {
    const fs::path root = ACHILLES_SOURCE_DIR;
    Texts texts;
    const auto add = [&](const fs::path& file) {
        std::ifstream stream(file, std::ios::binary);
        std::ostringstream text;
        text << stream.rdbuf();
        texts[fs::relative(file, root).generic_string()] = text.str();
    };
    add(root / "README.md");
    add(root / ".github" / "CONTRIBUTING.md");
    for (const char* room : {"core", "app", "render", "tests", "assets"})
        for (const auto& entry : fs::recursive_directory_iterator(root / room)) {
            const std::string ending = entry.path().extension().string();
            if (ending == ".cpp" || ending == ".hpp" || ending == ".inc" || ending == ".md") add(entry.path());
        }
    return texts;
}

TEST(Citations, EveryOneLeadsToASection) {
    const Texts texts = source_tree();
    EXPECT_GT(texts.size(), 300u);
    const Citations citations(texts);
    EXPECT_GE(citations.count(), 40);
    for (const std::string& fault : citations.faults()) ADD_FAILURE() << fault;
}

// ---- planted mistakes ----

const std::string chapter = "# Title\n\n## 1. One\n\n### 1.1 Of one\n\n## 2. Two\n\nAs in section 1.1.\n";

// The errors in a text next to two chapters.
std::vector<std::string> faults_of(const std::string& text, const std::string& path = "core/a.cpp") {
    return Citations({{"core/theory.md", chapter}, {"core/theory-truncation.md", chapter}, {path, text}}).faults();
}

using Faults = std::vector<std::string>;

TEST(Citations, ThatAreRightAreNoFaults) {
    EXPECT_EQ(faults_of("// See theory.md 1.\n"), Faults());
    EXPECT_EQ(faults_of("int a;  // (theory.md 1.1), theory-truncation.md 1, 1.1 and 2.\n"), Faults());
    EXPECT_EQ(faults_of("As theory.md 1 to 2 say: [theory.md](core/theory.md).\n", "README.md"), Faults());
    const Citations counted(
        {{"core/theory.md", chapter}, {"a.cpp", "// theory.md 1, 1.1\n//     and 2 (theory.md 2)\n"}});
    EXPECT_EQ(counted.count(), 4);
}

TEST(Citations, OfASectionThatIsMissingAreFaults) {
    EXPECT_EQ(faults_of("// theory.md 1\n\n// See theory.md 3.\n"), Faults{"core/a.cpp:3: theory.md has no section 3"});
    EXPECT_EQ(faults_of("// theory.md 1.2\n"), Faults{"core/a.cpp:1: theory.md has no section 1.2"});
    EXPECT_EQ(faults_of("int a;  // theory-truncation.md 1, 2\n        // and 4\n"),
              Faults{"core/a.cpp:1: theory-truncation.md has no section 4"});
    EXPECT_EQ(faults_of("See theory.md 9.\n", "README.md"), Faults{"README.md:1: theory.md has no section 9"});
}

TEST(Citations, InNoKnownFormAreFaults) {
    const std::string right = "// theory.md 1\n";
    EXPECT_EQ(faults_of(right + "// THEORY section 1\n"),
              (Faults{"core/a.cpp:2: THEORY is nothing that stands here", "core/a.cpp:2: a section of no file"}));
    EXPECT_EQ(faults_of(right + "// (THEORY-truncation)\n"),
              Faults{"core/a.cpp:2: THEORY-truncation is nothing that stands here"});
    EXPECT_EQ(faults_of(right + "f(\"a \\\" // b\");  // INTERFACE\n"),
              Faults{"core/a.cpp:2: INTERFACE is nothing that stands here"});
    EXPECT_EQ(faults_of(right + "// as in section\n// 2\n"), Faults{"core/a.cpp:2: a section of no file"});
    EXPECT_EQ(faults_of(right + "// as theory.md says\n"), Faults{"core/a.cpp:2: theory.md without a section"});
    EXPECT_EQ(faults_of(right + "// theory-gaps.md 1\n"), Faults{"core/a.cpp:2: there is no theory-gaps.md"});
}

TEST(Citations, AreInCommentsAlone) {
    const std::string right = "// theory.md 1\n";
    EXPECT_EQ(faults_of(right + "#define INTERFACE \"theory.md 7 // THEORY\"\n"), Faults());
    EXPECT_EQ(faults_of(right + "char c = '\"';  // theory.md 7\n"),
              Faults{"core/a.cpp:2: theory.md has no section 7"});
    EXPECT_EQ(faults_of(right + "// theory.md 1\nint two;  // and 7 more\n"), Faults());
}

TEST(Citations, ThereMustBeSome) {
    EXPECT_EQ(faults_of("// the theory\n"), Faults{"there is not one citation"});
    EXPECT_EQ(Citations(Texts{}).faults(), Faults{"there is not one citation"});
}

TEST(Citations, OfAChapterToItselfAreFollowed) {
    const Texts texts{{"core/theory.md", chapter + "## 2. Again\nSee section 5 and theory.md 2.\n"}};
    EXPECT_EQ(Citations(texts).faults(),
              (Faults{"core/theory.md: two sections 2", "core/theory.md:11: theory.md has no section 5"}));
}

}  // namespace
}  // namespace achilles
