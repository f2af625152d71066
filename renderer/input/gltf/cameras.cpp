#include "renderer/input/gltf/cameras.h"

#include <fmt/format.h>

#include "renderer/base/rounding.h"
#include "renderer/input/gltf/choice.h"
#include "renderer/input/gltf/parameters.h"

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

void SetFilm(double aspect, const FileLoc& loc, Description* description) {
    const ParameterWriter film(&description->film.parameters, loc);
    film.Int("xresolution", int(std::clamp(std::round(kHeight * aspect), 1.0, 16.0 * kHeight)));
    film.Int("yresolution", kHeight);
}

// Sets a camera that shows the plane at distance 1 from -x to x and -y to y, whatever aspect the
// image gets. The usual one is x / y; where the file has none, `x` is 0, and only y is fixed.
void SetCamera(const char* projection, double x, double y, const FileLoc& loc,
               Description* description) {
    description->camera = {projection, {}, loc};
    ParameterWriter(&description->camera.parameters, loc)
        .Floats(ParameterType::Float, "screenfit", {float(x), float(y)});
    SetFilm(x > 0 ? x / y : kDefaultAspect, loc, description);
}

// Takes the vertical field of view in radians, and the aspect or 0.
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
            throw Error(loc, fmt::format("yfov is {}; it has to lie between 0 and pi", p.yfov));
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

}  // namespace lull
