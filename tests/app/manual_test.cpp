// Consistency of the manual with the program: its tables, its examples and the JSON schema.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "app/program.hpp"
#include "cli/assets.hpp"
#include "cli/manual.hpp"
#include "model/model.hpp"
#include "model/read_system.hpp"
#include "run/options.hpp"
#include "session/command.hpp"
#include "session/glossary.hpp"
#include "system/keys.hpp"

namespace achilles::test {
namespace {

using nlohmann::json;

std::string page_text(const std::string& name) { return read_text(assets() / "manual" / name); }

// The blocks ```KIND of all pages.
std::vector<std::string> examples(const std::string& kind) {
    std::vector<std::string> found;
    for (const auto& file : manual_files()) {
        std::istringstream lines(read_text(file));
        bool inside = false;
        for (std::string line; std::getline(lines, line);) {
            if (line.starts_with("```")) {
                inside = !inside && line == "```" + kind;
                if (inside) found.emplace_back();
            } else if (inside) {
                found.back() += line + "\n";
            }
        }
    }
    return found;
}

TEST(Manual, EveryPageHasItsTables) {
    const auto topics = manual_topics();
    ASSERT_GE(topics.size(), 4u);
    for (const ManualTopic& topic : topics) {
        EXPECT_FALSE(topic.title.empty()) << topic.name;
        EXPECT_EQ(manual_page(topic.name).find("{{"), std::string::npos) << topic.name;
    }
    const std::string system = manual_page("system"), commands = manual_page("commands");
    for (const FileTable& table : file_tables())
        for (const FileKey& key : table.keys)
            EXPECT_NE(system.find("`" + std::string(key.name) + "`"), std::string::npos) << key.name;
    for (const Option& option : all_options())
        EXPECT_NE(system.find("`" + std::string(option.flag) + "`"), std::string::npos) << option.flag;
    for (const std::string& usage : command_usages())
        EXPECT_NE(commands.find("    " + usage + "\n"), std::string::npos);
}

// The prose must cover every command of the program's list.
TEST(Manual, TellsWhatEveryCommandDoes) {
    const std::string all = page_text("commands.md"), prose = all.substr(all.find("## What they do"));
    for (const std::string& usage : command_usages()) {
        const std::string name = usage.substr(0, usage.find(' '));
        if (!options_set_by(name).empty()) continue;  // described under "The options"
        EXPECT_NE(prose.find("`" + name + "`"), std::string::npos) << name;
    }
}

// The page `gallery` has a row for every system and no other, every system is in a group of the explorer's gallery, and
// the README knows how many there are.
TEST(Manual, TheGalleryNamesEverySystem) {
    const std::string page = page_text("gallery.md"), readme = read_text(ACHILLES_SOURCE_DIR "/README.md");
    const std::vector<std::string> systems = system_names();
    for (const std::string& system : systems) {
        EXPECT_NE(page.find("\n| `" + system + "` |"), std::string::npos) << system;
        EXPECT_NE(group_of(system), "others") << system;
    }
    std::size_t rows = 0;
    for (std::size_t at = 0; (at = page.find("\n| `", at)) != std::string::npos; ++at) ++rows;
    EXPECT_EQ(rows, systems.size());
    EXPECT_NE(page.find(fmt::format("has {} systems", systems.size())), std::string::npos);
    EXPECT_NE(readme.find(fmt::format("# {} example systems", systems.size())), std::string::npos);
}

TEST(Manual, EverySystemInItCanBeRun) {
    const auto systems = examples("toml");
    ASSERT_FALSE(systems.empty());
    for (const std::string& text : systems) {
        const Folder folder;
        folder.put("example.toml", text);
        const Answer answer = folder.run("simulate ./example.toml");
        EXPECT_EQ(answer.status, 0) << answer.err;
        EXPECT_EQ(answer.err, "");
    }
}

TEST(Manual, EveryJournalInItCanBeReplayed) {
    const auto journals = examples("journal");
    ASSERT_FALSE(journals.empty());
    for (const std::string& text : journals) {
        const Folder folder;
        folder.put("example.journal", text);
        const Answer answer = folder.run("screenshot --journal example.journal --out example.png --size 640x480");
        EXPECT_EQ(answer.status, 0) << answer.err;
    }
}

TEST(Manual, EveryCommandLineInItCanBeTyped) {
    const auto sessions = examples("console");
    ASSERT_FALSE(sessions.empty());
    const std::string prompt = "$ achilles ";
    for (const std::string& text : sessions) {
        const Folder folder;
        std::istringstream lines(text);
        for (std::string line; std::getline(lines, line);) {
            ASSERT_TRUE(line.starts_with(prompt)) << line;
            const Answer answer = folder.run(line.substr(prompt.size()));
            EXPECT_EQ(answer.status, 0) << line << "\n" << answer.err;
        }
    }
}

TEST(Manual, IsPrintedByItsTopics) {
    const Folder folder;
    const Answer contents = folder.run("help");
    EXPECT_EQ(contents.status, 0);
    for (const ManualTopic& topic : manual_topics()) {
        EXPECT_NE(contents.out.find("  " + topic.name), std::string::npos);
        const Answer page = folder.run("help " + topic.name);
        EXPECT_EQ(page.status, 0);
        EXPECT_EQ(page.out, manual_page(topic.name));
    }
    const Answer none = folder.run("help sistem");
    EXPECT_EQ(none.status, 2);
    EXPECT_NE(none.err.find("there is no topic 'sistem'; did you mean 'system'?"), std::string::npos) << none.err;
}

TEST(Help, ListsNoOptionWithoutEffect) {
    const Folder folder;
    const std::string text = folder.run("simulate --help").out;
    EXPECT_EQ(text.find("no effect"), std::string::npos);
    EXPECT_EQ(text.find("--scale"), std::string::npos);
    // Accepted without effect.
    EXPECT_EQ(folder.run("simulate ball_on_floor --end 1 --scale 2 --size 800x600").status, 0);
}

TEST(Instants, AreNotOverwritten) {
    const Folder folder;
    folder.put("times", "0\n0.5\n1\n");
    const Answer answer = folder.run("simulate ball_on_floor --times times --csv times");
    EXPECT_EQ(answer.status, 2);
    EXPECT_EQ(content(folder.path() / "times"), "0\n0.5\n1\n");
}

// ---- template of a system ----

TEST(Skeleton, HasEveryKeyAndRunsAsItIs) {
    const std::string text = skeleton_system() + skeleton_of_bodies();
    // As `key = value`, in braces or alone, or as `run.key = value`.
    const auto is_there = [&](const std::string& key) {
        return std::regex_search(text, std::regex("(^|[^a-z_])" + key + "( *=|\\.)"));
    };
    for (const FileTable& table : file_tables())
        for (const FileKey& key : table.keys) EXPECT_TRUE(is_there(std::string(key.name))) << table.heading << key.name;
    for (const Option& option : all_options()) EXPECT_TRUE(is_there(std::string(option.key))) << option.key;
    const Folder folder;
    const Answer written = folder.run("new mine");
    EXPECT_EQ(written.status, 0) << written.err;
    EXPECT_EQ(folder.files(), std::vector<std::string>{"mine.toml"});
    EXPECT_NE(written.out.find("./mine.toml\n"), std::string::npos) << written.out;
    const Answer run = folder.run("simulate ./mine.toml");
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.err, "");
    EXPECT_NE(run.out.find("Zeno"), std::string::npos) << run.out;
}

// The body skeleton with every line that is commented out put into the list above it.
std::string skeleton_with_every_line() {
    std::istringstream lines(skeleton_of_bodies());
    std::string result, closing;
    const std::regex entry("# (\\{name = .*\\})(   ?.*)?"), list("# ([a-z]+ = \\[\\{.*\\}\\]).*");
    for (std::string line; std::getline(lines, line);) {
        std::smatch found;
        if (std::regex_match(line, found, entry)) {
            result += "    " + found[1].str() + ",\n";
            continue;
        }
        result += std::exchange(closing, "");
        if (line == "]")
            closing = "]\n";
        else
            result += (std::regex_match(line, found, list) ? found[1].str() : line) + "\n";
        if (line == "coordinate = [") result += "    {name = \"phi\"}, {name = \"psi\"},\n";
    }
    result += closing;
    // Several constraints need a name each, and so does lambda.
    for (const auto& [alone, named] :
         {std::pair("{between = [\"ball\", \"floor\"]", "{name = \"floor\", between = [\"ball\", \"floor\"]"),
          std::pair("[\"lambda\"]", "[\"lambda_floor\"]")})
        result.replace(result.find(alone), std::string(alone).size(), named);
    return result;
}

TEST(Skeleton, CanHaveBodies) {
    const Folder folder;
    const Answer written = folder.run("new mine --body");
    EXPECT_EQ(written.status, 0) << written.err;
    EXPECT_EQ(content(folder.path() / "mine.toml"), skeleton_of_bodies());
    const Answer run = folder.run("simulate ./mine.toml");
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.err, "");
    EXPECT_NE(run.out.find("Zeno"), std::string::npos) << run.out;
    const Answer check = folder.run("check ./mine.toml");
    EXPECT_NE(check.out.find("ball on floor"), std::string::npos) << check.out;
    EXPECT_EQ(folder.run("new other --body --from ball_on_sine").status, 2);
    EXPECT_EQ(folder.files(), std::vector<std::string>{"mine.toml"});
}

