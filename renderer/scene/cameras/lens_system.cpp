#include "renderer/scene/cameras/lens_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "renderer/files/file_io.h"
#include "renderer/input/spectrum.h"

namespace lull {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// pbrt-v3's: simple weighting divides by the area of the first bounds, which so many points fix.
constexpr int kPupils = 64, kPoints = 1 << 20, kFirstPoints = 1 << 14;

// Meets a ray with a spherical interface whose centre is at `center` on the axis: with that half of
// the sphere where the interface lies. Turns n to where the ray comes from.
bool MeetSphere(double radius, double center, const Vector3d& origin, const Vector3d& d, double* t,
                Vector3d* n) {
    const Vector3d o(origin.x(), origin.y(), origin.z() - center);
    const double a = d.squaredNorm(), halfB = d.dot(o), c = o.squaredNorm() - radius * radius;
    const double discriminant = halfB * halfB - a * c;
    if (!(discriminant >= 0)) return false;
    const double root = std::sqrt(discriminant);
    const bool isCloser = (d.z() < 0) != (radius < 0);
    *t = (-halfB + (isCloser ? -root : root)) / a;
    if (!(*t >= 0)) return false;
    *n = (o + *t * d).normalized();
    if (n->dot(d) > 0) *n = -*n;
    return true;
}

// Refracts d, made unit; `eta` is the index here over that beyond. False where all is reflected.
bool Refract(double eta, const Vector3d& n, Vector3d* d) {
    d->normalize();
    const double cosine = -n.dot(*d);
    const double sine2 = eta * eta * std::max(0., 1 - cosine * cosine);
    if (sine2 >= 1) return false;
    *d = eta * *d + (eta * cosine - std::sqrt(1 - sine2)) * n;
    return true;
}

// Carries a ray through one interface at height z of the axis. `eta` as in Refract.
bool Pass(const LensInterface& interface, double z, double eta, Vector3d* o, Vector3d* d) {
    double t;
    Vector3d n;
    if (interface.radius == 0) {
        t = (z - o->z()) / d->z();
        if (!(t >= 0) || !std::isfinite(t)) return false;
    } else if (!MeetSphere(interface.radius, z - interface.radius, *o, *d, &t, &n)) {
        return false;
    }
    *o += t * *d;
    if (o->head<2>().squaredNorm() > interface.apertureRadius * interface.apertureRadius)
        return false;
    return interface.radius == 0 || Refract(eta, n, d);
}

float RadicalInverse(int b, int i) {
    double result = 0, place = 1;
    for (; i > 0; i /= b) result += (i % b) * (place /= b);
    return float(std::min(result, double(kOneMinusEpsilon)));
}

using Values = LensBundle::Values;
using Passes = std::array<int64_t, LensBundle::kMost>;  // 0: stopped

// Tell which rays pass an interface at height z of the axis, and carry them through it. They treat
// each ray as LensSystem does, in loops without branches, which compilers vectorise.
void PassStop(const LensInterface& stop, double z, LensBundle* rays, Passes* passes) {
    const double aperture2 = stop.apertureRadius * stop.apertureRadius;
    for (size_t i = 0; i < rays->count; ++i) {
        const double t = (z - rays->oz[i]) / rays->dz[i];
        const double x = rays->ox[i] + t * rays->dx[i], y = rays->oy[i] + t * rays->dy[i];
        (*passes)[i] =
            (rays->dz[i] > 0) & (t >= 0) & (t < kInfinity) & (x * x + y * y <= aperture2);
        rays->ox[i] = x;
        rays->oy[i] = y;
        rays->oz[i] += t * rays->dz[i];
    }
}

void PassLens(const LensInterface& lens, double z, double eta, LensBundle* rays, Passes* passes) {
    const double center = z - lens.radius, radius2 = lens.radius * lens.radius;
    const double aperture2 = lens.apertureRadius * lens.apertureRadius;
    const double convex = lens.radius < 0 ? -1 : 1;
    for (size_t i = 0; i < rays->count; ++i) {
        const double ox = rays->ox[i], oy = rays->oy[i], oz = rays->oz[i] - center;
        double dx = rays->dx[i], dy = rays->dy[i], dz = rays->dz[i];
        const double a = dx * dx + dy * dy + dz * dz, halfB = dx * ox + dy * oy + dz * oz;
        const double discriminant = halfB * halfB - a * (ox * ox + oy * oy + oz * oz - radius2);
        const double root = convex * std::sqrt(std::max(discriminant, 0.));
        const double t = (-halfB + (dz < 0 ? -root : root)) / a;
        const double px = ox + t * dx, py = oy + t * dy, pz = oz + t * dz;
        // The normal, turned to where the ray comes from.
        const double side = px * dx + py * dy + pz * dz > 0 ? -1 : 1;
        const double n = side / std::sqrt(px * px + py * py + pz * pz), unit = 1 / std::sqrt(a);
        const double nx = px * n, ny = py * n, nz = pz * n;
        dx *= unit, dy *= unit, dz *= unit;
        const double cosine = -(nx * dx + ny * dy + nz * dz);
        const double sine2 = eta * eta * std::max(0., 1 - cosine * cosine);
        const double bend = eta * cosine - std::sqrt(std::max(0., 1 - sine2));
        (*passes)[i] =
            (discriminant >= 0) & (t >= 0) & (px * px + py * py <= aperture2) & (sine2 < 1);
        rays->ox[i] = px;
        rays->oy[i] = py;
        rays->oz[i] = pz + center;
        rays->dx[i] = eta * dx + bend * nx;
        rays->dy[i] = eta * dy + bend * ny;
        rays->dz[i] = eta * dz + bend * nz;
    }
}

void Keep(const Passes& passes, LensBundle* rays) {
    size_t kept = 0;
    for (size_t i = 0; i < rays->count; ++i) {
        for (Values* values : {&rays->ox, &rays->oy, &rays->oz, &rays->dx, &rays->dy, &rays->dz})
            (*values)[kept] = (*values)[i];
        rays->rear[kept] = rays->rear[i];
        kept += size_t(passes[i]);
    }
    rays->count = kept;
}

}  // namespace

