// Checks that there is enough memory before it is allocated, since the system would otherwise kill
// the program, and moves it into large pages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <utility>

#include "renderer/base/error.h"

namespace lull {

// Returns the number of bytes that can still be allocated: by the system, this process (ulimit -v)
// and its group (containers). A very large number if unknown.
int64_t AvailableMemory();

// Throws Error if `bytes` is more: "<what> needs 27.0 GB of memory, 11.3 GB are available;
// <remedy>".
void CheckMemory(int64_t bytes, const std::string& what, const std::string& remedy,
                 const FileLoc& loc = {});

// Prefetches the data at p. The empty asm statement counts as a side effect for GCC, which
// otherwise drops calls of functions that do nothing but prefetch.
inline void Prefetch(const void* p) {
    __builtin_prefetch(p);
    asm volatile("");
}

// Moves the memory of the process into pages of 2 MB where the system has them (Linux 6.1), so that
// scattered reads need fewer address translations. Regions that are not almost fully used stay in
// small pages. For programs alone, once a scene is loaded.
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

// Vectors of zeros that take memory only where they are written, and give it back in parts.

// Allocates zeros for a std::vector whose size never changes: many take memory only where they are
// written, page by page. For types whose default has no bit set.
template <typename T>
struct ZeroAllocator {
    using value_type = T;

    ZeroAllocator() = default;
    template <typename U>
    explicit ZeroAllocator(const ZeroAllocator<U>&) {}

    T* allocate(size_t count) {
        if (void* memory = std::calloc(count, sizeof(T))) return static_cast<T*>(memory);
        throw std::bad_alloc();
    }
    void deallocate(T* memory, size_t) { std::free(memory); }
    template <typename U>
    void construct(U*) {}
    template <typename U, typename First, typename... More>
    void construct(U* at, First&& first, More&&... more) {
        ::new (static_cast<void*>(at)) U(std::forward<First>(first), std::forward<More>(more)...);
    }
    bool operator==(const ZeroAllocator&) const { return true; }
};

// Gives the memory of values that nobody reads any more back to the system; pages that they share
// with others stay. The values become unknown.
void ForgetValues(std::span<const std::byte> values);

}  // namespace lull
