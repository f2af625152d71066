#pragma once

#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "renderer/base/sampling.h"
#include "renderer/image/image.h"
#include "renderer/scene/lights/light_sample.h"
#include "renderer/scene/textures/imagemap.h"

namespace lull {

// Radiance from all directions as an image, sampled by its brightness.

// How the unit square of an image shows all directions.
enum class MapProjection { LatitudeLongitude, EqualArea };

// Interpolates bilinearly; columns repeat, rows end at the poles. The density is constant
// over cells of half a texel a side, in proportion to the brightness at their centres. Of equal
// areas, texels are not interpolated and are the cells, as in pbrt-v4.
class EnvironmentMap {
  public:
    // Sums of a few such texels are still finite.
    static constexpr float kMaxTexel = 1e37f;

    // Multiplies the texels by `scale`. The products must be from 0 to kMaxTexel. Rows run from
    // theta = 0; the density follows the solid angle of a row. Not compensated, it is pbrt-v3's
    // (3rd ed., 14.2.4), whose rows repeat over the poles. A compensated map leaves texels darker
    // than the mean to BSDF sampling, which suffices there (Karlik et al. 2019), and samples nearly
    // constant maps uniformly.
    EnvironmentMap(Image image, const Rgb& scale, bool isCompensated = false,
                   MapProjection projection = MapProjection::LatitudeLongitude);

    MapProjection Projection() const { return projection; }

    // Returns the radiance at a point of the unit square.
    Rgb Radiance(const Vec2f& st) const;
    // Starts to load the texels there: every access to a large map waits for memory.
    void Prefetch(const Vec2f& st) const;
    // Returns a point of the unit square, and the density there, which is 0 if the map is black.
    Vec2f Sample(const Vec2f& u, float* pdf) const { return cells.Sample(u, pdf); }
    // Returns the density over the unit square.
    float Pdf(const Vec2f& st) const { return cells.Pdf(st); }
    Rgb MeanTexel() const;

  private:
    // Writes the brightness of a row of cells.
    void Brightness(int row, std::span<float> cells) const;

    Image image;
    Wrap wrapRows;
    Rgb scale;
    MapProjection projection;
    BlockDistribution cells;
};

// A rectangle that the light of a sky comes through, sampled evenly by area.
struct Portal {
    Vec3f corner, x, y;  // world; the edges are square to each other
    Vec3f n;             // unit, along which rays leave the scene
    float area;

    // Reads four corners. Throws Error at `loc` unless they are those of a rectangle.
    static Portal Make(std::span<const float> corners, const FileLoc& loc);

    // Returns a unit direction that leaves through it, and the density, 1/sr; nothing from behind.
    std::optional<std::pair<Vec3f, float>> Sample(const Vec3f& from, const Vec2f& u) const;
    // Returns the density with which Sample finds w: 0 where w does not leave through it.
    float Pdf(const Vec3f& from, const Vec3f& w) const;
};

// The light of a photographer's studio, for scenes that have none of their own.

// Returns a latitude-longitude map: a grey backdrop, brighter above, and three soft boxes. Its +z
// is up, its +x where the camera is, its +y to the right of the camera. A white matte surface that
// faces up or to the camera reflects about 1.
Image MakeStudio();

// Surrounds the scene with radiance: constant, or an image whose brightness guides the sampling
// (pbrt 3rd ed., 14.2.4). It is in latitude-longitude form, or, if "equalarea" allows for that and
// it is square, of equal areas. "illuminance" is twice that of the upper half, as in pbrt-v4.
class InfiniteLight {
  public:
    static constexpr LightType kType = LightType::Infinite;

    // Reads the image, if any. Throws Error if it cannot be read; texels that are not finite, and
    // negative parts of others, count as black, with a counted warning.
    static InfiniteLight Make(const LightReader&);

    std::optional<LightSample> Sample(const Vec3f& from, const Vec2f& u) const;
    Emitted LeAndPdf(const Vec3f& from, const Vec3f& w) const;
    // Returns the radiance of a sample that is on the map.
    Rgb Radiance(const LightSample& sample) const { return map->Radiance(sample.p.head<2>()); }

    Rgb Power() const;

  private:
    MapProjection Projection() const {
        return map ? map->Projection() : MapProjection::LatitudeLongitude;
    }
    // Returns the solid angle in light space over that in the world, about the direction `w` of the
    // world: 1 unless the transform scales unevenly.
    float Stretch(const Vec3f& w) const;

    Mat3f lightFromWorld = Mat3f::Identity(), worldFromLight = Mat3f::Identity();
    float worldRadius = 1;
    float stretch = 0;           // |determinant| of lightFromWorld; 0: the transform scales evenly
    Rgb constant = Rgb::Ones();  // where there is no map
    std::shared_ptr<const EnvironmentMap> map;  // null: none
    std::optional<Portal> portal;
};

// Emits L, W/(m^2 sr) times the solid angle it stands for, from one direction.
struct DistantLight {
    static constexpr LightType kType = LightType::DeltaDirection;

    Vec3f w;  // towards the light, unit
    Rgb L;
    float worldRadius = 1;

    static DistantLight Make(const LightReader&);
    std::optional<LightSample> Sample(const Vec3f& from, const Vec2f& u) const;
    Rgb Power() const { return kPi * Sqr(worldRadius) * L; }
};

// A distant light of some size: a disc that emits evenly, and gives a surface that faces it the
// irradiance of the parallel light, L. Rays that leave the scene see it.
struct SunLight {
    static constexpr LightType kType = LightType::Infinite;

    Vec3f w;       // towards its centre, unit
    Rgb L;         // radiance
    float height;  // 1 - cos of the disc's radius
    float solidAngle;
    Rgb power;

    // Takes the angle across the disc, radians, in (0, pi].
    SunLight(const DistantLight& parallel, double angle);

    std::optional<LightSample> Sample(const Vec3f& from, const Vec2f& u) const;
    Emitted LeAndPdf(const Vec3f&, const Vec3f& direction) const {
        // Of nearly parallel vectors, the product is less precise than the difference.
        if ((direction - w).squaredNorm() > 2 * height) return {Rgb::Zero(), 0};
        return {L, 1 / solidAngle};
    }
    Rgb Power() const { return power; }
};

}  // namespace lull
