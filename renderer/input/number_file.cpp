#include "renderer/input/number_file.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string_view>

#include "renderer/files/file_contents.h"
#include "renderer/files/text_file.h"

namespace lull {
namespace {

bool IsSeparator(char c) { return std::isspace(static_cast<unsigned char>(c)) || c == ','; }

// What stands between the numbers of a line.
struct Separators {
    bool haveCommas = false, haveBlanks = false;  // alone

    // Takes the separators behind a number. Throws Error where commas seem to be decimal ones.
    void Add(std::string_view between, const FileLoc& loc) {
        if (between.find_first_of("\r\n") != between.npos) {
            *this = {};
            return;
        }
        haveCommas |= between == ",";
        haveBlanks |= between.find(',') == between.npos;
        if (haveCommas && haveBlanks)
            throw Error(loc,
                        "numbers of a line are apart by commas and by blanks; write decimal points "
                        "instead of commas");
    }
};

}  // namespace

std::vector<float> ReadNumberFile(const std::string& path, const std::string& kind,
                                  const FileLoc& loc) {
    const FileContents contents = ReadFile(path, loc);
    FileLoc place{std::make_shared<const std::string>(path), 1};
    std::vector<float> numbers;
    const std::string_view text = CleanText(contents.View(), {place.file, 0});
    const char* pos = text.data();
    const char* const end = pos + text.size();
    Separators separators;
    while (pos < end) {
        if (*pos == '#') {
            pos = std::find_if(pos, end, [](char c) { return c == '\n' || c == '\r'; });
        } else if (IsSeparator(*pos)) {
            const char c = *pos++;
            if (c == '\n' || (c == '\r' && (pos == end || *pos != '\n'))) ++place.line;
        } else {
            const char* const stop =
                std::find_if(pos, end, [](char c) { return IsSeparator(c) || c == '#'; });
            const char* const begin = *pos == '+' ? pos + 1 : pos;
            double exact = 0;  // of which a float may be too small for more than 0
            const auto [parsed, status] = std::from_chars(begin, stop, exact);
            const auto value = float(exact);
            if (status != std::errc() || parsed != stop || !std::isfinite(value))
                throw Error(place, "'" + Printable({pos, size_t(stop - pos)}) + "' in a " + kind +
                                       " file is not a number");
            numbers.push_back(value);
            pos = stop;
            const char* const next = std::find_if_not(pos, end, IsSeparator);
            if (next < end && *next != '#')
                separators.Add({pos, size_t(next - pos)}, place);
            else
                separators = {};
        }
    }
    return numbers;
}

}  // namespace lull
