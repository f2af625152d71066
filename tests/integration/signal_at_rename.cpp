// Loaded into the program before its libraries (LD_PRELOAD): right after a file has got the name
// $RENAMED_FILE by a rename, as whole files get theirs, the program receives signal
// $RENAMED_SIGNAL. A test that looked for the file from outside would be late on a busy machine.
#include <dlfcn.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string_view>

extern "C" int rename(const char* from, const char* to) noexcept {
    using Rename = int (*)(const char*, const char*);
    const auto next = reinterpret_cast<Rename>(dlsym(RTLD_NEXT, "rename"));
    const int result = next(from, to);
    const char *file = std::getenv("RENAMED_FILE"), *signal = std::getenv("RENAMED_SIGNAL");
    // Any folder: programs may resolve links before they write.
    if (result == 0 && file && signal && std::string_view(to).ends_with(file))
        std::raise(std::atoi(signal));
    return result;
}
