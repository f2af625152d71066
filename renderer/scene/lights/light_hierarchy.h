// Chooses one of many lights for a point on a surface, in time that grows with the logarithm of
// their number.
#pragma once

#include <span>
#include <vector>

#include "renderer/scene/lights/light_sample.h"

namespace lull {

// Inputs of light selection at a point of a surface or a medium.
struct Receiver {
    Vec3f p = Vec3f::Zero();
    // Geometric, unit, on the visible side; zero if light from anywhere counts.
    Vec3f n = Vec3f::UnitZ();
    bool isTwoSided = true;  // light from behind counts as well: the surface transmits
};

// A binary tree over lights (Conty Estevez and Kulla 2018), as pbrt-v4's BVH light sampler. At
// each node one of the children is chosen by the most that it could contribute, given its box, the
// cone of its normals and its power. A light that the bounds exclude has probability 0: it
// contributes nothing.
class LightHierarchy {
  public:
    // Takes the bounds of all lights; one with power 0 is never chosen by its bounds. Each light of
    // `unbounded` (at infinity, ascending) gets a share as large as all others together. Takes n
    // log n time and 100 bytes a light.
    LightHierarchy(std::span<const LightBounds> lights, std::vector<int> unbounded);

    // Chooses a light with u in [0, 1); `pmf` receives its probability. If no light reaches the
    // receiver, that is 0 and the result is not a light.
    int Sample(const Receiver& receiver, float u, float* pmf) const;

    // Returns the probability with which Sample chooses `light`.
    float Pmf(const Receiver& receiver, int light) const;

    size_t Bytes() const {
        return nodes.size() * sizeof(Node) + leafOf.size() * sizeof(uint32_t) +
               unbounded.size() * sizeof(int);
    }

  private:
    // Cosines and the axis as multiples of 1 / kUnit, rounded so that the bounds hold.
    static constexpr float kUnit = 32767;
    static constexpr uint32_t kNone = ~0u, kUnbounded = ~1u;  // instead of a leaf

    // The children of a node are adjacent, the first at an odd index.
    struct Node {
        Bounds3f box;
        float power;
        std::array<int16_t, 3> axis;
        int16_t cosNormals, cosEmission;
        bool isTwoSided, isLeaf;
        uint32_t next;    // of a leaf its light, of others the first child
        uint32_t parent;  // the root's own is the root
    };
    static_assert(sizeof(Node) == 48);

    struct Builder;

    static float Importance(const Node&, const Receiver&);

    std::vector<Node> nodes;
    std::vector<uint32_t> leafOf;  // by light: its node, kNone or kUnbounded
    std::vector<int> unbounded;
};

}  // namespace lull
