#include "renderer/lab/comparison/verification.h"

namespace lull {

Verification VerificationOf(const RenderResult& result, const Film& film,
                            const ComparedImage& taken) {
    Verification v{.threads = result.threads, .wallSeconds = result.progress.seconds};
    for (const BlockResult& block : result.blocks) {
        v.seconds += block.seconds;
        v.ruleSeconds += block.criterionSeconds;
    }
    v.samePixels = film.MeanImage() == taken.image.values;
    return v;
}

}  // namespace lull
