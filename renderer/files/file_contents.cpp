#include "renderer/files/file_contents.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>

namespace lull {
namespace {

constexpr size_t kLongestPath = 4096;  // that a system knows

class Descriptor {
  public:
    explicit Descriptor(int fd) : fd(fd) {}
    ~Descriptor() {
        if (fd >= 0) close(fd);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    const int fd;
};

}  // namespace

FileContents ReadFile(const std::string& path, const FileLoc& loc) {
    const auto fail = [&](const std::string& why) {
        throw Error(loc, "cannot read '" + Printable(path, kLongestPath) + "': " + why);
    };
    // A name with a NUL byte would silently stand for its beginning.
    if (path.find('\0') != std::string::npos) fail("the name holds a NUL character");
    // Not to block, so that a named pipe is refused below and not waited for.
    const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.fd < 0) fail(std::strerror(errno));
    struct stat status;
    if (fstat(file.fd, &status) != 0) fail(std::strerror(errno));
    if (S_ISDIR(status.st_mode)) fail("it is a directory; name a file in it");
    if (!S_ISREG(status.st_mode)) fail("it is not a regular file");

    FileContents contents;
    contents.size = size_t(status.st_size);
    contents.bytes.reset(new (std::nothrow) char[contents.size]);
    if (!contents.bytes) fail("it is too large for the memory");
    for (size_t done = 0; done < contents.size;) {
        const ssize_t n = read(file.fd, contents.bytes.get() + done, contents.size - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) fail(std::strerror(errno));
        if (n == 0) {  // it shrank since it was measured
            contents.size = done;
            break;
        }
        done += size_t(n);
    }
    return contents;
}

}  // namespace lull
