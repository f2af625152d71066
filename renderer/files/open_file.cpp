#include <sys/stat.h>

#include "renderer/files/open_file_internal.h"

namespace lull {

bool IsNamed(int fd, const std::string& name) {
    struct stat opened, named;
    return fstat(fd, &opened) == 0 && lstat(name.c_str(), &named) == 0 &&
           opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

}  // namespace lull
