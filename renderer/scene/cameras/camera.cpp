#include "renderer/scene/cameras/camera.h"

#include <fmt/format.h>

#include "renderer/base/math.h"
#include "renderer/base/sampling.h"
#include "renderer/files/file_io.h"
#include "renderer/input/spectrum.h"
#include "renderer/scene/cameras/lens_system.h"
#include "renderer/scene/geometry/shape.h"
#include "stopping/base/input_file.h"

namespace lull {

Ray Camera::Clip(const Vec3f& origin, const Vec3f& direction) const {
    const float from = clipStart / direction.z();
    return {position + rotation * (origin + from * direction), rotation * direction,
            clipEnd / direction.z() - from};
}

Ray Camera::GeneratePerspectiveRay(const Vec2f& film, const Vec2f& lens) const {
    const Vec2f plane = planeOrigin + film.cwiseProduct(planePerPixel);
    const Vec3f direction = Vec3f(plane.x(), plane.y(), 1).normalized();
    if (lensRadius == 0) {
        if (Clips()) [[unlikely]]
            return Clip(Vec3f::Zero(), direction);
        return {position, rotation * direction, kInfinity};
    }

    // Move the origin to the lens and aim at the point that is in focus.
    const Vec2f p = lensRadius * SampleConcentricDisk(lens);
    const Vec3f origin(p.x(), p.y(), 0);
    const Vec3f focus = direction * (focalDistance / direction.z());
    if (Clips()) return Clip(origin, (focus - origin).normalized());
    return {position + rotation * origin, rotation * (focus - origin).normalized(), kInfinity};
}

Ray Camera::GenerateOtherRay(const Vec2f& film, const Vec2f& lens) const {
    const Vec2f plane = planeOrigin + film.cwiseProduct(planePerPixel);
    if (projection == Projection::Environment) {
        const float phi = plane.x(), theta = plane.y(), sinTheta = std::sin(theta);
        const Vec3f d(sinTheta * std::cos(phi), std::cos(theta), sinTheta * std::sin(phi));
        return {position, rotation * d, kInfinity};
    }
    if (projection == Projection::EqualArea) {
        // Filters may reach beyond an edge, where the square is folded.
        Vec2f p = plane;
        for (int i = 0; i < 2; ++i)
            if (p[i] < 0 || p[i] > 1) {
                p[i] = p[i] < 0 ? -p[i] : 2 - p[i];
                p[1 - i] = 1 - p[1 - i];
            }
        const Vec3f d = DirectionOfEqualAreaSquare(p);
        return {position, rotation * Vec3f(d.x(), d.z(), d.y()), kInfinity};
    }
    Vec3f origin(plane.x(), plane.y(), 0), direction = Vec3f::UnitZ();
    if (lensRadius > 0) {
        // As in pbrt-v3 there is one lens for all pixels, about the camera's axis, and not one
        // about the origin of each pixel's ray: far from the plane of focus the image is that of
        // a perspective camera which looks at the plane's window.
        const Vec2f p = lensRadius * SampleConcentricDisk(lens);
        const Vec3f focus(plane.x(), plane.y(), focalDistance);
        origin = Vec3f(p.x(), p.y(), 0);
        direction = (focus - origin).normalized();
    }
    if (Clips()) return Clip(origin, direction);
    return {position + rotation * origin, rotation * direction, kInfinity};
}

Ray Camera::GenerateRareRay(const CameraSample& sample, float* weight) const {
    const auto& [film, lens, time, isRight] = sample;
    Ray ray;
    if (lenses) {
        ray = lenses->Generate(film.cwiseProduct(perPixel), lens, weight);
        ray = {position + rotation * ray.o, rotation * ray.d, kInfinity};
    } else {
        ray = projection == Projection::Perspective ? GeneratePerspectiveRay(film, lens)
                                                    : GenerateOtherRay(film, lens);
    }
    if (!motion) return ray;
    const Mat4d m = motion->At(time);
    return {TransformPoint(m, ray.o), TransformVector(m, ray.d), ray.tMax};
}

std::optional<Ray> Camera::NextRay(const Ray& ray, CameraSample sample, int axis) const {
    const Vec2f film = sample.film, step = axis == 0 ? Vec2f(1, 0) : Vec2f(0, 1);
    sample.film = film + step;
    if (!lenses) return GenerateRay(sample);
    for (const float share : {0.05f, -0.05f}) {
        float weight;
        sample.film = film + share * step;
        const Ray next = GenerateRay(sample, &weight);
        if (weight > 0)
            return Ray{ray.o + (next.o - ray.o) / share, ray.d + (next.d - ray.d) / share,
                       kInfinity};
    }
    return {};
}

namespace {

// Reads the screen window: [-1, 1] along the shorter axis unless the scene says otherwise.
std::array<float, 4> ReadScreen(const Entity& entity, const Vec2i& resolution) {
    const Parameters& params = entity.parameters;
    const float aspect =
        params.GetFloat("frameaspectratio", float(resolution.x()) / float(resolution.y()));
    if (!(aspect > 0 && aspect < kInfinity))
        throw Error(entity.loc, "\"frameaspectratio\" is {}; it has to be above 0", aspect);
    std::array<float, 4> screen = aspect > 1 ? std::array{-aspect, aspect, -1.f, 1.f}
                                             : std::array{-1.f, 1.f, -1 / aspect, 1 / aspect};
    if (const auto window = params.GetFloats(ParameterType::Float, "screenwindow");
        !window.empty()) {
        if (window.size() != 4)
            throw Error(entity.loc, "\"screenwindow\" needs four values: x0 x1 y0 y1");
        std::copy(window.begin(), window.end(), screen.begin());
        if (screen[0] == screen[1] || screen[2] == screen[3])
            throw Error(entity.loc, "\"screenwindow\" has no extent");
    }
    // lull's own, of glTF's cameras: the least window that shows -x to x and -y to y.
    if (const auto fit = params.GetFloats(ParameterType::Float, "screenfit"); !fit.empty()) {
        if (fit.size() != 2 || !(fit[0] >= 0) || !(fit[1] > 0))
            throw Error(entity.loc, "\"screenfit\" needs two values: x >= 0, y > 0");
        const float y = std::max(fit[1], fit[0] / aspect), x = y * aspect;
        screen = {-x, x, -y, y};
    }
    // lull's own: moves the window by shares of its width and height, right and up.
    if (const auto shift = params.GetFloats(ParameterType::Float, "screenshift"); !shift.empty()) {
        if (shift.size() != 2) throw Error(entity.loc, "\"screenshift\" needs two values: x y");
        const float x = shift[0] * (screen[1] - screen[0]), y = shift[1] * (screen[3] - screen[2]);
        screen = {screen[0] + x, screen[1] + x, screen[2] + y, screen[3] + y};
    }
    for (const float end : screen)
        if (!(std::abs(end) <= kFarthest))
            throw Error(entity.loc,
                        "the image reaches to {:g} on the plane that the camera sees it on; {:g} "
                        "is the farthest",
                        end, kFarthest);
    return screen;
}

float ReadFieldOfView(const Entity& entity) {
    float fov = entity.parameters.GetFloat("fov", 90);
    if (const float half = entity.parameters.GetFloat("halffov", -1); half > 0) fov = 2 * half;
    const auto known = FieldOfView(double(fov));
    if (!known)
        throw Error(entity.loc, "the field of view is {} degrees; it has to lie between 0 and 180",
                    fov);
    return float(*known);
}

Projection ReadProjection(const Entity& entity) {
    if (entity.name == "perspective") return Projection::Perspective;
    if (entity.name == "orthographic") return Projection::Orthographic;
    if (entity.name == "environment") return Projection::Environment;
    if (entity.name == "equalarea") return Projection::EqualArea;
    if (entity.name == "realistic") return Projection::Realistic;
    throw Error(
        entity.loc,
        "Camera \"{}\" is not supported; perspective, orthographic, environment and realistic are",
        Printable(entity.name));
}

LensSystem ReadLenses(const Description& description, const FilmSettings& film,
                      const Shutter& shutter, int threads, Warnings& warnings) {
    const Entity& entity = description.camera;
    const Parameters& params = entity.parameters;
    const std::string file = params.GetString("lensfile", "");
    if (file.empty()) throw Error(entity.loc, "Camera \"realistic\" needs a \"lensfile\"");
    LensSystem::Settings settings;
    settings.loc = entity.loc;
    settings.file = Printable(file, 4096);
    settings.interfaces = LoadLens(ResolvePath(description, file), entity.loc);
    const float diameter = GetNonnegative(entity, "aperturediameter", 1);  // millimetres
    for (LensInterface& stop : settings.interfaces)
        if (const double radius = 0.0005 * double(diameter); stop.radius == 0) {
            if (IsAbove(radius, stop.apertureRadius))
                warnings.Add(entity.loc,
                             "\"aperturediameter\" is limited to the aperture of the lens",
                             fmt::format("{:g} mm", 2000 * stop.apertureRadius));
            stop.apertureRadius = std::min(stop.apertureRadius, radius);
        }
    settings.focusDistance = params.GetFloat("focusdistance", 10);
    if (!(settings.focusDistance > 0))
        throw Error(entity.loc, "\"focusdistance\" has to be above 0");
    settings.simpleWeighting = params.GetBool("simpleweighting", true);
    settings.exposureTime = float(shutter.close - shutter.open);
    const float aspect = float(film.resolution.y()) / float(film.resolution.x());
    settings.filmExtent = film.diagonal / std::sqrt(1 + Sqr(aspect)) * Vec2f(1, aspect);
    return LensSystem(settings, threads);
}

void ReadPlane(const Entity& entity, const Vec2i& resolution, Camera* camera) {
    const Parameters& params = entity.parameters;
    const std::array<float, 4> screen = ReadScreen(entity, resolution);
    const float fov = camera->projection == Projection::Perspective ? ReadFieldOfView(entity) : 90;
    camera->lensRadius = GetNonnegative(entity, "lensradius", 0);
    camera->focalDistance = params.GetFloat("focaldistance", 1e6f);
    if (!(camera->focalDistance > 0))
        throw Error(entity.loc, "\"focaldistance\" has to be above 0");
    // lull's own, of glTF's cameras.
    camera->clipStart = GetNonnegative(entity, "clipstart", 0);
    camera->clipEnd = params.GetFloat("clipend", kInfinity);
    if (!(camera->clipEnd > camera->clipStart))
        throw Error(entity.loc, "\"clipend\" has to be above \"clipstart\"");

    if (camera->projection == Projection::EqualArea) {
        camera->planePerPixel = resolution.cast<float>().cwiseInverse();
    } else if (camera->projection == Projection::Environment) {
        camera->lensRadius = 0;  // it has none, though pbrt-v3 reads the parameter
        camera->planePerPixel = {2 * kPi / resolution.x(), kPi / resolution.y()};
    } else {
        const float scale =
            camera->projection == Projection::Perspective ? std::tan(fov * kPi / 360) : 1;
        camera->planeOrigin = scale * Vec2f(screen[0], screen[3]);
        camera->planePerPixel = scale * Vec2f((screen[1] - screen[0]) / resolution.x(),
                                              (screen[2] - screen[3]) / resolution.y());
    }
}

// Returns whether the camera shows what is seen through a window of a plane.
bool HasPlane(const Camera& camera) {
    return camera.projection == Projection::Perspective ||
           camera.projection == Projection::Orthographic;
}

}  // namespace

double Farthest(const Camera& camera, const FilmSettings& film) {
    double size = 1;
    if (HasPlane(camera)) {
        const Vec2f last =
            camera.planeOrigin + film.resolution.cast<float>().cwiseProduct(camera.planePerPixel);
        size += camera.planeOrigin.cast<double>().norm() + last.cast<double>().norm();
        size += double(camera.clipStart) * size;
        if (camera.lensRadius > 0) size += double(camera.lensRadius) + double(camera.focalDistance);
    }
    // While it moves, it is neither farther away nor larger than at one of the ends.
    double farthest = 0;
    for (const double time : {0., 1.}) {
        const Mat4d m = camera.motion ? camera.motion->At(time) : camera.worldFromCamera;
        const double scale = m.topLeftCorner<3, 3>().norm();
        farthest = std::max(farthest, m.topRightCorner<3, 1>().norm() + scale * size);
    }
    return farthest;
}

Camera MakeCamera(const Description& description, const FilmSettings& film, Warnings& warnings,
                  int threads) {
    const Entity& entity = description.camera;
    Camera camera;
    camera.projection = ReadProjection(entity);
    const Shutter shutter = ReadShutter(entity);
    if (entity.parameters.GetFloat("shutterclose", 1) <
        entity.parameters.GetFloat("shutteropen", 0))
        warnings.Add(entity.loc, "the shutter closes before it opens; the times are swapped");
    if (camera.projection == Projection::Realistic) {
        camera.lenses = ReadLenses(description, film, shutter, threads, warnings);
        camera.perPixel = film.resolution.cast<float>().cwiseInverse();
    } else {
        ReadPlane(entity, film.resolution, &camera);
    }
    ReadStereo(entity);
    entity.parameters.ReportUnused("Camera \"" + entity.name + "\"", warnings);
    camera.worldFromCamera = description.cameraFromWorld.inverse();
    if (description.movingCameraFromWorld) {
        const auto& [open, close] = description.movingCameraFromWorld->at;
        const auto& [startTime, endTime] = description.transformTimes;
        const AnimatedTransform motion(open.inverse(), close.inverse(), startTime, endTime,
                                       shutter);
        camera.worldFromCamera = motion.At(0);
        if (!motion.IsConstant()) camera.motion = motion;
    }
    if (!camera.worldFromCamera.allFinite())
        throw Error(entity.loc, "the camera's transform cannot be inverted");
    camera.position = TransformPoint(camera.worldFromCamera, Vec3f::Zero());
    // Scales in the transform change the length of directions, not their target; remove a uniform
    // one, so that rays have unit length as pbrt-v3's nearly always have.
    camera.rotation = camera.worldFromCamera.topLeftCorner<3, 3>().cast<float>();
    if (camera.motion) {
        camera.rotation.setIdentity();
        camera.position.setZero();
    }
    return camera;
}

Stereo ReadStereo(const Entity& entity) {
    const Parameters& params = entity.parameters;
    Stereo stereo{.distance = GetNonnegative(entity, "eyedistance", 0),
                  .convergence = GetNonnegative(entity, "convergence", 0)};
    const std::string eye = params.GetString("eye", "");
    if (eye == "left") stereo.alone = Eye::Left;
    if (eye == "right") stereo.alone = Eye::Right;
    if (!eye.empty() && stereo.alone == Eye::Middle)
        throw Error(entity.loc, "the view \"{}\" is unknown; left and right are", Printable(eye));
    if (stereo.distance > 0 && entity.name != "perspective")
        throw Error(entity.loc, "two eyes need a perspective camera; this one is \"{}\"",
                    Printable(entity.name));
    return stereo;
}

Camera CameraOfEye(const Camera& middle, const Stereo& stereo, Eye eye) {
    if (eye == Eye::Middle || stereo.distance == 0) return middle;
    Camera camera = middle;
    const float x = (eye == Eye::Left ? -0.5f : 0.5f) * stereo.distance;
    camera.position += camera.rotation * Vec3f(x, 0, 0);
    for (int i = 0; i < 3; ++i)
        camera.worldFromCamera(i, 3) += double(x) * middle.worldFromCamera(i, 0);
    if (stereo.convergence > 0) camera.planeOrigin.x() -= x / stereo.convergence;
    return camera;
}

Mat4d WorldToCamera(const Camera& camera) { return camera.worldFromCamera.inverse(); }

std::optional<Mat4d> WorldToNdc(const Camera& camera, const FilmSettings& film) {
    if (!HasPlane(camera)) return {};
    const bool isPerspective = camera.projection == Projection::Perspective;
    // Project onto the plane z = 1, or along z, then scale the image to [0, 1]^2.
    Mat4d ndcFromCamera = Mat4d::Zero();
    for (int i = 0; i < 2; ++i) {
        const double perUnit = 1.0 / (double(camera.planePerPixel[i]) * film.resolution[i]);
        ndcFromCamera(i, i) = perUnit;
        ndcFromCamera(i, isPerspective ? 2 : 3) = -camera.planeOrigin[i] * perUnit;
    }
    ndcFromCamera(2, 2) = 1;
    ndcFromCamera(3, isPerspective ? 2 : 3) = 1;
    return Mat4d(ndcFromCamera * WorldToCamera(camera));
}

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
