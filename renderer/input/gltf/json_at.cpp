#include "renderer/input/gltf/json_at.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "renderer/files/file_io.h"

namespace lull {

std::string NumberedNames(const std::vector<std::string>& names) {
    std::string list;
    for (size_t i = 0; i < names.size(); ++i)
        list += fmt::format("{}{} \"{}\"", i == 0 ? "" : ", ", i, Printable(names[i]));
    return list.empty() ? "none" : list;
}

size_t ChooseByName(const GltfDocument& document, const std::string& what,
                    const std::vector<std::string>& names, const std::string& wanted) {
    const auto named = std::find(names.begin(), names.end(), wanted);
    if (named != names.end()) return size_t(named - names.begin());
    size_t number = 0;
    const char* end = wanted.data() + wanted.size();
    const auto [at, error] = std::from_chars(wanted.data(), end, number);
    if (error == std::errc() && at == end && number < names.size()) return number;
    throw Error(fmt::format("{}: has no {} \"{}\"; it has {}", document.file, what, wanted,
                            NumberedNames(names)));
}

}  // namespace lull
