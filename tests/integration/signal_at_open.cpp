// Loaded into the program before its libraries (LD_PRELOAD): when it is about to open a file whose
// name ends with $OPENED_FILE, it receives signal $OPENED_SIGNAL.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/types.h>

#include <csignal>
#include <cstdarg>
#include <cstdlib>
#include <string_view>

extern "C" int open(const char* path, int flags, ...) {
    using Open = int (*)(const char*, int, ...);
    const auto next = reinterpret_cast<Open>(dlsym(RTLD_NEXT, "open"));
    const char *file = std::getenv("OPENED_FILE"), *signal = std::getenv("OPENED_SIGNAL");
    if (file && signal && std::string_view(path).ends_with(file)) std::raise(std::atoi(signal));
    va_list more;
    va_start(more, flags);
    const mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(more, mode_t) : 0;
    va_end(more);
    return next(path, flags, mode);
}
