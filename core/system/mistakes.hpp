// The mistakes of one system file, gathered while it is read: what is independent of a mistake is read on, what depends
// on it is skipped, and in the end all are told in order of position.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "system/description.hpp"

namespace achilles {

// One mistake, thrown while a file is read and caught by Mistakes::attempt. It holds no line yet: a hostile file has
// very many, and only ten are shown.
struct Mistake {
    Location at;
    std::string message, hint;  // hint: what would be right; may be empty
    bool has_line = true;       // false: no line can be blamed, something is missing
};

// Thrown where reading cannot go on because of a mistake that was added already.
struct AlreadyTold {};

class Mistakes {
 public:
    void add(Mistake mistake);
    // Runs read() and keeps the Mistake it throws. True if it threw none.
    template <class Read>
    bool attempt(const Read& read) {
        try {
            read();
            return true;
        } catch (Mistake& mistake) {
            add(std::move(mistake));
        } catch (const AlreadyTold&) {
        }
        return false;
    }
    std::size_t count() const { return count_; }
    // Throws InputErrors if there are any: the first ten by position, and how many more.
    void raise(const SystemDescription& system) const;

 private:
    std::vector<Mistake> kept_;
    std::size_t count_ = 0;
};

}  // namespace achilles
