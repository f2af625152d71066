#include "renderer/input/gltf/cameras.h"

#include <fmt/format.h>

#include <limits>
#include <numbers>

#include "renderer/base/math.h"
#include "renderer/input/gltf/materials.h"

namespace lull {
namespace {

constexpr int kHeight = 800;
constexpr double kDefaultAspect = 1.5;
constexpr double kDefaultFov = 40;  // degrees, vertical, of the framing
constexpr double kDefaultAzimuth = 30, kDefaultElevation = 15;

// Camera space has +z ahead, glTF's -z.
Mat4d CameraFromNode() { return Eigen::Vector4d(1, 1, -1, 1).asDiagonal(); }

struct View {
    const tinygltf::Camera* camera;
    GltfNode node;
};

std::vector<View> ListViews(const GltfDocument& document, const std::vector<GltfNode>& nodes) {
    std::vector<View> views;
    for (const GltfNode& node : nodes)
        if (const int camera = document.model.nodes[size_t(node.index)].camera; camera >= 0)
            views.push_back({&document.model.cameras[size_t(camera)], node});
    return views;
}

std::string NameOf(const GltfDocument& document, const View& view) {
    const std::string& name = document.model.nodes[size_t(view.node.index)].name;
    return name.empty() ? view.camera->name : name;
}

const View& Choose(const GltfDocument& document, const std::vector<View>& views,
                   const std::string& wanted) {
    for (const View& view : views)
        if (wanted == view.camera->name ||
            wanted == document.model.nodes[size_t(view.node.index)].name)
            return view;
    std::vector<std::string> names;
    for (const View& view : views) names.push_back(NameOf(document, view));
    return views[ChooseByName(document, "camera", names, wanted)];
}

// Sets a camera that shows the plane at distance 1 from -x to x and -y to y, whatever aspect the
// image gets. The usual one is x / y; where the file has none, `x` is 0, and only y is fixed.
void SetCamera(const char* projection, double x, double y, const FileLoc& loc,
               Description* description) {
    description->camera = {projection, {}, loc};
    ParameterWriter(&description->camera.parameters, loc)
        .Floats(ParameterType::Float, "screenfit", {float(x), float(y)});
    const double aspect = x > 0 ? x / y : kDefaultAspect;
    const ParameterWriter film(&description->film.parameters, loc);
    film.Int("xresolution", int(std::clamp(std::round(kHeight * aspect), 1.0, 16.0 * kHeight)));
    film.Int("yresolution", kHeight);
}

void SetPerspective(double fov, double aspect, const FileLoc& loc, Description* description) {
    const double tangent = std::tan(fov / 2);
    SetCamera("perspective", aspect * tangent, tangent, loc, description);
}

// Sets the properties that glTF's cameras lack, from `extras`: the window moved by fractions of the
// image's sides, a thin lens, and distances along the axis before and beyond which it is blind.
void SetLens(const tinygltf::Value& extras, const FileLoc& loc, Description* description) {
    if (!extras.Has("lull")) return;
    const tinygltf::Value& lens = extras.Get("lull");
    const ParameterWriter write(&description->camera.parameters, loc);
    const auto number = [](const tinygltf::Value& value) {
        return float(value.GetNumberAsDouble());
    };
    if (lens.Has("shift"))
        write.Floats(ParameterType::Float, "screenshift",
                     {number(lens.Get("shift").Get(0)), number(lens.Get("shift").Get(1))});
    if (lens.Has("lensRadius")) write.Float("lensradius", number(lens.Get("lensRadius")));
    if (lens.Has("clipStart")) write.Float("clipstart", number(lens.Get("clipStart")));
    if (lens.Has("clipEnd")) write.Float("clipend", number(lens.Get("clipEnd")));
    if (lens.Has("focusDistance")) write.Float("focaldistance", number(lens.Get("focusDistance")));
}

// Scales of the nodes do not count.
Mat4d CameraFromWorld(const Mat4d& worldFromNode, const FileLoc& loc) {
    Mat4d m = worldFromNode;
    for (int i = 0; i < 3; ++i) {
        const double length = m.col(i).head<3>().norm();
        if (!(length > 0)) throw Error(loc, "the camera's node has no extent");
        m.col(i) /= length;
    }
    const Mat4d cameraFromWorld = CameraFromNode() * m.inverse();
    if (!cameraFromWorld.allFinite())
        throw Error(loc, "the transform of the camera's node cannot be inverted");
    return cameraFromWorld;
}

void LookThrough(const GltfDocument& document, const View& view, Description* description) {
    const auto index = size_t(view.camera - document.model.cameras.data());
    const FileLoc loc = document.At(fmt::format("/cameras/{}", index));
    description->cameraFromWorld = CameraFromWorld(view.node.worldFromNode, loc);
    if (view.node.atClose)
        description->movingCameraFromWorld =
            TransformPair{{description->cameraFromWorld, CameraFromWorld(*view.node.atClose, loc)}};
    if (view.camera->type == "perspective") {
        const auto& p = view.camera->perspective;
        constexpr double kWidest = std::numbers::pi - 1e-3;
        if (!(p.yfov > 0) || IsAbove(p.yfov, std::numbers::pi))
            throw Error(loc, "yfov is {}; it has to lie between 0 and pi", p.yfov);
        if (!(p.aspectRatio >= 0)) throw Error(loc, "aspectRatio has to be positive");
        SetPerspective(std::min(p.yfov, kWidest), p.aspectRatio, loc, description);
        SetLens(view.camera->extras, loc, description);
        return;
    }
    const double x = std::abs(view.camera->orthographic.xmag);
    const double y = std::abs(view.camera->orthographic.ymag);
    if (!(x > 0 && y > 0)) throw Error(loc, "xmag and ymag have to be other than 0");
    SetCamera("orthographic", x, y, loc, description);
    SetLens(view.camera->extras, loc, description);
}

}  // namespace

std::optional<Framing> FramingFor(const GltfDocument& document, const std::vector<GltfNode>& nodes,
                                  const GltfOptions& options) {
    if (!options.camera.empty() || (!options.orbit && !ListViews(document, nodes).empty()))
        return {};
    const double tangent = std::tan(kDefaultFov * std::numbers::pi / 360);
    const std::array<double, 2> tangents = {kDefaultAspect * tangent, tangent};
    if (!options.orbit) return Framing(kDefaultAzimuth, kDefaultElevation, tangents);
    return Framing((*options.orbit)[0], (*options.orbit)[1], tangents);
}

void SetView(const GltfDocument& document, const std::vector<GltfNode>& nodes,
             const std::optional<Framing>& framing, const GltfOptions& options,
             Description* description) {
    if (framing) {
        description->cameraFromWorld = CameraFromNode() * framing->WorldFromCamera().inverse();
        return SetPerspective(kDefaultFov * std::numbers::pi / 180, kDefaultAspect,
                              document.At("/cameras"), description);
    }
    const std::vector<View> views = ListViews(document, nodes);
    LookThrough(document,
                options.camera.empty() ? views[0] : Choose(document, views, options.camera),
                description);
}

namespace {

constexpr double kMargin = 0.06;  // of the picture, that stays free at each side
constexpr double kInfinite = std::numeric_limits<double>::infinity();

}  // namespace

std::vector<Vec3f> OutlineOf(const std::vector<float>& points) {
    constexpr int kDirections = 100;
    std::vector<Vec3f> outline;
    if (points.empty()) return outline;
    const Eigen::Map<const Eigen::Matrix3Xf> all(points.data(), 3, long(points.size() / 3));
    for (int i = 0; i < kDirections; ++i) {
        // A Fibonacci lattice on the sphere.
        const double z = 1 - (2 * i + 1.) / kDirections, r = std::sqrt(1 - z * z);
        const double phi = 2 * std::numbers::pi * i / std::numbers::phi;
        const Vec3f d(float(r * std::cos(phi)), float(r * std::sin(phi)), float(z));
        long farthest = 0;
        (d.transpose() * all).maxCoeff(&farthest);
        outline.push_back(all.col(farthest));
    }
    return outline;
}

Framing::Framing(double azimuth, double elevation, const std::array<double, 2>& seen)
    : tangents(seen), nearest(-kInfinite), farthest(kInfinite) {
    constexpr double kDegree = std::numbers::pi / 180;
    const double a = azimuth * kDegree, e = elevation * kDegree;
    axes.col(2) =
        Eigen::Vector3d(std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a));
    axes.col(0) = Eigen::Vector3d(std::cos(a), 0, -std::sin(a));
    axes.col(1) = axes.col(2).cross(axes.col(0));
    for (double& tangent : tangents) tangent *= 1 - 2 * kMargin;
    for (auto& side : reach) side = {-kInfinite, -kInfinite};
}

