#include "stopping/rules/small_blocks.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>

namespace lull {

std::vector<int> BlockLeaders(int columns, std::span<const BlockSize> sizes, int smallestSide) {
    const int count = int(sizes.size());
    if (columns <= 0 || count % columns != 0)
        throw std::invalid_argument("block sizes do not fill whole rows of the grid");

    auto isSmall = [&](int i) { return std::min(sizes[i].width, sizes[i].height) < smallestSide; };
    auto largestNeighbour = [&](int i) {
        const int x = i % columns, y = i / columns, rows = count / columns;
        int best = -1;
        int64_t bestArea = 0;
        for (int v = std::max(0, y - 1); v <= std::min(rows - 1, y + 1); ++v)
            for (int u = std::max(0, x - 1); u <= std::min(columns - 1, x + 1); ++u) {
                const int j = v * columns + u;
                const int64_t area = int64_t(sizes[j].width) * sizes[j].height;
                if (j == i || area <= bestArea) continue;
                best = j;
                bestArea = area;
            }
        return best;
    };

    std::vector<int> leaders(sizes.size());
    for (int i = 0; i < count; ++i) {
        leaders[i] = isSmall(i) ? largestNeighbour(i) : i;
        if (leaders[i] >= 0 && isSmall(leaders[i])) leaders[i] = -1;
    }
    return leaders;
}

std::vector<int> FollowLeaders(std::span<const int> thresholds, std::span<const int> leaders,
                               int cap) {
    if (thresholds.size() != leaders.size())
        throw std::invalid_argument("as many thresholds as leaders are needed");
    std::vector<int> result(thresholds.size());
    for (size_t i = 0; i < result.size(); ++i)
        result[i] = leaders[i] < 0 ? cap : thresholds[size_t(leaders[i])];
    return result;
}

}  // namespace lull
