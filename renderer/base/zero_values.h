// Vectors of zeros that take memory only where they are written, and give it back in parts.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <span>
#include <utility>

namespace lull {

// Allocates zeros for a std::vector whose size never changes: its values are 0 at first, and where
// they are many, they take memory only where they are written, page by page. For types whose
// default has no bit set.
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