double LensSystem::FrontZ() const {
    double z = 0;
    for (const LensInterface& i : interfaces) z += i.thickness;
    return z;
}

bool LensSystem::TraceFromFilm(Line* ray) const {
    double z = 0;
    for (size_t i = interfaces.size(); i-- > 0;) {
        z += interfaces[i].thickness;
        if (interfaces[i].radius == 0 && ray->d.z() <= 0) return false;
        const double beyond = i > 0 ? interfaces[i - 1].eta : 1;
        if (!Pass(interfaces[i], z, interfaces[i].eta / beyond, &ray->o, &ray->d)) return false;
    }
    return true;
}

bool LensSystem::TraceFromScene(Line* ray) const {
    double z = FrontZ();
    for (size_t i = 0; i < interfaces.size(); ++i) {
        const double before = i > 0 ? interfaces[i - 1].eta : 1;
        if (!Pass(interfaces[i], z, before / interfaces[i].eta, &ray->o, &ray->d)) return false;
        z -= interfaces[i].thickness;
    }
    return true;
}

double LensSystem::FocusedRearZ(const Settings& settings) const {
    // Find the principal planes and focal points on both sides from rays parallel to the axis.
    const double x = 0.002 * filmRadius;
    struct Cardinal {
        double plane, focus;
    };
    const auto cardinal = [&](const Line& out) {
        const double slope = out.d.z() / out.d.x();
        return Cardinal{-(out.o.z() + (x - out.o.x()) * slope), -(out.o.z() - out.o.x() * slope)};
    };
    Line toFilm{{x, 0, FrontZ() + 1}, {0, 0, -1}}, toScene{{x, 0, RearZ() - 1}, {0, 0, 1}};
    if (!TraceFromScene(&toFilm) || !TraceFromFilm(&toScene))
        throw Error(
            settings.loc,
            "no light passes the lenses of '{}' along the axis; the aperture may be too small",
            settings.file);
    const Cardinal film = cardinal(toFilm), scene = cardinal(toScene);
    // Solve the thick lens equation for where the film has to be.
    const double f = film.focus - film.plane, z = -double(settings.focusDistance);
    const double c = (scene.plane - z - film.plane) * (scene.plane - z - 4 * f - film.plane);
    const double rearZ = RearZ() + 0.5 * (scene.plane - z + film.plane - std::sqrt(c));
    if (!(c > 0) || !(rearZ > 0) || !std::isfinite(rearZ))
        throw Error(settings.loc, "the lenses of '{}' cannot focus at {} m", settings.file,
                    settings.focusDistance);
    return rearZ;
}

