// Accumulates the vertices of paths, for the next guide.
#pragma once

#include "renderer/guiding/guide.h"

namespace lull {

// One vertex of a path: its sampled direction and the light that arrived from there.
struct GuideVertex {
    Vec3f p, w;                    // where, and the unit direction in which it went on
    uint32_t leaf;                 // Guide::Find(p)
    float pdf, bsdfPdf, guidePdf;  // of w, 1/sr: as it was sampled, and of the two parts
    // Luminance that the rest of the path brought to the image, light sampled at the vertex itself
    // left out, relative to the mean contribution of a path. Any value; not positive (or NaN)
    // counts as 0.
    float found;
};

// Sums for a guide with the same trees. They are integers, which come to the same in any
// order, so that any number of threads may add at the same time.
class GuideRecord {
  public:
    // Statistics from which GuideLeaf::fraction is chosen.
    static constexpr std::array<float, 6> kFractions = {0, 0.15f, 0.3f, 0.5f, 0.7f, 0.85f};

    struct LeafSums {
        uint64_t vertices = 0;
        // How badly each fraction would have done: cross entropy of light and sampling.
        std::array<uint64_t, kFractions.size()> cost = {};
    };

    GuideRecord() = default;
    explicit GuideRecord(const Guide& guide)
        : sums(4 * guide.quads.size()), leaves(guide.leaves.size()) {}

    void Add(const Guide&, const GuideVertex&);

    size_t Bytes() const {
        return sums.size() * sizeof(uint64_t) + leaves.size() * sizeof(LeafSums);
    }

    std::vector<uint64_t> sums;  // light of each quadrant without children, at Guide::Quadrant()
    std::vector<LeafSums> leaves;
};

}  // namespace lull
