// URIs of buffers and images.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace lull {

// A data URI of a byte of 0, for buffers that nothing reads.
inline constexpr const char* kOneByteUri = "data:application/octet-stream;base64,AA==";

// Undoes the percent-encoding of a URI.
std::string DecodeUri(std::string_view uri);

// Returns whether the URI is data itself (RFC 2397).
bool IsDataUri(std::string_view uri);
// Returns the base64 of such a URI, without percent-encoding and white space; nothing where it is
// encoded otherwise.
std::optional<std::string> Base64Of(std::string_view dataUri);

// Gives the data URIs of a file that has been checked a media type that the library knows: it takes
// others for names of files, or loses their data. Returns whether any has changed.
bool UnifyDataUris(nlohmann::json* root);

}  // namespace lull
