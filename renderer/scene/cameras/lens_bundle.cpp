#include "renderer/scene/cameras/lens_bundle.h"

#include <algorithm>
#include <cmath>

namespace lull {

namespace {

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

// Moves those that pass to the front.
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

}  // namespace lull
