// The radiance of a sample, told apart by groups of lights.
#pragma once

#include <array>
#include <span>

#include "renderer/base/color.h"
#include "renderer/scene/light_groups.h"

namespace lull {

class GroupRadiance {
  public:
    // The groups must outlive it.
    explicit GroupRadiance(const LightGroups& groups)
        : ofLight(groups.ofLight), count(size_t(groups.Count())) {}

    // Clear() and Scale() are not inlined: samples without groups would have to pass by them.
    void Clear();
    // Adds the radiance of light `index` of the scene.
    void Add(int index, const Rgb& radiance) { radiances[ofLight[size_t(index)]] += radiance; }
    // Multiplies all by `factor`. What is not finite then is black.
    void Scale(float factor);
    // Of each group; they add up to the radiance of the sample.
    std::span<Rgb> All() { return {radiances.data(), count}; }
    std::span<const Rgb> All() const { return {radiances.data(), count}; }

  private:
    std::span<const uint8_t> ofLight;
    size_t count;
    std::array<Rgb, kMostLightGroups + 1> radiances;
};

}  // namespace lull
