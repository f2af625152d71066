// Says before memory is taken whether there is enough, since the system would only end the program,
// and has it in pages that are quick to find.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "renderer/base/error.h"

namespace lull {

// Returns how many bytes can still be taken: what the system has available, within the limits of
// this process (ulimit -v) and of its group (containers). Very many where that is not known.
int64_t AvailableMemory();

// Throws Error if that is less than `bytes`: "<what> needs 27.0 GB of memory, 11.3 GB are
// available; <remedy>".
void CheckMemory(int64_t bytes, const std::string& what, const std::string& remedy,
                 const FileLoc& loc = {});

// Starts to load what is at p. The statement without code is an effect for GCC, which leaves out
// calls of functions that do nothing but prefetch, as if they had none.
inline void Prefetch(const void* p) {
    __builtin_prefetch(p);
    asm volatile("");
}

// Moves what the process has in memory into pages of 2 MB where the system has such (Linux 6.1), so
// that reads here and there need not look up a small page each. Takes next to no more memory: what
// is not nearly all in use stays in small pages. For programs, once a scene is there: libraries
// have no business with the memory of others.
void MoveIntoLargePages();

// Holds zeros, of which only those take memory that are written: page by page, or where they are
// 2 MB and more in pages of that size, where the system has such.
class LazyZeros {
  public:
    LazyZeros() = default;
    // Throws std::bad_alloc.
    explicit LazyZeros(size_t bytes);

    void* Data() const { return data; }  // begins a page, of 2 MB where there is so much

  private:
    struct Unmap {
        size_t bytes;
        void operator()(void* p) const;
    };
    std::unique_ptr<void, Unmap> mapping;
    void* data = nullptr;
};

}  // namespace lull
