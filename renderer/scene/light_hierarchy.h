// Chooses one of many lights for a point on a surface, in time that grows with the logarithm of
// their number.
#pragma once

#include <span>
#include <vector>

#include "renderer/scene/lights/light_bounds.h"

namespace lull {

// Holds what decides which lights reach a point, of a surface or a medium.
struct Receiver {
    Vec3f p = Vec3f::Zero();
    // Geometric, unit, on the side that is looked at; zero where light counts from anywhere.
    Vec3f n = Vec3f::UnitZ();
    bool isTwoSided = true;  // light from behind counts as well: the surface transmits
};

// Is a binary tree over lights (Conty Estevez and Kulla 2018), as pbrt-v4's BVH light sampler. At
// each node one of the children is chosen by what it could give at most, from its box, the cone of
// its normals and its power. A light that bounds exclude has probability 0: it gives nothing.
class LightHierarchy {
  public:
    // Takes the bounds of all lights; where power is 0, a light is never chosen by them. Lights of
    // `unbounded` (at infinity, ascending) each get a share as large as all others together. Takes
    // n log n time and 100 bytes a light.
    LightHierarchy(std::span<const LightBounds> lights, std::vector<int> unbounded);

    // Chooses a light with u in [0, 1); `pmf` receives its probability. Where no light reaches the
    // receiver that is 0, and the light no light.
    int Sample(const Receiver& receiver, float u, float* pmf) const;

    // Returns the probability with which Sample chooses `light`.
    float Pmf(const Receiver& receiver, int light) const;

    size_t Bytes() const {
        return nodes.size() * sizeof(Node) + leafOf.size() * sizeof(uint32_t) +
               unbounded.size() * sizeof(int);
    }

  private:
    // Holds cosines and the axis as multiples of 1 / kUnit, rounded so that the bounds hold.
    static constexpr float kUnit = 32767;
    static constexpr uint32_t kNone = ~0u, kUnbounded = ~1u;  // instead of a leaf

    // The children of a node stand beside each other, the first at an odd place.
    struct Node {
        Bounds3f box;
        float power;
        std::array<int16_t, 3> axis;
        int16_t cosNormals, cosEmission;
        bool isTwoSided, isLeaf;
        uint32_t next;    // the light of a leaf, the first child of others
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
