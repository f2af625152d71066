// Reads text in UTF-8 (RFC 3629), of which not all bytes need be that.
#pragma once

#include <string>
#include <string_view>

namespace lull {

// Returns whether a byte of UTF-8 is not the first of its character.
constexpr bool IsWithinCharacter(char byte) {
    return (static_cast<unsigned char>(byte) & 0xc0) == 0x80;
}

// Returns the bytes, 1 to 4, of the character that a text begins with; 0 if it begins with none.
size_t CharacterBytes(std::string_view text);

// Returns the text with U+FFFD in place of NUL, and of each byte that belongs to no character.
std::string ToUtf8(std::string_view text);

// Returns the beginning of a text in UTF-8, of up to `most` bytes, without part of a character.
std::string BeginningOf(const std::string& text, size_t most);

}  // namespace lull