TEST(Skeleton, OfBodiesHasOnlyLinesThatCanBeTyped) {
    const std::string text = skeleton_with_every_line();
    for (const char* name :
         {"arm", "hand", "wedge", "hoop", "rotor", "table", "hills", "post", "belt", "string", "tip"})
        EXPECT_NE(text.find("\n    {name = \"" + std::string(name) + "\""), std::string::npos) << name;
    for (const char* list : {"spring", "damper", "force", "torque", "drawing"})
        EXPECT_NE(text.find("\n" + std::string(list) + " = [{"), std::string::npos) << list;
    const Folder folder;
    folder.put("all.toml", text);
    const Answer check = folder.run("check ./all.toml");
    EXPECT_EQ(check.status, 0) << check.err << text;
    EXPECT_EQ(check.err, "");
}

TEST(Skeleton, HasAName) {
    const Folder folder;
    EXPECT_EQ(folder.run("new ''").status, 2);
    EXPECT_TRUE(folder.files().empty());
    const Answer spaced = folder.run("new 'a b'");
    EXPECT_NE(spaced.out.find("to run it: achilles simulate './a b.toml'\n"), std::string::npos) << spaced.out;
}

TEST(Skeleton, CanBeASystemOfTheGallery) {
    const Folder folder;
    const std::string ball = content(find_system("ball_on_sine"));
    EXPECT_EQ(folder.run("show ball_on_sine").out, ball);
    EXPECT_EQ(folder.run("new mine --from ball_on_sine").status, 0);
    EXPECT_EQ(content(folder.path() / "mine.toml"), ball);
    EXPECT_EQ(folder.run("new other --from ball_on_sin").status, 2);
    EXPECT_EQ(folder.run("show ball_on_sin").status, 2);
    EXPECT_EQ(folder.files(), std::vector<std::string>{"mine.toml"});
}

