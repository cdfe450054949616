// Memory for libraries that end the process where the system refuses them any.
#pragma once

#include <cstddef>
#include <new>
#include <string>
#include <utility>

namespace achilles {

// There is not enough memory, in a sentence.
class NotEnoughMemory : public std::bad_alloc {
 public:
    explicit NotEnoughMemory(std::string sentence) : sentence_(std::move(sentence)) {}
    const char* what() const noexcept override { return sentence_.c_str(); }

 private:
    std::string sentence_;
};

// Throws NotEnoughMemory where the process may not have so many bytes more, by its limit of memory (ulimit -v): Mesa and LLVM
// would end it by a segmentation fault. Nothing stays reserved.
void check_room(const std::string& purpose, std::size_t bytes);

}  // namespace achilles
