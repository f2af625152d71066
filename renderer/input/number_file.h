// Reads text files that are nothing but numbers, such as spectra and lenses.
#pragma once

#include <vector>

#include "renderer/base/error.h"

namespace lull {

// Reads numbers that spaces or commas separate, up to '#' in each line. Throws Error, with file and
// line, for anything else and for numbers that are not finite; `kind` names the file in messages
// ("spectrum"). `loc` is the place that names the file.
std::vector<float> ReadNumberFile(const std::string& path, const std::string& kind,
                                  const FileLoc& loc);

}  // namespace lull
