// What commands lend to those who do not know the terminal, or how files are written.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace lull {

// Prints a message as a line of its own on stderr, after the program's name.
void PrintTalk(const std::string& message);

// Is WriteFileAtomically(), for those who are to be given a function of this kind.
void WriteBytes(const std::string& path, std::span<const std::byte> bytes);

}  // namespace lull
