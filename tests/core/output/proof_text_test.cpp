// The printed form of a proof, read back and compared with its JSON: hypotheses lie inside the proved boxes,
// conclusions contain those of the JSON.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <sstream>

#include "core/output/printed.hpp"
#include "enclose/initial_uncertainty.hpp"
#include "output/proof.hpp"

namespace achilles::test {

namespace {

using Json = nlohmann::json;

Interval interval_of(const Json& ends) {
    return {ends[0].is_null() ? -rounding::infinity : ends[0].get<double>(),
            ends[1].is_null() ? rounding::infinity : ends[1].get<double>()};
}

// Reads line by line. An unexpected line fails the test.
class Reader {
 public:
    Reader(const Model& model, const std::string& text, const Json& json)
        : description_(model.description()), text_(text), json_(json), lines_(text) {
        for (const auto& coordinate : description_.coordinates) {
            names_.push_back(coordinate.name);
            rates_.push_back(coordinate.name + "'");
        }
    }

    void read() {
        next_is(description_.title);
        next_is("");
        hypotheses();
        reach();
        next_is("");
        events();
        end();
        const std::string message = json_["outcome"]["message"];
        if (json_["end"].is_null()) {
            EXPECT_EQ(line_, "Undecided from there: " + message + ".");
            next_line();
            next_line();
        }
        EXPECT_EQ(text_.find(message, text_.find(message) + 1), std::string::npos) << "twice: " << message;
        if (line_.starts_with("The end time")) next_line(), next_line();
        EXPECT_EQ(line_, "Assumptions: " + json_["assumptions"].get<std::string>() + ".");
    }

    int conclusions = 0, cuts = 0;

 private:
    void next_line() {
        if (!std::getline(lines_, line_)) line_ = "the end of the text";
    }
    void next_is(const std::string& expected) {
        next_line();
        EXPECT_EQ(line_, expected) << text_;
    }

    // Parses "  x = 1, y in [0, 1]".
    std::vector<PrintedSet> list(const std::vector<std::string>& names) {
        std::vector<PrintedSet> all;
        next_line();
        std::size_t at = line_.find_first_not_of(' ');
        for (std::size_t i = 0; i < names.size(); ++i) {
            EXPECT_EQ(line_.compare(at, names[i].size() + 1, names[i] + " "), 0) << line_;
            at += names[i].size() + 1;
            const std::size_t end = i + 1 < names.size() ? line_.find(", " + names[i + 1] + " ", at) : line_.size();
            EXPECT_NE(end, line_.npos) << line_;
            if (end == line_.npos) return {};
            all.push_back(PrintedSet::of(line_.substr(at, end - at)));
            at = end + 2;
        }
        return all;
    }

    void assumed(const std::vector<std::string>& names, const Json& boxes) {
        const std::vector<PrintedSet> all = list(names);
        ASSERT_EQ(all.size(), names.size());
        for (std::size_t i = 0; i < names.size(); ++i) {
            const Interval box = interval_of(boxes.is_object() ? boxes[names[i]] : boxes[i]);
            EXPECT_TRUE(lies_in(all[i], box)) << line_;
            EXPECT_GE(all[i].width(), Real(width(box)) - Real(0x1p-46) * mag(box)) << "less than is proved: " << line_;
        }
    }

    void concluded(const PrintedSet& said, const Interval& box) {
        EXPECT_TRUE(holds(said, box)) << line_;
        EXPECT_LE(said.width(), Real(1.3) * width(box) + Real(4e-16) * mag(box)) << line_;
        ++conclusions;
    }

    void concluded(const std::vector<std::string>& names, const Json& boxes) {
        const std::vector<PrintedSet> all = list(names);
        ASSERT_EQ(all.size(), boxes.size());
        for (std::size_t i = 0; i < all.size(); ++i) concluded(all[i], interval_of(boxes[i]));
    }

    void hypotheses() {
        next_is("For every start with");
        assumed(names_, json_["claim"]["q"]);
        assumed(rates_, json_["claim"]["v"]);
        std::vector<std::string> parameters;
        for (const auto& parameter : description_.parameters) parameters.push_back(parameter.name);
        if (parameters.empty()) return;
        next_is("and all parameters with");
        assumed(parameters, json_["claim"]["parameters"]);
    }

    void reach() {
        const bool is_whole = !json_["end"].is_null();
        const std::string begin = is_whole ? "the completed execution is proved until t = "
                                           : "the completed execution is proved only until t = ";
        next_line();
        ASSERT_TRUE(line_.starts_with(begin) && line_.ends_with(":")) << line_;
        const std::string time = line_.substr(begin.size(), line_.size() - begin.size() - 1);
        const double until = json_["proved_until"];
        if (is_whole) {
            EXPECT_EQ(std::stod(time), until);
        } else {
            EXPECT_LE(Real(time), Real(until));
        }
    }

