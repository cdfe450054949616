// What the program asks of MPI. The library libachilles_mpi.so alone knows <mpi.h> and is linked with it; it is loaded only where
// mpirun has started the program.
#pragma once

extern "C" {

struct AchillesMpi {
    int version;  // of this interface
    // Once, by the thread that asks all else. cores: of those that this process may use, its share.
    void (*begin)(int* rank, int* size, int* cores);
    // Returns when the bytes may go. Waits asleep, not by asking again and again: others want the processor.
    void (*send)(int to, const void* bytes, int size);
    // The size of a message that has come, and whom it is from; -1: there is none. Then its bytes.
    int (*next)(int* from);
    void (*receive)(void* bytes);
    void (*end)();
};
constexpr int achilles_mpi_version = 1;

const AchillesMpi* achilles_mpi();
}
