// Commands and options of earlier versions, each refused by name with what to use instead.
#pragma once

#include <array>
#include <string_view>

namespace lull {

struct Removed {
    std::string_view command, option, instead;  // no option: the command itself
};

inline constexpr std::array kRemoved = {
    Removed{"bench", "", "use lull compare --curves"},
    Removed{"evaluate", "--figure", "draw from the CSV file of --curves"},
    Removed{"train", "--bnorm", "use --snorm, as the paper"},
    Removed{"train", "--noisy-weight", "use lull render --caution"},
};

}  // namespace lull
