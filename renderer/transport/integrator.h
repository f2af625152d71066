// Takes samples of the image by the scene's integrator.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "renderer/base/math.h"
#include "renderer/scene/light_groups.h"
#include "renderer/scene/scene.h"

namespace lull {

// The first hit of a path, for AOVs.

// Describes a surface, or a point in a medium, which has no normal, object or material.
struct FirstHit {
    Rgb albedo = Rgb::Zero();        // in [0, 1]; where light is seen instead, that
    Vec3f normal = Vec3f::Zero();    // shading, unit, world, on the viewer's side
    Vec3f position = Vec3f::Zero();  // world
    float depth = 0;        // from the camera's plane along its axis; environment cameras: distance
    uint32_t object = 0;    // 1 + number of the shape, then of the instances; 0: none
    uint32_t material = 0;  // 1 + number of the material; 0: none
    bool found = false;     // there was one
    // Of the sample's radiance, that of a surface met unscattered: in PathSample::features.
    Rgb emission = Rgb::Zero();
    // Of the sample: its filter weight, and the squared distance from the pixel's centre.
    float weight = 1, offset2 = 0;
};

// The radiance of a sample, told apart by groups of lights.

class GroupRadiance {
  public:
    // The groups must outlive it.
    explicit GroupRadiance(const LightGroups& groups)
        : ofLight(groups.ofLight), count(size_t(groups.Count())) {}

    // Clear() and Scale() are not inlined: samples without groups would have to pass by them.
    void Clear();
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

// PbrtV3 takes pbrt-v3's strategies as they are: at each vertex one light is chosen and sampled
// both by the light and by a BSDF ray of its own. Combined has the same mean from fewer rays: the
// ray that continues the path is the BSDF sample of the direct light as well, weighed against
// the choice of *any* light.
enum class Estimator { Combined, PbrtV3 };
template <>
struct EnumNames<Estimator> {
    static constexpr std::pair<Estimator, const char*> all[] = {{Estimator::Combined, "combined"},
                                                                {Estimator::PbrtV3, "pbrt-v3"}};
};

// How many samples the strategies of bidirectional path tracing take for one of a pixel.
struct BdptShares {
    float lightPaths = 0;   // that are seen from the camera, in [0, 1]
    float connections = 1;  // subpaths from lights to connect to, in (0, 1]
};

struct PathOptions {
    PathOptions(Estimator estimator) : estimator(estimator) {}

    Estimator estimator = Estimator::Combined;
    bool throughSpecular = false;  // PathSample::hit is seen as `features` are
    BdptShares shares = {};        // of scenes with a BdptIntegrator
};

// A sample of a pixel, to be taken again and again. The first members say what is asked for in
// addition to the radiance, which that does not change.
struct PathSample {
    bool asksForHit = false, asksForFeatures = false;
    GroupRadiance* groups = nullptr;  // the radiance by groups of lights; null: not asked for

    uint32_t index = 0;
    Rgb radiance =
        Rgb::Zero();        // with filter weight and film scale: the pixel is the mean of these
    bool rejected = false;  // was NaN, infinite or of negative luminance, and counts as black
    // The share of the luminance that comes from connections to subpaths from lights.
    float connected = 0;
    // The first hit of the path, for AOVs, and the first that is seen in mirrors and through glass,
    // for the denoiser: its albedo is the object's times their reflectance or transmittance, and
    // its depth the length of the path, as if through windows. A path that is at its greatest
    // depth, or ends before it finds something, has none.
    FirstHit hit = {}, features = {};

    bool AsksForHits() const { return asksForHit || asksForFeatures; }
};

// Takes sample `index` of `pixel` (full-image coordinates). The result depends on (seed, pixel,
// index) alone, whatever the thread or the order.
void RenderSample(const Scene&, const PathOptions&, Sampler&, const Vec2i& pixel, uint32_t index,
                  PathSample*);
inline PathSample RenderSample(const Scene& scene, const PathOptions& options, Sampler& sampler,
                               const Vec2i& pixel, uint32_t index) {
    PathSample sample;
    RenderSample(scene, options, sampler, pixel, index, &sample);
    return sample;
}

// Records the vertices of one path, to find the source of a bright pixel.

// The end of one ray of a path.
struct PathStep {
    enum class Kind { Surface, Medium, Sky };

    Kind kind = Kind::Surface;
    float distance = 0;                 // from the step before, or from the camera
    Vec3f position = Vec3f::Zero();     // world; for the sky, the ray's direction
    Vec3f normal = Vec3f::Zero();       // surfaces: geometric, unit
    uint32_t object = 0, material = 0;  // numbers as in FirstHit
    Rgb throughput = Rgb::Ones();       // of the path that arrives here
    Rgb emitted = Rgb::Zero();          // radiance emitted here, weighted by throughput
    Rgb direct = Rgb::Zero();           // of light that arrives here directly, counted
    bool goesOn = false;                // the path was scattered; then:
    Vec3f direction = Vec3f::Zero();    // unit, world
    float pdf = 0;                      // of the direction, 1/sr; of a specular lobe, no density
    bool isSpecular = false, isTransmission = false;
};

struct PathLog {
    Ray ray;                 // the camera's
    float filterWeight = 1;  // these factors are in the sample's radiance, but not in the steps
    float cameraWeight = 1;
    float filmScale = 1;
    std::vector<PathStep> steps;
    PathSample sample;
};

// Takes the same sample as RenderSample(), by a PathIntegrator, and records its path.
PathLog LogSample(const Scene&, Estimator, Sampler&, const Vec2i& pixel, uint32_t index);

}  // namespace lull