    std::string word() const { return line_.substr(2, line_.find(' ', 3) - 2); }

    void events() {
        const Json& events = json_["events"];
        std::size_t next = 0;
        for (next_line(); line_.starts_with("  ") && word() != "end" && word() != "at"; next_line()) {
            if (line_.starts_with("  (the parts list")) {
                EXPECT_EQ(json_["events_differ"], true);
                continue;
            }
            if (word() == "impacts") {
                next = impacts(next);
                continue;
            }
            ASSERT_LT(next, events.size()) << line_;
            event(events[next++]);
        }
        EXPECT_EQ(next, events.size()) << text_;
    }

    // Parses "  impacts  7 to 9 more before the cut, by part" from line `next` on.
    std::size_t impacts(std::size_t next) {
        int few = 0, many = 0;
        const bool is_range = std::sscanf(line_.c_str(), "  impacts %d to %d", &few, &many) == 2;
        const Json& events = json_["events"];
        for (int i = 0; i < few; ++i, ++next) {
            EXPECT_LT(next, events.size()) << line_;
            if (next >= events.size()) return next;
            EXPECT_EQ(events[next]["kind"], "impact") << line_;
        }
        const bool is_cut = next < events.size() && events[next]["kind"] == "zeno" && events[next]["impacts"] != 0;
        EXPECT_EQ(line_.find("before the cut") != line_.npos, is_cut) << line_;
        if (!is_cut) return next;
        ++cuts;
        const Json& zeno = events[next];
        EXPECT_EQ(is_range, zeno.contains("impacts_of_parts")) << line_;
        if (is_range) {
            EXPECT_EQ(many - few, zeno["impacts_of_parts"][1].get<int>() - zeno["impacts_of_parts"][0].get<int>());
            EXPECT_EQ(zeno["impacts_of_parts"][0], zeno["impacts"]);
        }
        return next;
    }

    void event(const Json& event) {
        const bool is_landing = event["kind"] == "zeno" && event["impacts"] == 0;
        EXPECT_EQ(word(), is_landing ? "landing" : event["kind"].get<std::string>()) << line_;
        const std::size_t at = line_.find(" t ") + 3;
        const std::size_t comma = description_.constraints.size() > 1 ? line_.rfind(", ") : line_.npos;
        if (comma != line_.npos) {
            EXPECT_EQ(line_.substr(comma + 2), event["contact"].get<std::string>());
        }
        concluded(PrintedSet::of(line_.substr(at, comma == line_.npos ? comma : comma - at)), interval_of(event["t"]));
        concluded(names_, event["q"]);
    }

    void end() {
        if (!json_["end"].is_null()) state("end", json_["end"]);
        if (json_.contains("samples"))
            for (const Json& sample : json_["samples"]) state("at", sample);
        next_line();
    }

    void state(const std::string& what, const Json& there) {
        EXPECT_EQ(word(), what) << line_;
        EXPECT_EQ(std::stod(line_.substr(line_.find('=') + 2)), there["t"].get<double>()) << line_;
        concluded(names_, there["q"]);
        concluded(rates_, there["v"]);
        next_line();
    }

