#include "surface/loaded_library.hpp"

#include <dlfcn.h>

#include <stdexcept>

namespace achilles {

LoadedLibrary::LoadedLibrary(const char* name) : name_(name), library_(dlopen(name, RTLD_NOW | RTLD_LOCAL)) {
    if (library_ == nullptr) throw std::runtime_error(name_ + " is missing");
}

void* LoadedLibrary::address(const char* name) const {
    void* found = dlsym(library_, name);
    if (found == nullptr) throw std::runtime_error(name_ + " lacks " + name);
    return found;
}

}  // namespace achilles
