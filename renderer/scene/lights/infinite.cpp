#include "renderer/scene/lights/infinite.h"

#include <numbers>
#include <numeric>

#include "renderer/base/math.h"
#include "renderer/base/memory.h"
#include "renderer/base/sampling.h"
#include "renderer/base/variant.h"
#include "renderer/image/image_io.h"
#include "renderer/scene/lights/light_sample.h"

namespace lull {
namespace {

// Growth of the variance that blocks may add which a compensated map samples evenly.
constexpr float kTolerance = 0.02f;

// Dark cells keep this much of their brightness: directions that scatter light but are never
// sampled, which shading normals cause, need it.
constexpr float kLeast = 0.1f;

int NeighbourOf(int cell, int n, Wrap wrap) {
    const int beside = cell / 2 + (cell % 2 == 0 ? -1 : 1);
    return wrap == Wrap::Repeat ? (beside + n) % n : std::clamp(beside, 0, n - 1);
}

// A square soft box: degrees to the right of the camera and above the horizon, half its width.
struct SoftBox {
    float azimuth, elevation, halfWidth, radiance;
};
constexpr SoftBox kBoxes[] = {
    {-45, 45, 22, 4},    // the key light
    {60, 15, 25, 1.5f},  // fills its shadows
    {160, 55, 15, 3},    // draws the outline from behind
};

float SmoothStep(float x) {
    x = std::clamp(x, 0.f, 1.f);
    return x * x * (3 - 2 * x);
}

Vec3f Direction(float azimuth, float elevation) {
    return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
            std::sin(elevation)};
}

float RadianceOf(const SoftBox& box, const Vec3f& w) {
    constexpr float kDegree = kPi / 180, kEdge = 0.2f;  // of half the width
    const float a = box.azimuth * kDegree, e = box.elevation * kDegree;
    const Vec3f center = Direction(a, e), right(-std::sin(a), std::cos(a), 0);
    const float ahead = w.dot(center);
    if (ahead <= 0) return 0;
    const float scale = 1 / (ahead * std::tan(box.halfWidth * kDegree));
    const float x = std::abs(w.dot(right)) * scale,
                y = std::abs(w.dot(center.cross(right))) * scale;
    return box.radiance * SmoothStep((1 - std::max(x, y)) / kEdge);
}

Vec2f CoordinatesOf(const Vec3f& w) {
    const float phi = std::atan2(w.y(), w.x());
    return {(phi < 0 ? phi + 2 * kPi : phi) / (2 * kPi),
            std::acos(std::clamp(w.z(), -1.f, 1.f)) / kPi};
}

// Blackens texels that are not finite once multiplied by L, and parts of others that are negative,
// as compression and filters leave them. Returns how many texels that were, for more than rounding.
int Blacken(const Rgb& L, Image* image) {
    int count = 0;
    std::visit(
        [&](auto& texels) {
            using T = std::decay_t<decltype(texels[0])>;
            const int colors = image->channels < 3 ? 1 : 3;
            for (size_t at = 0; at < texels.size(); at += size_t(image->channels)) {
                bool isGood = true, isFinite = true;
                for (int c = 0; c < 3; ++c) {
                    T& texel = texels[at + size_t(c % colors)];
                    const float value = float(texel) * L[c];
                    isGood &= value >= -float(kRounding);
                    isFinite &= std::abs(value) <= EnvironmentMap::kMaxTexel;
                    if (value < 0) texel = T();
                }
                if (!isFinite) std::fill_n(&texels[at], colors, T());
                count += !(isGood && isFinite);
            }
        },
        image->texels);
    return count;
}

// Returns the unit direction of a point of the square, and its colatitude's sine; 1 of equal areas.
Vec3f DirectionOf(MapProjection projection, const Vec2f& st, float* sine) {
    *sine = 1;
    if (projection == MapProjection::EqualArea) return DirectionOfEqualAreaSquare(st);
    const auto [sinTheta, cosTheta] = SineCosineOfTurn(0.5f * st.y());
    const auto [sinPhi, cosPhi] = SineCosineOfTurn(st.x());
    *sine = sinTheta;
    return {sinTheta * cosPhi, sinTheta * sinPhi, cosTheta};
}

// Tells by its shape how a map of pbrt-v4 shows directions. Throws Error for other shapes.
MapProjection ProjectionOf(const LightReader& in, const Image& image, const std::string& file) {
    if (!in.entity.parameters.GetBool("equalarea", false)) return MapProjection::LatitudeLongitude;
    if (image.width == image.height) return MapProjection::EqualArea;
    if (image.width != 2 * image.height)
        throw Error(in.entity.loc,
                    "the sky \"{}\" has {}x{} pixels; it has to be square, of equal areas, or "
                    "twice as wide as high, of latitude and longitude",
                    file, image.width, image.height);
    in.warnings.Add(
        in.entity.loc,
        "a sky that is twice as wide as high is taken for one of latitude and longitude", file);
    return MapProjection::LatitudeLongitude;
}

// Returns the illuminance, as luminance, that the half of a map about +z gives a surface.
float IlluminanceOf(const EnvironmentMap& map, int width, int height) {
    // Small maps have texels on both sides of the horizon.
    const int columns = std::max(width, 512), rows = std::max(height, 512);
    double sum = 0, solidAngle = 0;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            const Vec2f st((float(x) + 0.5f) / float(columns), (float(y) + 0.5f) / float(rows));
            float weight;
            const Vec3f w = DirectionOf(map.Projection(), st, &weight);
            solidAngle += double(weight);
            if (w.z() > 0) sum += double(weight * w.z() * Luminance(map.Radiance(st)));
        }
    return float(4 * kPi * sum / solidAngle);
}

