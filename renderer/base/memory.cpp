#include "renderer/base/memory.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <limits>
#include <new>
#include <vector>

namespace lull {

namespace {

constexpr int64_t kUnknown = std::numeric_limits<int64_t>::max();

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

constexpr uintptr_t kLargePage = uintptr_t(1) << 21;

uintptr_t RoundedUp(uintptr_t at) { return (at + kLargePage - 1) / kLargePage * kLargePage; }

struct AnonymousRange {
    uintptr_t begin, end;
    uintptr_t kibibytesInUse;
};

// Addresses that are only reserved, as sanitizers do by the terabyte, are not in use.
std::vector<AnonymousRange> AnonymousRanges() {
    std::vector<AnonymousRange> ranges;
    std::ifstream in("/proc/self/smaps");
    bool isWanted = false;
    for (std::string line; std::getline(in, line);) {
        uintptr_t begin, end, inode, kibibytes;
        char access[5] = {};
        if (std::sscanf(line.c_str(), "%lx-%lx %4s %*s %*s %lu", &begin, &end, access, &inode) ==
            4) {
            isWanted = inode == 0 && std::string(access) == "rw-p";
            if (isWanted) ranges.push_back({begin, end, 0});
        } else if (isWanted && std::sscanf(line.c_str(), "Rss: %lu kB", &kibibytes) == 1) {
            ranges.back().kibibytesInUse = kibibytes;
        }
    }
    return ranges;
}

bool IsNearlyAllInUse(uintptr_t at, std::vector<unsigned char>* pages) {
    if (mincore(reinterpret_cast<void*>(at), kLargePage, pages->data()) != 0) return false;
    const auto inUse =
        std::count_if(pages->begin(), pages->end(), [](unsigned char page) { return page & 1; });
    return size_t(inUse) * 10 >= pages->size() * 9;
}

}  // namespace

int64_t AvailableMemory() {
    return std::max<int64_t>(
        0, std::min({AvailableInSystem(), AvailableInProcess(), AvailableInGroup()}));
}

void CheckMemory(int64_t bytes, const std::string& what, const std::string& remedy,
                 const FileLoc& loc) {
    // A small allocation is not worth a system call.
    constexpr int64_t kSmall = int64_t(1) << 26;
    if (bytes < kSmall) return;
    const int64_t available = AvailableMemory();
    if (bytes > available)
        throw Error(loc, "{} needs {:.1f} GB of memory, {:.1f} GB are available; {}", what,
                    double(bytes) / 1e9, double(available) / 1e9, remedy);
}

void MoveIntoLargePages() {
    constexpr int kCollapse = 25;  // MADV_COLLAPSE, which older headers do not name
    std::vector<unsigned char> pages(kLargePage / uintptr_t(sysconf(_SC_PAGESIZE)));
    for (const AnonymousRange& range : AnonymousRanges()) {
        if (range.kibibytesInUse * 1024 < (range.end - range.begin) / 2) continue;
        for (uintptr_t at = RoundedUp(range.begin); at + kLargePage <= range.end; at += kLargePage)
            if (IsNearlyAllInUse(at, &pages))
                madvise(reinterpret_cast<void*>(at), kLargePage, kCollapse);  // or stays as it is
    }
}

LazyZeros::LazyZeros(size_t bytes) {
    const size_t space = bytes + kLargePage;
    void* p = mmap(nullptr, space, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (p == MAP_FAILED) throw std::bad_alloc();
    mapping = {p, Unmap{space}};
    data = reinterpret_cast<void*>(RoundedUp(reinterpret_cast<uintptr_t>(p)));
    if (bytes >= kLargePage) madvise(data, bytes, MADV_HUGEPAGE);
}

void LazyZeros::Unmap::operator()(void* p) const { munmap(p, bytes); }

void ForgetValues(std::span<const std::byte> values) {
    const uintptr_t page = uintptr_t(sysconf(_SC_PAGESIZE));
    const uintptr_t first = reinterpret_cast<uintptr_t>(values.data());
    const uintptr_t begin = (first + page - 1) / page * page,
                    end = (first + values.size()) / page * page;
    if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_DONTNEED);
}

}  // namespace lull
