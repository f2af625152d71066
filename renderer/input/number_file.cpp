#include "renderer/input/number_file.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "renderer/files/file_contents.h"

namespace lull {
namespace {

bool IsSeparator(char c) { return std::isspace(static_cast<unsigned char>(c)) || c == ','; }

}  // namespace

std::vector<float> ReadNumberFile(const std::string& path, const std::string& kind,
                                  const FileLoc& loc) {
    const FileContents contents = ReadFile(path, loc);
    FileLoc place{std::make_shared<const std::string>(path), 1};
    std::vector<float> numbers;
    const char* pos = contents.View().data();
    const char* const end = pos + contents.size;
    while (pos < end) {
        if (*pos == '#') {
            pos = std::find(pos, end, '\n');
        } else if (IsSeparator(*pos)) {
            if (*pos++ == '\n') ++place.line;
        } else {
            const char* const stop =
                std::find_if(pos, end, [](char c) { return IsSeparator(c) || c == '#'; });
            const char* const begin = *pos == '+' ? pos + 1 : pos;
            float value = 0;
            const auto [parsed, status] = std::from_chars(begin, stop, value);
            if (status != std::errc() || parsed != stop || !std::isfinite(value))
                throw Error(place, "'" + Printable({pos, size_t(stop - pos)}) + "' in a " + kind +
                                       " file is not a number");
            numbers.push_back(value);
            pos = stop;
        }
    }
    return numbers;
}

}  // namespace lull
