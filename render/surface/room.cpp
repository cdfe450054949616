#include "surface/room.hpp"

#include <sys/mman.h>

namespace achilles {

void check_room(const std::string& purpose, std::size_t bytes) {
    void* const room =
        ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (room == MAP_FAILED)
        throw NotEnoughMemory("there is not enough memory for " + purpose + ", which may take " +
                              std::to_string(bytes >> 20) + " MB; ulimit -v prints the limit for this process");
    ::munmap(room, bytes);
}

}  // namespace achilles
