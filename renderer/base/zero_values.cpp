#include "renderer/base/zero_values.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>

namespace lull {

void ForgetValues(std::span<const std::byte> values) {
    const uintptr_t page = uintptr_t(sysconf(_SC_PAGESIZE));
    const uintptr_t first = reinterpret_cast<uintptr_t>(values.data());
    const uintptr_t begin = (first + page - 1) / page * page,
                    end = (first + values.size()) / page * page;
    if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_DONTNEED);
}

}  // namespace lull
