// What a picture is made from: system files and journals, by the names they were asked for. From the disk, and then
// they are remembered; or from a picture that remembers them, and then from nowhere else.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "system/description.hpp"

namespace achilles {

struct Source {
    enum class Kind { system, journal, refusal };  // refusal: what was said instead of a system that could not be read
    Kind kind = Kind::system;
    std::string name, text;
    friend bool operator==(const Source&, const Source&) = default;
};

class Inputs {
 public:
    Inputs() = default;
    explicit Inputs(std::vector<Source> kept) : kept_(std::move(kept)), from_picture_(true) {}

    // The text of a system by path or name, and read. What a name stands for may change while a journal saves files:
    // every time it is asked for counts. Throw InputError.
    std::string text(const std::string& name);
    SystemDescription system(const std::string& name);
    std::string journal(const std::string& path);
    // The first that was asked for: where a command line names none, a picture tells.
    std::string first_system() const;
    const std::vector<Source>& kept() const { return kept_; }

 private:
    const Source& next(const std::string& name, bool is_journal);

    std::vector<Source> kept_;
    bool from_picture_ = false;
    std::map<std::pair<std::string, bool>, std::size_t> asked_;  // how often, of a picture
};

}  // namespace achilles