LensSystem::Area LensSystem::BoundExitPupil(double r0, double r1,
                                            const std::vector<Vec2f>& points) const {
    const double side = 1.5 * interfaces.back().apertureRadius;
    const auto isInside = [](const Vector2d& p, const Area& area) {
        return (p.array() >= area.lower.array()).all() && (p.array() <= area.upper.array()).all();
    };
    const Area nothing{Vector2d::Constant(kInfinity), Vector2d::Constant(-kInfinity)};
    Area bounds = nothing, reach{nothing.upper, nothing.lower};
    const auto hasLight = [&] { return bounds.lower.x() <= bounds.upper.x(); };
    LensBundle rays;
    const auto trace = [&] {
        rays.TraceFromFilm(interfaces);
        for (; rays.count > 0; --rays.count) {
            bounds.lower = bounds.lower.cwiseMin(rays.rear[rays.count - 1]);
            bounds.upper = bounds.upper.cwiseMax(rays.rear[rays.count - 1]);
        }
    };
    for (size_t i = 0; i < points.size(); ++i) {
        // Once the first points have shown where light passes, only those nearby can add to it.
        if (i == kFirstPoints) {
            trace();
            const double margin = 8 * side / std::sqrt(double(kFirstPoints));
            if (hasLight()) reach = {bounds.lower.array() - margin, bounds.upper.array() + margin};
        }
        const Vector2d rear = (2 * points[i].cast<double>() - Vector2d::Ones()) * side;
        if (isInside(rear, bounds) || !isInside(rear, reach)) continue;
        const double r = r0 + (double(i) + 0.5) / double(points.size()) * (r1 - r0);
        rays.Add({r, 0, 0}, {rear.x(), rear.y(), RearZ()});
        if (rays.IsFull()) trace();
    }
    trace();
    // Without any light the sides do not matter.
    if (!hasLight()) return {Vector2d::Constant(-side), Vector2d::Constant(side)};
    const double spacing = 2 * std::sqrt(8.) * side / std::sqrt(double(points.size()));
    return {bounds.lower.array() - spacing, bounds.upper.array() + spacing};
}

LensSystem::LensSystem(const Settings& settings, int threads)
    : interfaces(settings.interfaces),
      filmExtent(settings.filmExtent),
      filmRadius(0.5 * double(filmExtent.norm())) {
    interfaces.back().thickness = FocusedRearZ(settings);

    std::vector<Vec2f> points(kPoints);
    for (int i = 0; i < kPoints; ++i) points[i] = {RadicalInverse(2, i), RadicalInverse(3, i)};
    pupils.resize(kPupils);
    std::atomic<int> next = 0;
    const auto work = [&] {
        for (int i; (i = next++) < kPupils;)
            pupils[i] =
                BoundExitPupil(i * filmRadius / kPupils, (i + 1) * filmRadius / kPupils, points);
    };
    {
        std::vector<std::jthread> helpers;
        const int count = threads > 0 ? threads : int(std::thread::hardware_concurrency());
        for (int i = 1; i < std::min(count, kPupils); ++i) helpers.emplace_back(work);
        work();
    }
    const Area& middle = pupils[0];
    scale = settings.simpleWeighting ? 1 / (middle.upper - middle.lower).prod()
                                     : double(settings.exposureTime) / Sqr(RearZ());
}

