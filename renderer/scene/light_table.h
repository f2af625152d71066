// Owns the lights of a scene: their emission, sampling and selection.
#pragma once

#include "renderer/base/color.h"
#include "renderer/bsdf/bsdf.h"
#include "renderer/scene/light.h"
#include "renderer/scene/light_distribution.h"

namespace lull {

struct ShapeTable;

class LightTable {
  public:
    LightTable() = default;
    // Makes the lights of the description and one for each primitive of an emitting shape, whose
    // Shape::firstLight it sets; `shapes` and `textures` must outlive the table and stay where they
    // are. Lights are chosen as the integrator's "lightsamplestrategy" says: "uniform", "power",
    // "spatial" (by tables, or by a hierarchy where there are many lights, unless `asPbrtV3`) or,
    // which pbrt-v3 does not know, "bvh" (by a hierarchy). Throws Error with file and line for
    // unknown kinds.
    LightTable(const Description&, ShapeTable& shapes, const TextureTable& textures, bool asPbrtV3,
               Warnings&);

    int Count() const { return int(lights.size()); }
    const Light& operator[](int i) const { return lights[i]; }
    // Lists the lights of Description::lights that the table has, by their indices there: its first
    // lights, in this order. Those of shapes follow.
    const std::vector<int>& Entities() const { return entities; }
    // Lists the lights that rays reach when they leave the scene.
    const std::vector<int>& Infinite() const { return infinite; }

    // Returns the first light with an environment map that has tiles (InfiniteLight::Tiles()); -1:
    // there is none.
    int Environment() const { return environment; }

    // Returns whether lights are chosen by a hierarchy.
    bool HasHierarchy() const { return hierarchy != nullptr; }

    // Returns whether lights are chosen by tables of places: by neither a hierarchy nor fixed
    // weights.
    bool IsChosenByPlace() const { return distribution && distribution->Grid().Count() > 1; }

    // Returns whether a ray can hit any light at all.
    bool AnyVisible() const { return anyVisible; }

    // Samples light i as seen from `from`. Returns nothing if it gives no light there.
    std::optional<LightSample> Sample(int i, const Vec3f& from, const Vec2f& u) const;

    // Returns the radiance of a sample of light i.
    Rgb Radiance(int i, const LightSample& sample) const {
        if (!sample.isOnMap) return sample.L;
        return std::get_if<InfiniteLight>(&lights[i])->Radiance(sample);
    }

    // Returns how lights are chosen at a hit, as the scene's strategy says.
    LightChoice Choice(const SurfaceInteraction& hit, const Bsdf& bsdf) const {
        if (hierarchy) [[unlikely]]
            return {*hierarchy, {hit.p, FaceForward(hit.n, hit.wo), bsdf.Transmits()}};
        return Choice(hit.p);
    }
    // The same for a point whose surface, if any, does not matter.
    LightChoice Choice(const Vec3f& p) const {
        if (hierarchy) [[unlikely]]
            return {*hierarchy, {p, Vec3f::Zero(), true}};
        return distribution->Lookup(p, [&](int i, const Vec3f& q, const Vec2f& u) {
            const auto sample = Sample(i, q, u);
            return sample ? Luminance(Radiance(i, *sample)) / sample->pdf : 0.f;
        });
    }

    // Prefetches the data of Choice(p), so that the wait overlaps with other work.
    void Prefetch(const Vec3f& p) const {
        if (distribution) distribution->Prefetch(p);
    }

  private:
    std::vector<Light> lights;
    std::vector<int> entities;
    std::vector<std::unique_ptr<const EmissionMap>> emissionMaps;
    std::vector<int> infinite;
    int environment = -1;
    bool anyVisible = false;
    std::unique_ptr<LightDistribution> distribution;
    std::unique_ptr<LightHierarchy> hierarchy;  // instead of `distribution`
};

}  // namespace lull