TEST(Skeleton, OverwritesNothing) {
    const Folder folder;
    folder.put("mine.toml", "mine\n");
    const Answer answer = folder.run("new mine.toml");
    EXPECT_EQ(answer.status, 2);
    EXPECT_EQ(answer.err, "mine.toml: this file already exists\nchoose another name\n");
    EXPECT_EQ(content(folder.path() / "mine.toml"), "mine\n");
}

// ---- the schema ----

bool is_of_type(const json& value, const std::string& type) {
    if (type == "number") return value.is_number();
    if (type == "integer") return value.is_number_integer();
    if (type == "string") return value.is_string();
    if (type == "boolean") return value.is_boolean();
    if (type == "null") return value.is_null();
    if (type == "array") return value.is_array();
    return type == "object" && value.is_object();
}

// Validates the subset of JSON Schema that ours uses; any other keyword is a fault. Collects faults with their places.
void find_faults(const json& value, const json& schema, const std::string& at, std::vector<std::string>& faults) {
    const auto fault = [&](const std::string& what) { faults.push_back(at + ": " + what); };
    for (const auto& [word, said] : schema.items()) {
        if (word == "$schema" || word == "title" || word == "properties" || word == "items") continue;
        if (word == "type") {
            const json types = said.is_array() ? said : json::array({said});
            if (std::none_of(types.begin(), types.end(), [&](const json& type) { return is_of_type(value, type); }))
                fault("is no " + said.dump());
        } else if (word == "enum") {
            if (std::find(said.begin(), said.end(), value) == said.end()) fault(value.dump() + " is none of these");
        } else if (word == "required") {
            for (const json& key : said)  // for objects; null has no keys
                if (value.is_object() && !value.contains(key.get<std::string>())) fault("lacks " + key.dump());
        } else if (word == "additionalProperties") {
            for (const auto& [key, member] : value.items()) {
                if (schema.contains("properties") && schema["properties"].contains(key)) continue;
                if (said.is_boolean())
                    fault("has " + key);
                else
                    find_faults(member, said, fmt::format("{}/{}", at, key), faults);
            }
        } else if (word == "minItems" || word == "maxItems") {
            const auto limit = said.get<std::size_t>();
            if (word == "minItems" ? value.size() < limit : value.size() > limit) fault("has another length");
        } else {
            fault("the schema says " + word);
        }
    }
    if (value.is_object() && schema.contains("properties"))
        for (const auto& [key, member] : value.items())
            if (schema["properties"].contains(key))
                find_faults(member, schema["properties"][key], fmt::format("{}/{}", at, key), faults);
    if (value.is_array() && schema.contains("items"))
        for (std::size_t i = 0; i < value.size(); ++i)
            find_faults(value[i], schema["items"], fmt::format("{}/{}", at, i), faults);
}

