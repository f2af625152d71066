#include "stopping/base/block_view.h"

#include <cstddef>
#include <stdexcept>

namespace lull {

void CheckView(const BlockView& view, ViewNeed need) {
    if (view.width < 1 || view.height < 1 || view.spp < 1)
        throw std::invalid_argument("a block needs pixels and samples");
    const size_t values = 3 * size_t(view.width) * size_t(view.height);
    if ((need != ViewNeed::Nothing && view.mean.size() != values) ||
        (need >= ViewNeed::MeanAndHalf && view.halfMean.size() != values))
        throw std::invalid_argument("the means of a block do not have its size");
}

}  // namespace lull
