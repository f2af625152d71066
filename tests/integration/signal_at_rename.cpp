// Loaded into the program before its libraries (LD_PRELOAD): right after all of $RENAMED_FILES
// (separated by spaces) have got their names by renames, as whole files get theirs, the program
// receives signal $RENAMED_SIGNAL. A test that looked for the files from outside would be late on
// a busy machine. Several files may be written side by side.
#include <dlfcn.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ranges>
#include <string_view>

extern "C" int rename(const char* from, const char* to) noexcept {
    using Rename = int (*)(const char*, const char*);
    const auto next = reinterpret_cast<Rename>(dlsym(RTLD_NEXT, "rename"));
    const int result = next(from, to);
    const char *files = std::getenv("RENAMED_FILES"), *signal = std::getenv("RENAMED_SIGNAL");
    if (result != 0 || !files || !signal) return result;
    static std::atomic<int> renamed = 0;
    int count = 0;
    bool isOneOfThem = false;
    for (const auto name : std::views::split(std::string_view(files), ' ')) {
        ++count;
        // Any folder: programs may resolve links before they write.
        isOneOfThem |= std::string_view(to).ends_with(std::string_view(name.begin(), name.end()));
    }
    if (isOneOfThem && ++renamed == count) std::raise(std::atoi(signal));
    return result;
}
