#include "renderer/input/pbrt/pbrt_lexer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <utility>

#include "renderer/files/file_io.h"
#include "renderer/input/inflate.h"
#include "stopping/base/input_file.h"

namespace lull {
namespace {

// Bounds the total of files included repeatedly: deep nesting of doubled includes grows without end
// from a few lines. Every inclusion counts as kLeastBytes at least.
constexpr size_t kMostRepeatedBytes = size_t(1) << 30;
constexpr size_t kLeastBytes = size_t(1) << 14;
// Bounds the length of a string; file names are shorter everywhere.
constexpr ptrdiff_t kLongestString = 4096;

std::string Quoted(std::string_view text, char quote) {
    std::string result(1, quote);
    result += Printable(text);
    result += quote;
    return result;
}

bool IsSpace(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

bool IsDelimiter(char c) { return IsSpace(c) || c == '"' || c == '[' || c == ']' || c == '#'; }

char Unescape(char c, const FileLoc& loc) {
    constexpr std::string_view kWritten = "bfnrt\\'\"", kRead = "\b\f\n\r\t\\'\"";
    const size_t at = kWritten.find(c);
    if (at == kWritten.npos)
        throw Error(loc, "unknown escape '\\" + Printable({&c, 1}) +
                             "' in a string; write a backslash as '\\\\'");
    return kRead[at];
}

// Files that are given for scenes of pbrt and are none: their first bytes, and their extensions.

using namespace std::string_view_literals;

constexpr std::pair<std::string_view, const char*> kFormats[] = {
    {"BLENDER"sv, "a Blender file; render it in Blender with the add-on, or export it as glTF"},
    {"\x28\xb5\x2f\xfd"sv,
     "compressed (zstd), as Blender's files are; render those in Blender with the add-on"},
    {"PK\x03\x04"sv, "a ZIP archive; unpack it first"},
    {"7z\xbc\xaf"sv, "a 7z archive; unpack it first"},
    {"glTF"sv, "a binary glTF file; name it .glb"},
    {"ply\n"sv, "a PLY mesh; name a scene that uses it"},
    {"ply\r"sv, "a PLY mesh; name a scene that uses it"},
    {"\x89PNG"sv, "a PNG image; name a scene"},
    {"\xff\xd8\xff"sv, "a JPEG image; name a scene"},
    {"\x76\x2f\x31\x01"sv, "an OpenEXR image; name a scene"},
    {"\x89HDF"sv, "an HDF5 file; name a scene"},
    {"Kaydara FBX"sv, "an FBX file; export the scene as glTF"},
    {"PXR-USDC"sv, "a USD file; export the scene as glTF"},
    {"#usda"sv, "a USD file; export the scene as glTF"},
    {"<?xml"sv, "an XML file, as Mitsuba's scenes are; export the scene for pbrt or as glTF"},
    {"<scene"sv, "an XML file, as Mitsuba's scenes are; export the scene for pbrt or as glTF"},
};

constexpr std::pair<std::string_view, const char*> kExtensions[] = {
    {".blend", "a Blender file; render it in Blender with the add-on, or export it as glTF"},
    {".obj", "a Wavefront OBJ mesh; export the scene as glTF"},
    {".mtl", "a Wavefront material; export the scene as glTF"},
    {".stl", "an STL mesh; export the scene as glTF"},
    {".dae", "a COLLADA file; export the scene as glTF"},
    {".fbx", "an FBX file; export the scene as glTF"},
    {".usda", "a USD file; export the scene as glTF"},
};

// Returns the format of a file, and the remedy, if its name or first bytes are of a known format or
// not text at all; "" if it may be a pbrt scene.
std::string ForeignFormat(std::string_view name, std::string_view bytes) {
    const std::string lower = LowerCase(std::string(name));
    for (const auto& [extension, what] : kExtensions)
        if (lower.ends_with(extension)) return what;
    for (const auto& [magic, what] : kFormats)
        if (bytes.starts_with(magic)) return what;
    if (const std::string_view wide = WideEncoding(bytes); !wide.empty())
        return std::string(wide) + " text; save it as UTF-8";
    // No other text has a NUL byte.
    constexpr size_t kLookedAt = 1024;
    if (bytes.substr(0, kLookedAt).find('\0') == std::string_view::npos) return "";
    return "a binary file; name a scene of pbrt or glTF";
}

}  // namespace

std::string Describe(const Token& token) {
    switch (token.kind) {
        case TokenKind::End:
            return "the end of the file";
        case TokenKind::Open:
            return "'['";
        case TokenKind::Close:
            return "']'";
        case TokenKind::String:
            return Quoted(token.text, '"');
        default:
            return Quoted(token.text, '\'');
    }
}

PbrtLexer::PbrtLexer(const std::string& file) { Open(file, {}); }

void PbrtLexer::Include(const std::string& file, const FileLoc& loc) { Open(file, loc); }

void PbrtLexer::Open(const std::string& file, const FileLoc& loc) {
    Source source;
    source.name = std::make_shared<const std::string>(file);
    source.contents = Inflated(ReadFile(file, loc), loc);
    std::error_code ignored;
    source.canonical = std::filesystem::canonical(file, ignored).string();
    for (const Source& open : sources)
        if (open.canonical == source.canonical)
            throw Error(loc, "'{}' includes itself; remove this Include", Printable(file, 4096));
    if (inclusions[source.canonical]++ > 0)
        repeatedBytes += std::max(source.contents.size, kLeastBytes);
    if (repeatedBytes > kMostRepeatedBytes)
        throw Error(loc,
                    "files included again and again come to more than 1 GiB of text; use "
                    "ObjectInstance to repeat geometry");
    const std::string_view bytes = source.contents.View();
    const bool isWide = !WideEncoding(bytes).empty();
    const std::string_view text = isWide ? bytes : CleanText(bytes, loc);
    if (const std::string format = ForeignFormat(file, text); !format.empty())
        throw Error(loc, "'{}' is not a pbrt scene file: it is {}", Printable(file, 4096), format);
    source.begin = source.pos = text.data();
    source.end = text.data() + text.size();
    sources.push_back(std::move(source));
}

void PbrtLexer::Rewind() {
    sources.resize(1);
    sources[0].pos = sources[0].begin;
    sources[0].line = 1;
    inclusions = {{sources[0].canonical, 1}};
    repeatedBytes = 0;
    hasPeeked = false;
}

std::vector<std::string> PbrtLexer::Files() const {
    std::vector<std::string> files;
    for (const auto& [file, count] : inclusions) files.push_back(file);
    return files;
}

FileLoc PbrtLexer::Loc() const { return {sources.back().name, sources.back().line}; }

bool PbrtLexer::SkipSpace() {
    Source& s = sources.back();
    for (; s.pos < s.end; ++s.pos) {
        if (*s.pos == '\n' || (*s.pos == '\r' && (s.pos + 1 == s.end || s.pos[1] != '\n')))
            ++s.line;
        else if (*s.pos == '#') {
            while (s.pos < s.end && *s.pos != '\n' && *s.pos != '\r') ++s.pos;
            --s.pos;
        } else if (!IsSpace(*s.pos))
            return true;
    }
    return false;
}

std::string_view PbrtLexer::WordAt(const char* pos) const {
    const char* end = std::find_if(pos, sources.back().end, IsDelimiter);
    return {pos, size_t(end - pos)};
}

const Token& PbrtLexer::Peek() {
    if (!hasPeeked) peeked = Take();
    hasPeeked = true;
    return peeked;
}

Token PbrtLexer::Take() {
    if (hasPeeked) {
        hasPeeked = false;
        return std::move(peeked);
    }
    while (!SkipSpace()) {
        if (sources.size() == 1) return {TokenKind::End, "", Loc()};
        sources.pop_back();
    }
    Source& s = sources.back();
    Token token{TokenKind::Word, "", Loc()};
    if (*s.pos == '[' || *s.pos == ']') {
        token.kind = *s.pos++ == '[' ? TokenKind::Open : TokenKind::Close;
    } else if (*s.pos == '"') {
        ReadString(&token);
    } else {
        const std::string_view word = WordAt(s.pos);
        for (const char c : word)
            if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
                throw Error(token.loc, "control character in '" + Printable(word) +
                                           "': this is not a pbrt scene file");
        s.pos += word.size();
        token.text = word;
    }
    return token;
}

void PbrtLexer::ReadString(Token* token) {
    Source& s = sources.back();
    token->kind = TokenKind::String;
    const char* const begin = ++s.pos;
    for (;; ++s.pos) {
        if (s.pos == s.end || *s.pos == '\n' || *s.pos == '\r')
            throw Error(token->loc,
                        "the string that begins with \"{}\" has no closing quote on its line",
                        Printable({begin, size_t(std::min<ptrdiff_t>(s.pos - begin, 40))}));
        if (s.pos - begin > kLongestString)
            throw Error(token->loc, "a string is longer than " + std::to_string(kLongestString) +
                                        " characters; is a quote missing?");
        if (*s.pos == '"') break;
        if (*s.pos == '\\' && s.pos + 1 < s.end && s.pos[1] != '\n')
            token->text += Unescape(*++s.pos, token->loc);
        else
            token->text += *s.pos;
    }
    ++s.pos;
}

bool PbrtLexer::NextIsText() {
    if (hasPeeked) return peeked.kind == TokenKind::String;
    Source& s = sources.back();
    const char* const pos = s.pos;
    const int line = s.line;
    bool more = SkipSpace();
    if (more && *s.pos == '[') {
        ++s.pos;
        more = SkipSpace();
    }
    const bool isText = more && *s.pos == '"';
    s.pos = pos;
    s.line = line;
    return isText;
}

bool PbrtLexer::AtNumber() {
    if (hasPeeked || !SkipSpace()) return false;
    const char c = *sources.back().pos;
    return (c >= '0' && c <= '9') || c == '-' || c == '.' || c == '+';
}

template <typename T>
T PbrtLexer::ParseNumber() {
    Source& s = sources.back();
    // As old programs of Microsoft's print numbers that are not finite; # would begin a comment.
    const std::string_view word = WordAt(s.pos), rest(word.end(), s.end);
    for (const char* sign : {"#INF", "#IND", "#QNAN", "#SNAN"})
        if (word.ends_with('.') && rest.starts_with(sign))
            throw Error(Loc(), "'{}{}' is not a finite number", Printable(word), sign);
    // Accept a plus sign, which from_chars does not.
    const char* begin = *s.pos == '+' && s.pos + 1 < s.end && s.pos[1] != '-' ? s.pos + 1 : s.pos;
    T value = 0;
    auto [end, status] = std::from_chars(begin, s.end, value);
    if (status == std::errc::invalid_argument || (end < s.end && !IsDelimiter(*end)))
        throw Error(Loc(), "'" + Printable(WordAt(s.pos)) + "' is not a number");
    if (status == std::errc::result_out_of_range) {
        // Below the range is zero or nearly so; above it is an error.
        const double wide = std::strtod(std::string(begin, end).c_str(), nullptr);
        value = std::abs(wide) < 1 ? T(wide) : std::numeric_limits<T>::infinity();
    }
    if (!std::isfinite(value))
        throw Error(Loc(), "'" + Printable(WordAt(s.pos)) +
                               "' is not a number that can be used: it must be finite and within "
                               "the range of its type");
    s.pos = end;
    return value;
}

bool PbrtLexer::TakeNumber(float* value) {
    if (!AtNumber()) return false;
    *value = ParseNumber<float>();
    return true;
}

bool PbrtLexer::TakeNumber(double* value) {
    if (!AtNumber()) return false;
    *value = ParseNumber<double>();
    return true;
}

bool PbrtLexer::TakeNumber(int* value, bool* cut) {
    if (!AtNumber()) return false;
    Source& s = sources.back();
    const auto [end, status] = std::from_chars(s.pos, s.end, *value);
    if (status == std::errc() && (end == s.end || IsDelimiter(*end))) {
        s.pos = end;
        return true;
    }
    const char* const begin = s.pos;
    const double wide = ParseNumber<double>();
    if (std::abs(wide) > double(std::numeric_limits<int>::max()))
        throw Error(Loc(), "'" + Printable(WordAt(begin)) + "' is beyond the range of an integer");
    // Whole numbers may have become fractions by rounding.
    const double whole = std::round(wide);
    const bool isWhole = std::abs(wide - whole) <= 1e-6 * std::max(1., std::abs(wide));
    *value = int(isWhole ? whole : wide);
    *cut |= !isWhole;
    return true;
}

}  // namespace lull
