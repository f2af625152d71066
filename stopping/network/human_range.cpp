#include "stopping/network/human_range.h"

#include <algorithm>
#include <cmath>

namespace lull {

HumanRange RangeOfPeople(int stop, bool stoppedByRule, std::span<const double> logRatios) {
    const auto at = [&](int tenths) {
        return std::min(stop * std::exp(logRatios[size_t(tenths)]), double(kMostShownSpp));
    };
    HumanRange range{.low = std::max(1, int(std::lround(at(1))))};
    const int high = int(std::lround(at(9)));
    if (stoppedByRule && high < kMostShownSpp) range.high = std::max(high, range.low);
    return range;
}

}  // namespace lull
