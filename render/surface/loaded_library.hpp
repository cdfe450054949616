// A library that is loaded by hand: a machine without it gets a sentence, and its names take nobody else's place.
#pragma once

#include <string>

namespace achilles {

class LoadedLibrary {
 public:
    // Loads it for good: what draws keeps threads and exit handlers. Throws std::runtime_error that names it if it is
    // missing.
    explicit LoadedLibrary(const char* name);

    // The function of this name. Throws std::runtime_error that names both if there is none.
    template <class Function>
    void find(const char* name, Function& function) const {
        function = reinterpret_cast<Function>(address(name));
    }

 private:
    void* address(const char* name) const;

    std::string name_;
    void* library_;
};

}  // namespace achilles
