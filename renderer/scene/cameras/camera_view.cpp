#include "renderer/scene/cameras/camera.h"

#include "renderer/base/sampling.h"

namespace lull {
namespace {

Mat4d WorldFromCamera(const Camera& camera, float time) {
    return camera.motion ? camera.motion->At(time) : camera.worldFromCamera;
}

// Returns the density where d, of unit length in camera space, is m d in the world. A solid angle
// there becomes |det m| / |m d|^3 times as large (pbrt 3rd ed., 16.1.1, for a pixel).
float Density(const Camera& camera, const Vec3f& d, const Eigen::Matrix3d& m) {
    const float pixel = std::abs(camera.planePerPixel.x() * camera.planePerPixel.y());
    const double length = (m * d.cast<double>()).norm();
    const double stretch = length * length * length / std::abs(m.determinant());
    return float(stretch / (double(pixel) * double(d.z()) * double(d.z()) * double(d.z())));
}

// Solves d = u dpdu + v dpdv for d in the tangent plane, by its two coordinates along which the
// normal is shortest; 0 where the derivatives are parallel there.
Vec2f ParametersOf(const Vec3f& d, const SurfaceInteraction& hit) {
    int longest;
    hit.n.cwiseAbs().maxCoeff(&longest);
    const int i = longest == 0 ? 1 : 0, j = longest == 2 ? 1 : 2;
    const Vec3f &a = hit.surfaceDpdu, &b = hit.surfaceDpdv;
    const float determinant = a[i] * b[j] - a[j] * b[i];
    const Vec2f uv((d[i] * b[j] - d[j] * b[i]) / determinant,
                   (a[i] * d[j] - a[j] * d[i]) / determinant);
    return uv.allFinite() ? uv : Vec2f(Vec2f::Zero());
}

}  // namespace

std::optional<CameraView> ViewOf(const Camera& camera, const Vec3f& p, const Vec2f& lens,
                                 float time) {
    const Mat4d m = WorldFromCamera(camera, time);
    const Eigen::Matrix3d linear = m.topLeftCorner<3, 3>();
    const Eigen::Vector3d translation = m.topRightCorner<3, 1>();
    const Vec3f at = (linear.inverse() * (p.cast<double>() - translation)).cast<float>();
    Vec3f origin = Vec3f::Zero();
    if (camera.lensRadius > 0) {
        const Vec2f q = camera.lensRadius * SampleConcentricDisk(lens);
        origin = {q.x(), q.y(), 0};
    }
    const Vec3f d = at - origin;
    if (!(d.z() > 0)) return {};
    // Where the line meets the plane z = 1, or, with a lens, the plane in focus, scaled to that.
    const float focus = camera.lensRadius > 0 ? camera.focalDistance : 1;
    const Vec2f plane = origin.head<2>() / focus + d.head<2>() / d.z();
    CameraView view;
    view.film = (plane - camera.planeOrigin).cwiseQuotient(camera.planePerPixel);
    view.lens = (linear * origin.cast<double>() + translation).cast<float>();
    view.perSolidAngle = Density(camera, d.normalized(), linear);
    if (!view.film.allFinite() || !(view.perSolidAngle > 0 && view.perSolidAngle < kInfinity))
        return {};
    return view;
}

float PixelsPerSolidAngle(const Camera& camera, const Vec3f& d, float time) {
    const Eigen::Matrix3d linear = WorldFromCamera(camera, time).topLeftCorner<3, 3>();
    const Vec3f local = (linear.inverse() * d.cast<double>()).cast<float>().normalized();
    return Density(camera, local, linear);
}

void ComputeFootprint(const Camera& camera, const CameraSample& sample, SurfaceInteraction* hit) {
    const float spacing = camera.sampleSpacing;
    const Ray ray = camera.GenerateRay(sample);
    std::array<Vec3f, 2> moves;
    for (int axis = 0; axis < 2; ++axis) {
        const std::optional<Ray> next = camera.NextRay(ray, sample, axis);
        if (!next) return;
        const Vec3f o = ray.o + spacing * (next->o - ray.o);
        const Vec3f d = ray.d + spacing * (next->d - ray.d);
        const float t = hit->n.dot(hit->p - o) / hit->n.dot(d);
        if (!std::isfinite(t)) return;
        moves[axis] = o + t * d - hit->p;
    }
    hit->dpdx = moves[0];
    hit->dpdy = moves[1];
    hit->duvdx = ParametersOf(hit->dpdx, *hit);
    hit->duvdy = ParametersOf(hit->dpdy, *hit);
}

}  // namespace lull
