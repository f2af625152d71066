#include "renderer/commands/talk.h"

#include <fmt/format.h>

#include "renderer/output/file_io.h"

namespace lull {

void PrintTalk(const std::string& message) { fmt::print(stderr, "lull: {}\n", message); }

void WriteBytes(const std::string& path, std::span<const std::byte> bytes) {
    WriteFileAtomically(path, bytes);
}

}  // namespace lull
