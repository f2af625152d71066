// Feeds bytes to each reader of files from elsewhere. A reader may take them or refuse them with
// the exception it documents; all else is a finding. The fuzzers and an ordinary test, which
// replays what they have found, share these.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace lull {

using FuzzTarget = void (*)(std::span<const char> bytes);

struct NamedFuzzTarget {
    std::string name;  // of its folders in corpus/ and regressions/
    FuzzTarget run;
};

// Most of what `model`, `dataset` and `checkpoint` find is in the HDF5 library, which does not
// withstand files made to harm it.
std::vector<NamedFuzzTarget> FuzzTargets();

}  // namespace lull