Ray LensSystem::Generate(const Vec2f& st, const Vec2f& u, float* weight) const {
    // The image is upside down on the film.
    const Vector2d film = (Vec2f(0.5f, 0.5f) - st).cwiseProduct(filmExtent).cast<double>();
    const double x = film.x(), y = -film.y(), r = std::sqrt(x * x + y * y);
    const Area& pupil = pupils[std::min(int(r / filmRadius * kPupils), kPupils - 1)];
    const Vector2d size = pupil.upper - pupil.lower;
    const Vector2d p = pupil.lower + size.cwiseProduct(u.cast<double>());
    // Bounds are those of points on the x axis; turn to the point at hand.
    const double cosine = r > 0 ? x / r : 1, sine = r > 0 ? y / r : 0;
    Line ray{{x, y, 0},
             {cosine * p.x() - sine * p.y() - x, sine * p.x() + cosine * p.y() - y, RearZ()}};
    const double cos2 = Sqr(ray.d.z()) / ray.d.squaredNorm();
    *weight = 0;
    if (!TraceFromFilm(&ray)) return {Vec3f::Zero(), Vec3f::UnitZ()};
    *weight = float(Sqr(cos2) * size.prod() * scale);
    return {ray.o.cast<float>(), ray.d.normalized().cast<float>(), kInfinity};
}

void LensBundle::Add(const Eigen::Vector3d& film, const Eigen::Vector3d& lens) {
    ox[count] = film.x(), oy[count] = film.y(), oz[count] = film.z();
    dx[count] = lens.x() - film.x(), dy[count] = lens.y() - film.y(),
    dz[count] = lens.z() - film.z();
    rear[count++] = lens.head<2>();
}

void LensBundle::TraceFromFilm(std::span<const LensInterface> interfaces) {
    double z = 0;
    Passes passes;
    for (size_t i = interfaces.size(); i-- > 0 && count > 0;) {
        const LensInterface& interface = interfaces[i];
        z += interface.thickness;
        const double beyond = i > 0 ? interfaces[i - 1].eta : 1;
        if (interface.radius == 0)
            PassStop(interface, z, this, &passes);
        else
            PassLens(interface, z, interface.eta / beyond, this, &passes);
        Keep(passes, this);
    }
}

std::vector<LensInterface> LoadLens(const std::string& path, const FileLoc& loc) {
    const std::vector<float> numbers = ReadNumberFile(path, "lens", loc);
    const auto fail = [&](const std::string& what) {
        throw Error(loc, "the lens file '{}' {}", Printable(path, 4096), what);
    };
    constexpr size_t kMost = 1000;
    if (numbers.empty() || numbers.size() % 4 != 0 || numbers.size() > 4 * kMost)
        fail(fmt::format("has {} numbers; four are needed for each of 1 to {} interfaces",
                         numbers.size(), kMost));
    std::vector<LensInterface> interfaces;
    for (size_t i = 0; i < numbers.size(); i += 4) {
        const double radius = double(numbers[i]), thickness = double(numbers[i + 1]);
        const double eta = double(numbers[i + 2]), diameter = double(numbers[i + 3]);
        constexpr double kMetres = 1e-3, kMostLength = 1e9;
        if (!(std::abs(radius) <= kMostLength) || !(std::abs(thickness) <= kMostLength))
            fail(fmt::format("has a radius or thickness beyond {:g} mm in row {}", kMostLength,
                             i / 4 + 1));
        if (!(diameter > 0 && diameter <= kMostLength))
            fail(fmt::format("has a diameter of {:g} mm in row {}; it has to be positive", diameter,
                             i / 4 + 1));
        if (!(eta == 0 || (eta >= 0.1 && eta <= 10)))
            fail(fmt::format("has an index of refraction of {:g} in row {}", eta, i / 4 + 1));
        // An index of 0 stands for air.
        interfaces.push_back(
            {radius * kMetres, thickness * kMetres, eta == 0 ? 1 : eta, 0.5 * diameter * kMetres});
    }
    return interfaces;
}

}  // namespace lull
