// Feeds bytes to each reader of files from elsewhere. A reader may take them or refuse them with
// the exception it documents; all else is a finding. The fuzzers share these with an ordinary test,
// which replays their findings.
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

// Most findings of `model`, `dataset` and `checkpoint` are in the HDF5 library, which does not
// withstand files made to harm it.
std::vector<NamedFuzzTarget> FuzzTargets();

}  // namespace lull