    const SystemDescription& description_;
    const std::string& text_;
    const Json& json_;
    std::istringstream lines_;
    std::string line_;
    std::vector<std::string> names_, rates_;
};

struct ReadProof {
    std::string text;
    Json json;
    int conclusions = 0, cuts = 0;
};

ReadProof read_back(const Model& model, const achilles::EnclosureProblem& claim, const Enclosure& proof) {
    ReadProof result{proof_text(model, claim, proof), Json::parse(to_json(model, claim, proof))};
    Reader reader(model, result.text, result.json);
    reader.read();
    result.conclusions = reader.conclusions;
    result.cuts = reader.cuts;
    return result;
}

ReadProof read_back(const std::string& system, double end, const InitialUncertainty& spread, int parts = 1) {
    const auto model = load(system);
    achilles::Run run = model->default_run();
    run.options.end_time = end;
    achilles::EnclosureProblem claim = problem_of(model->description(), run, spread);
    claim.times = {0.25 * end, 0.7 * end};
    return read_back(*model, claim, prove_in_parts(model, claim, parts));
}

bool says(const ReadProof& proof, const std::string& words) { return proof.text.find(words) != std::string::npos; }

}  // namespace

TEST(ProofText, ClaimsNoMoreThanItsJson) {
    const std::vector<std::string> names = systems_without_friction();
    std::vector<std::shared_ptr<const Model>> models(names.size());
    std::vector<achilles::EnclosureProblem> claims(2 * names.size());
    std::vector<Enclosure> proofs(claims.size());
    tbb::parallel_for(std::size_t{0}, claims.size(), [&](std::size_t i) {
        const auto model = load(names[i / 2]);
        achilles::Run run = model->default_run();
        run.options.max_steps = 40;  // a short proof, complete or stopped early
        claims[i] = problem_of(model->description(), run, {i % 2 == 0 ? 0.0 : 3e-9, {}});
        claims[i].times = {0.9 * run.options.start_time + 0.1 * run.options.end_time};
        proofs[i] = prove(model, claims[i]);
        if (i % 2 == 0) models[i / 2] = model;
    });
    int conclusions = 0, cuts = 0;
    for (std::size_t i = 0; i < claims.size(); ++i) {
        SCOPED_TRACE(names[i / 2]);
        const ReadProof proof = read_back(*models[i / 2], claims[i], proofs[i]);
        conclusions += proof.conclusions;
        cuts += proof.cuts;
    }
    EXPECT_GT(conclusions, 400);
    EXPECT_GT(cuts, 15);
}

// Typed numbers are printed as typed: rounding hypotheses outwards would state a false theorem. Members of the printed
// set impact as early and as late as the printed time allows.
TEST(ProofText, PrintsHypothesesAsTyped) {
    const ReadProof radius = read_back("ball_on_floor", 0.9, {0.0, {{"r", 0.059, 0.061}}});
    EXPECT_TRUE(says(radius, "m = 1, r in [0.059, 0.061], g = 9.81, e = 0.7\n")) << radius.text;
    const ReadProof gravity = read_back("ball_on_floor", 0.9, {0.0, {{"g", 9.80, 9.82}}});
    EXPECT_TRUE(says(gravity, "m = 1, r = 0.06, g in [9.8, 9.82], e = 0.7\n")) << gravity.text;
    const ReadProof start = read_back("ball_on_floor", 0.5, {0.01, {}});
    EXPECT_TRUE(says(start, "  x in [-0.01, 0.01], y in [0.99, 1.01]\n  x' in [0.49, 0.51], y' in [-0.01, 0.01]\n"))
        << start.text;
    const ReadProof both = read_back("ball_on_floor", 0.2, {0.3, {{"x", 0.1, 0.2}}});
    EXPECT_TRUE(says(both, "  x in [-0.2, 0.5], y in [0.7, 1.3]\n")) << both.text;
    const auto time_of = [](const ReadProof& proof) {
        const std::size_t at = proof.text.find("impact   t ") + 11;
        return PrintedSet::of(proof.text.substr(at, proof.text.find('\n', at) - at));
    };
    const auto lands = [](const char* r, const char* g) { return sqrt(2 * (1 - Real(r)) / Real(g)); };
    for (const char* r : {"0.059", "0.06", "0.061"}) {
        EXPECT_LE(time_of(radius).low, lands(r, "9.81"));
        EXPECT_GE(time_of(radius).high, lands(r, "9.81"));
    }
    for (const char* g : {"9.80", "9.82"}) {
        EXPECT_LE(time_of(gravity).low, lands("0.06", g));
        EXPECT_GE(time_of(gravity).high, lands("0.06", g));
    }
    EXPECT_LT(time_of(radius).width(), 4.9e-4);
}

// Proofs in parts, and undecided ones.
TEST(ProofText, OfPartsClaimsNoMoreThanItsJson) {
    const ReadProof parts = read_back("ball_on_sine", 12.0, {0.0, {{"e", 0.499, 0.501}}}, 16);
    EXPECT_TRUE(says(parts, "  impacts  7 to 8 more before the cut, by part\n")) << parts.text;
    EXPECT_FALSE(says(parts, "different events")) << parts.text;
    EXPECT_TRUE(says(parts, "  zeno     t = 2.725")) << parts.text;
    EXPECT_TRUE(says(parts, "  release  t = 3.7318")) << parts.text;
    const ReadProof undecided = read_back("ball_on_sine", 12.0, {0.0, {{"e", 0.46, 0.5}}});
    EXPECT_TRUE(undecided.json["end"].is_null());
}

// If the requested time is not a double, the proof is for the rounded one.
TEST(ProofText, SaysWhichTimesAreRounded) {
    EXPECT_TRUE(says(read_back("ball_on_floor", 0.3, {}), "doubles nearest"));
    const auto model = load("ball_on_floor");
    achilles::Run run = model->default_run();
    run.options.end_time = 0.25;
    const achilles::EnclosureProblem claim = problem_of(model->description(), run, {});
    EXPECT_FALSE(says(read_back(*model, claim, prove(model, claim)), "doubles nearest"));
}

}  // namespace achilles::test
