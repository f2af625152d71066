#include "renderer/files/outputs.h"

#include <fmt/core.h>
#include <sys/stat.h>

#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/files/file_io.h"

namespace lull {

namespace {

namespace fs = std::filesystem;

// Finds files again, by their names with all links followed and, where they exist, by device and
// inode.
class FoundFiles {
  public:
    // Returns the file that is the same as this one, null for none, and keeps this one. Files that
    // are not regular are never found.
    const NamedFile* FindOrAdd(const NamedFile& file) {
        struct stat status;
        const bool exists = stat(file.path.c_str(), &status) == 0;
        if (exists && !S_ISREG(status.st_mode)) return nullptr;
        std::error_code error;
        const fs::path name = fs::weakly_canonical(fs::absolute(file.path, error), error);
        const auto [named, isNew] = byName.emplace(name.string(), file);
        if (!isNew) return &named->second;
        if (!exists) return nullptr;
        const auto [same, isFirst] = byInode.emplace(std::pair(status.st_dev, status.st_ino), file);
        return isFirst ? nullptr : &same->second;
    }

  private:
    std::map<std::string, NamedFile> byName;
    std::map<std::pair<dev_t, ino_t>, NamedFile> byInode;
};

}  // namespace

void CheckOutputs(std::span<const NamedFile> outputs, std::span<const NamedFile> inputs) {
    FoundFiles found;
    for (const NamedFile& input : inputs)
        if (!input.path.empty()) found.FindOrAdd(input);
    for (const NamedFile& output : outputs) {
        if (output.path.empty()) continue;
        if (const NamedFile* other = found.FindOrAdd(output))
            throw Error(fmt::format("{} \"{}\" would replace {} \"{}\"; give it another name",
                                    output.role, output.path, other->role, other->path));
        CheckWritable(output.path);
    }
}

std::optional<FileLock> LockOutput(const std::string& output) {
    std::error_code error;
    const fs::file_status status = fs::status(output, error);
    if (fs::exists(status) && !fs::is_regular_file(status)) return {};
    std::optional<FileLock> lock = FileLock::Try(output);
    if (!lock)
        throw Error(output +
                    ": another process is writing this file; wait for its end, or name another");
    return lock;
}

std::string BeginningOfNames(const std::string& output, const std::string& name) {
    if (!output.ends_with('/')) return output.empty() ? name : output;
    std::error_code error;
    fs::create_directories(output, error);
    if (error) throw Error(fmt::format("-o {}: {}", output, error.message()));
    return output + name;
}

}  // namespace lull