float SolidAnglePerArea(MapProjection projection, float sine) {
    return projection == MapProjection::EqualArea ? 4 * kPi : 2 * kPi * kPi * sine;
}

}  // namespace

EnvironmentMap::EnvironmentMap(Image i, const Rgb& s, bool isCompensated, MapProjection p)
    : image(std::move(i)),
      wrapRows(isCompensated ? Wrap::Clamp : Wrap::Repeat),
      scale(s),
      projection(p) {
    const bool isEqualArea = projection == MapProjection::EqualArea;
    const int perTexel = isEqualArea ? 1 : 2;
    const int columns = perTexel * image.width, rows = perTexel * image.height;
    const auto solidAngle = [&](int row) {
        if (isEqualArea) return 1.f;
        return std::sin(kPi * (float(row) + 0.5f) / float(rows));
    };
    float mean = 0;
    if (isCompensated) {
        double sum = 0, weights = 0;
        std::vector<float> brightness(columns);
        for (int row = 0; row < rows; ++row) {
            Brightness(row, brightness);
            sum += solidAngle(row) * std::accumulate(brightness.begin(), brightness.end(), 0.0);
            weights += double(solidAngle(row)) * columns;
        }
        mean = float(sum / weights);
    }
    const auto weigh = [&](int row, std::span<float> weights) {
        Brightness(row, weights);
        for (float& w : weights) w = solidAngle(row) * std::max(w - mean, kLeast * w);
    };
    cells = BlockDistribution(columns, rows, weigh, isCompensated ? kTolerance : 0);
}

Rgb EnvironmentMap::Radiance(const Vec2f& st) const {
    if (projection == MapProjection::EqualArea) return scale * NearestRgb(image, st);
    return scale * BilinearRgb(image, st, Wrap::Repeat, wrapRows);
}

void EnvironmentMap::Prefetch(const Vec2f& st) const {
    const Footprint f = BilinearFootprint(st, image.width, image.height, Wrap::Repeat, wrapRows);
    Visit(image.texels, [&](const auto& texels) {
        for (const int y : {f.y0, f.y1})
            lull::Prefetch(
                &texels[(size_t(y) * size_t(image.width) + size_t(f.x0)) * size_t(image.channels)]);
    });
}

void EnvironmentMap::Brightness(int row, std::span<float> cells) const {
    if (projection == MapProjection::EqualArea) {
        std::visit(
            [&](const auto& texels) {
                for (int x = 0; x < image.width; ++x)
                    cells[x] = Luminance(scale * TexelRgb(image, texels, x, row));
            },
            image.texels);
        return;
    }
    // Interpolate between the centres of the texels, down and then across.
    const int near = row / 2, far = NeighbourOf(row, image.height, wrapRows);
    std::vector<float> column(image.width);
    std::visit(
        [&](const auto& texels) {
            for (int x = 0; x < image.width; ++x)
                column[x] = Luminance(scale * (0.75f * TexelRgb(image, texels, x, near) +
                                               0.25f * TexelRgb(image, texels, x, far)));
        },
        image.texels);
    for (int u = 0; u < int(cells.size()); ++u)
        cells[u] =
            0.75f * column[u / 2] + 0.25f * column[NeighbourOf(u, image.width, Wrap::Repeat)];
}

Rgb EnvironmentMap::MeanTexel() const { return scale * lull::MeanTexel(image); }