std::vector<std::string> faults_of(const json& value, const std::string& schema) {
    std::vector<std::string> faults;
    find_faults(value, json::parse(page_text(schema)), "", faults);
    return faults;
}
std::vector<std::string> faults_of(const json& run) { return faults_of(run, "trajectory.schema.json"); }

TEST(Schema, HoldsForEverySystemOfTheGallery) {
    const Folder folder;
    int rough = 0;
    for (const std::string& system : system_names()) {
        const auto model = derive(read_system(find_system(system)));
        // A few runs stop after the end of their file, as at Painleve's paradox.
        const double end = std::min(4.0, model->default_run().options.end_time);
        for (const std::string conditions : {"sharp", "paper"}) {
            const Answer answer = folder.run(
                fmt::format("simulate {} --end {} --eps 1e-3 --conditions {} --json -", system, end, conditions));
            if (conditions == "paper" && model->has_friction()) {
                EXPECT_EQ(answer.status, 2) << system;
                EXPECT_EQ(
                    answer.err,
                    system + ": the conditions of the paper cannot be used with friction\nuse the default, sharp\n");
                ++rough;
                continue;
            }
            EXPECT_EQ(answer.status, 0) << answer.err;
            EXPECT_EQ(faults_of(json::parse(answer.out)), std::vector<std::string>()) << system;
        }
    }
    EXPECT_GE(rough, 13);
}

// Bouncing that slides to the Zeno point, and bouncing that sticks.
TEST(Schema, HoldsForZenoPointsWithFriction) {
    const Folder folder;
    folder.put("point.toml", R"toml(title = "a point on a slope"
coordinate = [{name = "x"}, {name = "y", start = 0.5}]
parameter = [{name = "a", value = 0.3}]
lagrangian.kinetic = "(x'^2 + y'^2)/2"
lagrangian.potential = "y - a*x"
constraint = [{name = "slope", gap = "y", restitution = 0.5, slip = "x'", friction = 0.5}]
)toml");
    for (const char* a : {"0.3", "0.45"}) {
        const Answer answer = folder.run(std::string("simulate ./point.toml --end 4 --json - --set a=") + a);
        EXPECT_EQ(answer.status, 0) << answer.err;
        const json run = json::parse(answer.out);
        EXPECT_EQ(faults_of(run), std::vector<std::string>()) << a;
        const auto zeno = std::find_if(run["events"].begin(), run["events"].end(),
                                       [](const json& event) { return event["kind"] == "zeno"; });
        ASSERT_NE(zeno, run["events"].end());
        const bool sticks = std::string(a) == "0.3";
        EXPECT_EQ(zeno->at("certificate").at("tail"), sticks ? "stick" : "slip");
        EXPECT_EQ(zeno->contains("sticks_from"), sticks);
    }
}

TEST(Schema, HoldsForForcesMovingAndSeveralGaps) {
    const Folder folder;
    int systems = 0;
    for (const auto& entry : std::filesystem::directory_iterator(ACHILLES_SOURCE_DIR "/tests/reference/gaps")) {
        const Answer answer = folder.run("simulate " + entry.path().string() + " --json - --samples 5");
        EXPECT_EQ(answer.status, 0) << answer.err;
        EXPECT_EQ(faults_of(json::parse(answer.out)), std::vector<std::string>()) << entry.path();
        ++systems;
    }
    EXPECT_EQ(systems, 6);
}

TEST(Schema, HoldsForSixteenCoordinates) {
    const Folder folder;
    std::string text = "title = \"sixteen\"\ncoordinate = [\n", kinetic = "0", potential = "0";
    for (int i = 1; i <= 16; ++i) {
        text += fmt::format("{{name = \"x{}\", start = {}, rate = -1}},\n", i, i);
        kinetic += fmt::format(" + x{}'^2/2", i);
        potential += fmt::format(" + x{}^2/2", i);
    }
    folder.put("sixteen.toml", text + "]\nlagrangian.kinetic = \"" + kinetic + "\"\nlagrangian.potential = \"" +
                                   potential + "\"\nconstraint = [{gap = \"x1 + 0.1\", restitution = 0}]\n");
    const Answer run = folder.run("simulate sixteen.toml --end 2 --json -");
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(faults_of(json::parse(run.out)), std::vector<std::string>());
    const Answer proof = folder.run("prove sixteen.toml --end 0.5 --json -");
    EXPECT_EQ(proof.status, 0) << proof.err;
    EXPECT_EQ(faults_of(json::parse(proof.out), "proof.schema.json"), std::vector<std::string>());
}

