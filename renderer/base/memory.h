// Checks that there is enough memory before it is allocated, since the system would otherwise kill
// the program, and moves it into large pages.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "renderer/base/error.h"

namespace lull {

// Returns the number of bytes that can still be allocated: the memory available in the system,
// within the limits of this process (ulimit -v) and of its group (containers). A very large number
// if unknown.
int64_t AvailableMemory();

// Throws Error if that is less than `bytes`: "<what> needs 27.0 GB of memory, 11.3 GB are
// available; <remedy>".
void CheckMemory(int64_t bytes, const std::string& what, const std::string& remedy,
                 const FileLoc& loc = {});

// Prefetches the data at p. The empty asm statement counts as a side effect for GCC, which
// otherwise drops calls of functions that do nothing but prefetch.
inline void Prefetch(const void* p) {
    __builtin_prefetch(p);
    asm volatile("");
}

// Moves the memory of the process into pages of 2 MB where the system has them (Linux 6.1), so that
// scattered reads need fewer address translations. Takes hardly any more memory: regions that are
// not almost fully used stay in small pages. For programs, once a scene is loaded: a library should
// not touch the memory of its host.
void MoveIntoLargePages();

// Zeros, which take memory only where they are written: page by page, or in pages of 2 MB if
// there are at least that many bytes and the system has such pages.
class LazyZeros {
  public:
    LazyZeros() = default;
    // Throws std::bad_alloc.
    explicit LazyZeros(size_t bytes);

    void* Data() const { return data; }  // starts a page, one of 2 MB if there are as many bytes

  private:
    struct Unmap {
        size_t bytes;
        void operator()(void* p) const;
    };
    std::unique_ptr<void, Unmap> mapping;
    void* data = nullptr;
};

}  // namespace lull
