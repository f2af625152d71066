// Divides the lights of a scene into groups, whose light is told apart in the image.
#pragma once

#include <string>
#include <vector>

#include "renderer/input/description.h"
#include "renderer/scene/scene.h"

namespace lull {

struct Scene;

inline constexpr int kMostLightGroups = 16;  // besides the rest

struct LightGroups {
    std::vector<std::string> names;  // empty: light is not told apart
    // The group of each light of the scene, and of media that emit behind them; < names.size().
    std::vector<uint8_t> ofLight;

    int Count() const { return int(names.size()); }
};

// Makes the groups named. A light belongs to the group of the first of its names that is wanted:
//   - its "lightgroup";
//   - its own name (glTF: the node), of area lights that of the object, or its file;
//   - of area lights, the named material;
//   - its kind: "environment", "area" or "delta" (point, spot, distant and the like).
// {"each"} stands for the first name of each light. Lights of no group are in a last one, "rest",
// which is left out where there are none. Throws Error for names that no light has, with those that
// there are, and for more than kMostLightGroups.
LightGroups MakeLightGroups(const std::vector<std::string>& wanted, const Description&,
                            const Scene&);

// Names the groups, with commas between them.
std::string NameOf(const LightGroups&);
// Returns the same with a checksum of the lights in them, for checkpoints.
std::string TextOf(const LightGroups&);

// Return the name of an object or a material by its number (FirstHit), not 0: as the scene has it,
// else kind, file and line. Others, as of a checkpoint that somebody has changed, give "".
std::string NameOfObject(uint32_t number, const Description&, const Scene&);
std::string NameOfMaterial(uint32_t number, const Description&);

// Returns the name that the scene gives a shape: its own, else that of its file; can be empty.
std::string GivenName(const ShapeEntity&);

}  // namespace lull