Portal Portal::Make(std::span<const float> corners, const FileLoc& loc) {
    const auto fail = [&] {
        throw Error(loc, "\"portal\" needs the four corners of a rectangle, in their order");
    };
    if (corners.size() != 12) fail();
    const auto at = [&](size_t i) {
        return Vec3f(corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]);
    };
    Portal portal{at(0), at(3) - at(0), at(1) - at(0), {}, 0};
    const float a = portal.x.norm(), b = portal.y.norm();
    portal.n = portal.x.cross(portal.y);
    portal.area = portal.n.norm();
    const bool isSquare = std::abs(portal.x.dot(portal.y)) <= 1e-3f * a * b;
    const bool isParallel = (at(2) - at(1) - portal.x).norm() <= 1e-3f * (a + b);
    if (!(portal.area > 0) || !isSquare || !isParallel) fail();
    portal.n /= portal.area;
    return portal;
}

std::optional<std::pair<Vec3f, float>> Portal::Sample(const Vec3f& from, const Vec2f& u) const {
    const Vec3f d = corner + u.x() * x + u.y() * y - from;
    const float distance2 = d.squaredNorm(), along = d.dot(n);
    if (!(along > 0) || !(distance2 < kInfinity)) return {};
    const float distance = std::sqrt(distance2);
    return std::pair(Vec3f(d / distance), distance2 * distance / (area * along));
}

float Portal::Pdf(const Vec3f& from, const Vec3f& w) const {
    const float cosine = w.dot(n), height = (corner - from).dot(n);
    if (!(cosine > 0 && height > 0)) return 0;
    const float t = height / cosine;
    const Vec3f p = from + t * w - corner;
    const float s = p.dot(x) / x.squaredNorm(), v = p.dot(y) / y.squaredNorm();
    if (!(s >= 0 && s <= 1 && v >= 0 && v <= 1)) return 0;
    return t * t / (area * cosine);
}

Image MakeStudio() {
    constexpr int kWidth = 256, kHeight = 128;
    std::vector<float> texels;
    texels.reserve(size_t(kWidth) * kHeight);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const float elevation = (0.5f - (float(y) + 0.5f) / kHeight) * kPi;
            const Vec3f w = Direction(2 * kPi * (float(x) + 0.5f) / kWidth, elevation);
            float radiance = 0.12f + 0.33f * SmoothStep(0.5f + 0.5f * w.z());
            for (const SoftBox& box : kBoxes) radiance += RadianceOf(box, w);
            texels.push_back(radiance);
        }
    return {kWidth, kHeight, 1, std::move(texels)};
}

InfiniteLight InfiniteLight::Make(const LightReader& in) {
    const LightEntity& entity = in.entity;
    const Parameters& params = entity.parameters;
    InfiniteLight light;
    light.worldRadius = in.worldRadius;
    light.worldFromLight = entity.worldFromLight.topLeftCorner<3, 3>().cast<float>();
    light.lightFromWorld = entity.worldFromLight.inverse().topLeftCorner<3, 3>().cast<float>();
    // Directions alone are transformed; powers of a large scale would be infinite.
    const Mat3f unit = light.lightFromWorld / light.lightFromWorld.cwiseAbs().maxCoeff();
    if (!ScalesEvenly(unit)) {
        light.lightFromWorld = unit;
        light.stretch = std::abs(unit.determinant());
    }
    const Rgb L = LightColor(entity, "L", in.warnings);
    const std::string file = params.GetString("mapname", "");
    light.constant = L;
    if (const auto corners = params.GetFloats(ParameterType::Point3, "portal"); !corners.empty()) {
        if (params.GetBool("cutsout", false))
            light.portal = Portal::Make(corners, entity.loc);
        else
            in.warnings.Add(entity.loc, "portals are not used",
                            "the mean of the image is the same");
    }
    if (params.GetBool("studio", false)) {
        light.map = std::make_shared<const EnvironmentMap>(MakeStudio(), L, in.isCompensated);
        return light;
    }
    if (file.empty()) return light;
    try {
        // As in pbrt-v3, 8-bit environment maps are taken as linear.
        Image image = ReadImage(ResolvePath(in.description, file));
        if (params.GetBool("decode", false)) DecodeBytes(&image);
        const MapProjection projection = ProjectionOf(in, image, file);
        for (int bad = Blacken(L, &image); bad > 0; --bad)
            in.warnings.Add(entity.loc, "environment map texel that is not finite or negative",
                            file);
        const int width = image.width, height = image.height;
        const auto make = [&](Image texels, const Rgb& scale) {
            return std::make_shared<const EnvironmentMap>(std::move(texels), scale,
                                                          in.isCompensated, projection);
        };
        if (const float e = params.GetFloat("illuminance", -1); e > 0) {
            const float found = IlluminanceOf(*make(image, L), width, height);
            light.map = make(std::move(image), found > 0 ? Rgb(L * (2 * e / found)) : L);
        } else {
            light.map = make(std::move(image), L);
        }
    } catch (const Error& error) {
        in.warnings.Substitute(entity.loc, error.what(), "a constant light stands in");
    }
    return light;
}

