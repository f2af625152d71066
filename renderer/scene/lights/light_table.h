// Owns the lights of a scene: their emission, sampling and selection.
#pragma once

#include "renderer/base/math.h"
#include "renderer/bsdf/bsdf.h"
#include "renderer/scene/lights/light.h"
#include "renderer/scene/lights/light_distribution.h"

namespace lull {

struct ShapeTable;

class LightTable {
  public:
    LightTable() = default;
    // Makes the lights of the description and one for each primitive of an emitting shape, whose
    // Shape::firstLight it sets; `shapes` and `textures` must outlive the table and stay where they
    // are. Lights are chosen as the integrator's "lightsamplestrategy" says: "uniform", "power",
    // "spatial" (by tables, or by a hierarchy where there are many lights, unless `asPbrtV3`) or,
    // which pbrt-v3 does not know, "bvh" (by a hierarchy). Throws Error for unknown kinds.
    LightTable(const Description&, ShapeTable& shapes, const TextureTable& textures, bool asPbrtV3,
               Warnings&);

    int Count() const { return int(lights.size()); }
    const Light& operator[](int i) const { return lights[i]; }
    // Lists the lights of Description::lights that the table has, by their indices there: its first
    // lights, in this order. Those of shapes follow.
    const std::vector<int>& Entities() const { return entities; }
    // Lists the lights that rays reach when they leave the scene.
    const std::vector<int>& Infinite() const { return infinite; }

    bool HasHierarchy() const { return hierarchy != nullptr; }

    bool AnyVisible() const { return anyVisible; }

    // Samples light i as seen from `from`. Returns nothing if it gives no light there.
    std::optional<LightSample> Sample(int i, const Vec3f& from, const Vec2f& u) const;

    // Returns the radiance of a sample of light i.
    Rgb Radiance(int i, const LightSample& sample) const {
        if (!sample.isOnMap) return sample.L;
        return std::get_if<InfiniteLight>(&lights[i])->Radiance(sample);
    }

    // Returns the place of p among those for which lights are chosen alike, and prefetches its
    // data, so that the wait overlaps with other work.
    size_t PlaceOf(const Vec3f& p) const {
        if (!distribution) return 0;
        const size_t voxel = distribution->Grid().VoxelOf(p);
        distribution->Prefetch(voxel);
        return voxel;
    }
    // Returns how lights are chosen at a hit, as the scene's strategy says. `place`: PlaceOf() of
    // it, or of a point as close as rounding.
    LightChoice Choice(const SurfaceInteraction& hit, const Bsdf& bsdf, size_t place) const {
        if (hierarchy) [[unlikely]]
            return {*hierarchy, {hit.p, FaceForward(hit.n, hit.wo), bsdf.Transmits()}};
        return ChoiceIn(place);
    }
    // The same for a point whose surface, if any, does not matter.
    LightChoice Choice(const Vec3f& p, size_t place) const {
        if (hierarchy) [[unlikely]]
            return {*hierarchy, {p, Vec3f::Zero(), true}};
        return ChoiceIn(place);
    }

  private:
    void AddLights(const Description&, const ShapeTable&, bool asPbrtV3, Warnings&);
    void AddAreaLights(const ShapeEntity&, const TextureTable&, bool asPbrtV3, Shape*, Warnings&);
    void ChooseByPlace(const Bounds3f& bounds);
    LightChoice ChoiceIn(size_t place) const {
        return distribution->Lookup(
            place, [&](int i, const LightProbes& probes, const LightProbes::Places& places) {
                const float even = evenContributions[i];
                return even >= 0 ? even : Contribution(lights[i], probes, places);
            });
    }

    std::vector<Light> lights;
    std::vector<float>
        evenContributions;  // by light: Contribution(), or -1 where it depends on the place
    std::vector<int> entities;
    std::vector<std::unique_ptr<const EmissionMap>> emissionMaps;
    std::vector<std::unique_ptr<const EmissionProfile>> profiles;
    std::vector<int> infinite;
    bool anyVisible = false;
    std::unique_ptr<LightDistribution> distribution;
    std::unique_ptr<LightHierarchy> hierarchy;  // instead of `distribution`
};

}  // namespace lull
