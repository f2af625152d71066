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
    Removed{"", "--filtering", "images are filtered bilinearly; take more samples against moire"},
    Removed{"", "--guide", "use --denoise, or --integrator bdpt for light through glass"},
    Removed{"", "--guide-memory", "use --denoise, or --integrator bdpt for light through glass"},
    Removed{"bench", "", "use lull compare --curves"},
    Removed{"evaluate", "--figure", "draw from the CSV file of --curves"},
    Removed{"selftest", "--long", "tests/hard_cases has the nightly run: LULL_LONG=1"},
    Removed{"selftest", "--only", "the command has three checks"},
    Removed{"selftest", "--seed", "the command has three checks, with one seed"},
    Removed{"study", "--answers", "there is one procedure, adjustment"},
    Removed{"study", "--descending", "blocks are asked from below; --repeats asks twice"},
    Removed{"study", "--list-texts", "edit the texts in the page"},
    Removed{"study", "--procedure", "there is one procedure, adjustment"},
    Removed{"study", "--questions", "ask observers yourself"},
    Removed{"study", "--text", "edit the texts in the page"},
    Removed{"train", "--bnorm", "use --snorm, as the paper"},
    Removed{"train", "--noisy-weight", "use lull render --caution"},
};

}  // namespace lull
