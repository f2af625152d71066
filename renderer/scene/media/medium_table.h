// Owns the participating media of a scene, and which lies on either side of each shape.
#pragma once

#include <variant>
#include <vector>

#include "renderer/base/variant.h"
#include "renderer/input/description.h"
#include "renderer/scene/media/medium.h"

namespace lull {

using Medium = std::variant<HomogeneousMedium, GridMedium>;

constexpr int kVacuum = -1;

struct MediumTable {
    // The media on both sides of a shape; if they are the same, the ray stays in its own medium
    // (pbrt-v3).
    struct Sides {
        int inside = kVacuum, outside = kVacuum;
    };

    std::vector<Medium> media;
    std::vector<Sides> ofShapes;  // by the shapes of the scene; empty where there are no media
    int ofCamera = kVacuum;

    MediumTable() = default;
    // Throws Error with file and line for unknown kinds, grids whose counts do not agree, negative
    // or infinite coefficients, extinction that differs between channels of a grid, and grids so
    // dense that rays could not be traced through them.
    MediumTable(const Description&, Warnings&);

    // Returns the medium of a ray that leaves the shape on the side of its normal or on the other;
    // `current` is the medium of the ray that hit it.
    int Beyond(int shape, bool onNormalSide, int current) const {
        if (ofShapes.empty()) return current;
        const Sides& sides = ofShapes[shape];
        if (sides.inside == sides.outside) return current;
        return onNormalSide ? sides.outside : sides.inside;
    }

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
