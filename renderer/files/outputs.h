// Keeps results from replacing each other, or their inputs.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "renderer/files/file_lock.h"

namespace lull {

// A file as a user knows it: `role` is its purpose, "--report" or "a file of the scene".
struct NamedFile {
    std::string role, path;
};

// For use before the work begins. Throws Error if an output would be the same file as another one
// or as an input, by whatever name or link, or could not be written now (see CheckWritable()).
// Empty paths stand for none, and devices are no files.
void CheckOutputs(std::span<const NamedFile> outputs, std::span<const NamedFile> inputs);

// Keeps other processes from writing files that belong together, of which one is `output`, until it
// is destroyed; nothing for devices. Throws Error if another process is writing them.
std::optional<FileLock> LockOutput(const std::string& output);

// Returns how the names of all results begin: `output`, or `name` if that is empty. "DIR/" stands
// for files in the folder DIR, which is made if it is not there, whose names begin with `name`.
// Throws Error if it cannot be made.
std::string BeginningOfNames(const std::string& output, const std::string& name);

}  // namespace lull