// A ball nearly touches a post, which a loose tolerance cannot decide. Options are as requested; the rerun is reported.
TEST(Schema, HoldsForARunThatWasMadeAgain) {
    const Folder folder;
    folder.put(
        "post.toml",
        "title = \"post\"\n[[coordinate]]\nname = \"a\"\nrate = 1\n[[coordinate]]\nname = \"b\"\nstart = "
        "0.5\n[lagrangian]\nkinetic = \"(a'^2 + b'^2)/2\"\npotential = \"b + 0.3*cos(2*a)\"\n[[constraint]]\ngap = "
        "\"b - 0.395*exp(-40*(a - 2.6)^2)\"\nrestitution = 0.9\n[run]\nend_time = 2.4\ntolerance = 1e-4\n");
    const std::string what = "undecided at tolerance 0.0001 (the gap is within integration error",
                      then = "): the whole run was repeated with tolerance 1e-14, eps_q 1e-12, eps_v 1e-12\n";
    const Answer data = folder.run("simulate post.toml --json -");
    EXPECT_EQ(data.status, 0);
    EXPECT_TRUE(data.err.starts_with("achilles: warning: " + what)) << data.err;
    EXPECT_TRUE(data.err.ends_with(then)) << data.err;
    const json run = json::parse(data.out);
    EXPECT_EQ(faults_of(run), std::vector<std::string>());
    EXPECT_EQ(run["options"]["tolerance"], 1e-4);
    EXPECT_EQ(run["outcome"]["made_again_by"]["tolerance"], 1e-14);
    const Answer summary = folder.run("simulate post.toml --verbose");
    EXPECT_NE(summary.out.find("tolerance 0.0001, sharp"), std::string::npos) << summary.out;
    EXPECT_NE(summary.out.find("\n  " + what), std::string::npos) << summary.out;
    EXPECT_NE(summary.out.find(then), std::string::npos) << summary.out;
    ASSERT_EQ(run["warnings"].size(), 1U);
    EXPECT_TRUE(run["warnings"][0].get<std::string>().starts_with(what)) << run["warnings"];
    EXPECT_EQ(summary.err.find("warning"), std::string::npos) << "once: " << summary.err;
}

// Proofs that are complete, undecided, and with states at given times.
TEST(Schema, HoldsForProofs) {
    const Folder folder;
    for (const auto& [arguments, status] :
         std::vector<std::pair<std::string, int>>{{"ball_on_sine --end 3", 0},
                                                  {"double_pendulum --end 3 --samples 4 --width 1e-7", 0},
                                                  {"ball_on_floor --set e=0.4..0.5 --end 0.6 --split 2", 0},
                                                  {"ball_on_sine --width 1e-3 --samples 5", 3}}) {
        const Answer answer = folder.run("prove " + arguments + " --json -");
        EXPECT_EQ(answer.status, status) << arguments << "\n" << answer.err;
        EXPECT_EQ(faults_of(json::parse(answer.out), "proof.schema.json"), std::vector<std::string>()) << arguments;
    }
    json proof = json::parse(folder.run("prove ball_on_sine --end 3 --json -").out);
    proof["events"][0]["t"] = 1.7;
    proof["end"].erase("v");
    EXPECT_EQ(faults_of(proof, "proof.schema.json").size(), 3u);
}

TEST(Schema, NoticesWhatIsOtherwise) {
    const Folder folder;
    json run = json::parse(folder.run("simulate ball_on_sine --end 3 --json -").out);
    ASSERT_EQ(faults_of(run), std::vector<std::string>());
    run["events"][0]["t"] = "late";
    EXPECT_EQ(faults_of(run).size(), 1u);
    run["events"][1].erase("q");
    EXPECT_EQ(faults_of(run).size(), 2u);
    run["phases"][0]["kind"] = "flight";
    EXPECT_EQ(faults_of(run).size(), 3u);
    run["more"] = 1;
    EXPECT_EQ(faults_of(run).size(), 4u);
}

}  // namespace
}  // namespace achilles::test