void Framing::Extend(const Vec3f& point) {
    const Eigen::Vector3d p = axes.transpose() * point.cast<double>();
    for (int i = 0; i < 2; ++i)
        for (int side = 0; side < 2; ++side) {
            double& most = reach[size_t(i)][size_t(side)];
            most = std::max(most, (side == 0 ? -p[i] : p[i]) + tangents[size_t(i)] * p.z());
        }
    nearest = std::max(nearest, p.z());
    farthest = std::min(farthest, p.z());
}

Mat4d Framing::WorldFromCamera() const {
    if (!(nearest >= farthest)) {
        Framing ball = *this;
        for (int i = 0; i < 6; ++i) ball.Extend((i % 2 ? 1.f : -1.f) * Vec3f(Vec3f::Unit(i / 2)));
        return ball.WorldFromCamera();
    }
    Eigen::Vector3d at;
    double extent = nearest - farthest;
    at.z() = -kInfinite;
    for (int i = 0; i < 2; ++i) {
        const auto& [low, high] = reach[size_t(i)];
        at[i] = (high - low) / 2;
        const double wanted = (high + low) / (2 * tangents[size_t(i)]);
        at.z() = std::max(at.z(), wanted);
        extent = std::max(extent, wanted - nearest);
    }
    // Flat objects and points must not be at the camera.
    at.z() = std::max(at.z(), nearest + std::max(0.1 * extent, 1e-6));
    Mat4d m = Mat4d::Identity();
    m.topLeftCorner<3, 3>() = axes;
    m.col(3).head<3>() = axes * at;
    return m;
}

}  // namespace lull
