#include "renderer/base/memory.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>

namespace lull {

namespace {

constexpr int64_t kUnknown = std::numeric_limits<int64_t>::max();

// Reads one number from a file of the system; kUnknown if there is none, as in "max".
int64_t NumberIn(const char* path) {
    std::ifstream in(path);
    int64_t number;
    return in >> number ? number : kUnknown;
}

int64_t AvailableInSystem() {
    std::ifstream in("/proc/meminfo");
    std::string key;
    for (int64_t kibibytes; in >> key >> kibibytes; in.ignore(100, '\n'))
        if (key == "MemAvailable:") return kibibytes * 1024;
    return kUnknown;
}

int64_t AvailableInProcess() {
    rlimit limit;
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnknown;
    const int64_t pages = NumberIn("/proc/self/statm");
    return pages == kUnknown ? kUnknown : int64_t(limit.rlim_cur) - pages * sysconf(_SC_PAGESIZE);
}

int64_t AvailableInGroup() {
    const int64_t limit = NumberIn("/sys/fs/cgroup/memory.max");
    const int64_t taken = NumberIn("/sys/fs/cgroup/memory.current");
    return limit == kUnknown || taken == kUnknown ? kUnknown : limit - taken;
}

}  // namespace

int64_t AvailableMemory() {
    return std::max<int64_t>(
        0, std::min({AvailableInSystem(), AvailableInProcess(), AvailableInGroup()}));
}

void CheckMemory(int64_t bytes, const std::string& what, const std::string& remedy,
                 const FileLoc& loc) {
    // What is small is not worth asking the system for.
    constexpr int64_t kSmall = int64_t(1) << 26;
    if (bytes < kSmall) return;
    const int64_t available = AvailableMemory();
    if (bytes > available)
        throw Error(loc, fmt::format("{} needs {:.1f} GB of memory, {:.1f} GB are available; {}",
                                     what, double(bytes) / 1e9, double(available) / 1e9, remedy));
}

}  // namespace lull