// A constant light is sampled as pbrt-v3 does, as a map of one texel: evenly in both coordinates.
std::optional<LightSample> InfiniteLight::Sample(const Vec3f& from, const Vec2f& u) const {
    if (portal) [[unlikely]] {
        const auto sample = portal->Sample(from, u);
        if (!sample) return {};
        return LightSample{.L = LeAndPdf(from, sample->first).L,
                           .wi = sample->first,
                           .pdf = sample->second,
                           .isAtInfinity = true};
    }
    float mapPdf = 1, sine;
    const Vec2f st = map ? map->Sample(u, &mapPdf) : u;
    const Vec3f local = DirectionOf(Projection(), st, &sine);
    const Vec3f wi = (worldFromLight * local).normalized();
    const float pdf = mapPdf / SolidAnglePerArea(Projection(), sine) * Stretch(wi);
    if (!(pdf > 0) || !std::isfinite(pdf)) return {};
    if (map) map->Prefetch(st);
    return LightSample{.L = map ? Rgb::Ones() : constant,
                       .wi = wi,
                       .pdf = pdf,
                       .isOnMap = map != nullptr,
                       .isAtInfinity = true,
                       .p = {st.x(), st.y(), 0}};
}

Emitted InfiniteLight::LeAndPdf(const Vec3f& from, const Vec3f& w) const {
    const float throughPortal = portal ? portal->Pdf(from, w) : 1;
    if (throughPortal == 0) return {Rgb::Zero(), 0};
    const Vec3f local = (lightFromWorld * w).normalized();
    Vec2f st = Vec2f::Zero();
    if (map)
        st = Projection() == MapProjection::EqualArea ? EqualAreaSquareOf(local)
                                                      : CoordinatesOf(local);
    const Rgb L = map ? map->Radiance(st) : constant;
    if (portal) [[unlikely]]
        return {L, throughPortal};
    const float perArea = SolidAnglePerArea(Projection(), SafeSqrt(1 - Sqr(local.z())));
    const float mapPdf = map ? map->Pdf(st) : 1;
    return {L, perArea > 0 ? mapPdf / perArea * Stretch(w) : 0};
}

float InfiniteLight::Stretch(const Vec3f& w) const {
    if (stretch == 0) return 1;
    const float length = (lightFromWorld * w).norm();
    return stretch / (length * length * length);
}

// For the choice of lights by power; the map's mean is the topmost mip level of pbrt-v3.
Rgb InfiniteLight::Power() const {
    return kPi * Sqr(worldRadius) * (map ? map->MeanTexel() : constant);
}

DistantLight DistantLight::Make(const LightReader& in) {
    const LightEntity& entity = in.entity;
    const Parameters& params = entity.parameters;
    const Rgb L = LightColor(entity, "L", in.warnings);
    const Vec3f from = params.GetPoint3("from", Vec3f::Zero());
    const Vec3f to = params.GetPoint3("to", Vec3f(0, 0, 1));
    const Vec3f w = TransformVector(entity.worldFromLight, from - to);
    if (!(w.norm() > 0))
        throw Error(entity.loc, "the distant light's \"from\" and \"to\" coincide");
    return {w.normalized(), L, in.worldRadius};
}

std::optional<LightSample> DistantLight::Sample(const Vec3f&, const Vec2f&) const {
    return LightSample{.L = L, .wi = w, .isDelta = true, .isAtInfinity = true};
}

// The disc's irradiance is pi sin^2 of its radius times L.
SunLight::SunLight(const DistantLight& parallel, double angle)
    : w(parallel.w),
      L(parallel.L / float(std::numbers::pi * Sqr(std::sin(angle / 2)))),
      height(float(2 * Sqr(std::sin(angle / 4)))),
      solidAngle(2 * kPi * height),
      power(parallel.Power()) {}

std::optional<LightSample> SunLight::Sample(const Vec3f&, const Vec2f& u) const {
    // A point of the unit disk, whose area is that of the cap.
    const Vec2f d = SampleConcentricDisk(u);
    const float h = height * std::min(d.squaredNorm(), 1.f);
    const float across = std::sqrt(height * (2 - h));
    Vec3f s, t;
    CoordinateSystem(w, &s, &t);
    return LightSample{.L = L,
                       .wi = ((1 - h) * w + across * (d.x() * s + d.y() * t)).normalized(),
                       .pdf = 1 / solidAngle,
                       .isAtInfinity = true};
}

}  // namespace lull
