// Notices pictures of a block that lie too far apart for rules that compare them: these then look
// at none, and never stop the block.
#pragma once

#include <string>

#include "lull/lull.h"

namespace lull {

class PictureSpacing {
  public:
    // Returns the samples of the last three pictures, "64, 128 and 256", if the third has come when
    // it was asked for, could still not be checked, and each has 1.6 times the samples of the one
    // before or more; "" otherwise.
    std::string Note(const lull_answer& answer) {
        constexpr double kFar = 1.6;
        const bool isFar = before > 0 && last >= kFar * before && answer.spp >= kFar * last;
        const bool isMissed = !answer.stop && !answer.checked && answer.spp >= awaited;
        const std::string pictures = std::to_string(before) + ", " + std::to_string(last) +
                                     " and " + std::to_string(answer.spp);
        before = last;
        last = answer.spp;
        awaited = answer.next_spp;
        return isFar && isMissed ? pictures : "";
    }

  private:
    int before = 0, last = 0;  // spp
    int awaited = 0;
};

}  // namespace lull
