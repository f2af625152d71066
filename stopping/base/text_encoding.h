// Recognises what editors and old programs put around a text.
#pragma once

#include <string_view>

namespace lull {

// The byte-order mark of UTF-8, which a text may begin with.
inline constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

// Returns "UTF-16" or "UTF-32" for such text, "" for all else.
std::string_view WideEncoding(std::string_view bytes);

// Old programs mark the end of a text by these: Control-Z and NUL.
inline constexpr std::string_view kEndMarks("\x1a\0", 2);

// Returns the text without them and all behind, if nothing but blanks is there.
std::string_view WithoutEndMarks(std::string_view text);

}  // namespace lull
