// Commands and options of earlier versions, each refused by name with what to use instead.
#pragma once

#include <array>
#include <string_view>

namespace lull {

struct Removed {
    // Empty: all commands; no option: the command itself.
    std::string_view command, option, instead;
};

inline constexpr std::array kRemoved = {
    Removed{"selftest", "--long", "tests/hard_cases has the nightly run: LULL_LONG=1"},
    Removed{"selftest", "--only", "the command has three checks"},
    Removed{"selftest", "--seed", "the command has three checks, with one seed"},
    Removed{"", "--filtering", "images are filtered bilinearly; take more samples against moire"},
};

}  // namespace lull
