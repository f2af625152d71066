// Grades pictures: converts linear colours to those that a display shows.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "renderer/formats/view_transform.h"
#include "renderer/image/tone_map.h"

namespace lull {

struct Grade {
    ToneMap toneMap = ToneMap::None;
    // Encodes the colours instead of sRGB and the tone map; null: none.
    std::shared_ptr<const ViewTransform> view = {};
    float exposure = 0;  // stops by which the colours are brightened before

    // Returns whether nothing is changed.
    bool IsPlain() const { return toneMap == ToneMap::None && !view && exposure == 0; }
};

// Returns "filmic (Hable 2010)", "OpenColorIO DISPLAY/VIEW", "+2 stops", or two of them; empty for
// a plain one.
std::string TextOf(const Grade&);

// Brightens linear R, G, B of each pixel and maps them by the view or the tone map. Returns whether
// they are encoded now, as a view does.
bool MapColors(const Grade&, std::span<float> rgb);

// Replaces linear R, G, B of each pixel by those that an sRGB display shows in the graded picture:
// finite, at least 0, above 1 only without tone map and view, and not rounded.
void ApplyGrade(const Grade&, std::span<float> rgb);

}  // namespace lull
