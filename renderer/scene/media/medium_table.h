// Owns the participating media of a scene, and which lies on either side of each shape.
#pragma once

#include <algorithm>
#include <array>
#include <iterator>
#include <variant>
#include <vector>

#include "renderer/base/variant.h"
#include "renderer/input/description.h"
#include "renderer/scene/media/medium.h"

namespace lull {

using Medium = std::variant<HomogeneousMedium, GridMedium>;

constexpr int kVacuum = -1;

// The media that a point lies in, of which the one entered last counts.
class MediumStack {
  public:
    MediumStack() = default;
    explicit MediumStack(int medium) : media{medium}, count(1) {}

    int Top() const { return count > 0 ? media[size_t(count - 1)] : kVacuum; }
    int Count() const { return count; }
    int At(int i) const { return media[size_t(i)]; }
    // Returns how often a medium has been entered, from entry `first` on.
    int CountOf(int medium, int first = 0) const {
        return int(std::count(media.begin() + first, media.begin() + count, medium));
    }
    // Forgets the outermost where there are too many.
    void Enter(int medium) {
        if (count == kMost) std::shift_left(media.begin(), media.end(), 1), --count;
        media[size_t(count++)] = medium;
    }
    void Leave(int medium) {
        const auto end = media.begin() + count;
        const auto found = std::find(std::reverse_iterator(end), media.rend(), medium);
        if (found == media.rend()) return;
        std::copy(found.base(), end, found.base() - 1);
        --count;
    }

  private:
    static constexpr int kMost = 7;
    std::array<int, kMost> media{};
    int count = 0;
};

struct MediumTable {
    // The media on both sides of a shape; if they are the same, the ray stays in its own (pbrt-v3).
    struct Sides {
        int inside = kVacuum, outside = kVacuum;
    };

    std::vector<Medium> media;
    std::vector<Sides> ofShapes;  // by the shapes of the scene; empty where there are no media
    MediumStack ofCamera;
    bool hasVolumes = false;  // several surfaces around which other media stay

    MediumTable() = default;
    // Throws Error with file and line for unknown kinds, grids whose counts do not agree, negative
    // or infinite coefficients, and grids so dense that rays could not be traced through them.
    MediumTable(const Description&, Warnings&);

    // Returns the media of a ray that leaves the shape on the side of its normal or on the other;
    // `current` are those of the ray that hit it, which came from the other side if it `crosses`.
    MediumStack Beyond(int shape, bool onNormalSide, bool crosses, MediumStack current) const {
        if (ofShapes.empty()) return current;
        const Sides& sides = ofShapes[shape];
        if (sides.inside == sides.outside) return current;
        if (sides.outside != ShapeEntity::kSurrounding)
            return MediumStack(onNormalSide ? sides.outside : sides.inside);
        if (crosses && onNormalSide)
            current.Leave(sides.inside);
        else if (crosses)
            current.Enter(sides.inside);
        return current;
    }

    bool Emit() const;

    // Returns in which channels nothing gets through the medium if it is infinite.
    Eigen::Array<bool, 3, 1> Swallows(int medium) const {
        const auto* m =
            medium == kVacuum ? nullptr : std::get_if<HomogeneousMedium>(&media[medium]);
        if (!m) return {false, false, false};
        return m->sigmaT > 0;
    }

    float PhaseParameter(int medium) const {
        return Visit(media[medium], [](const auto& m) { return m.g; });
    }

    // Samples the point before its tMax where the ray scatters.
    MediumSample Sample(int medium, const Ray& ray, Sampler& sampler) const;
    // Estimates the transmittance along the ray up to its tMax.
    Rgb Transmittance(int medium, const Ray& ray, Sampler& sampler) const;
};

}  // namespace lull
