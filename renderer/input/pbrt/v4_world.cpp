// Textures, shapes and media of pbrt-v4.

#include <fmt/format.h>

#include "renderer/input/pbrt/v4.h"
#include "stopping/base/input_file.h"

namespace lull {
namespace {

void CopyMapping(V4Reader* in) {
    in->Copy(ParameterType::String, {"mapping"});
    in->Copy(ParameterType::Float, {"uscale", "vscale", "udelta", "vdelta"});
    in->Copy(ParameterType::Vector3, {"v1", "v2"});
}

void CopyOperand(V4Reader* in, const char* name, bool isSpectrum, float otherwise,
                 const char* to = nullptr) {
    if (!to) to = name;
    if (const TextureRef* texture = in->given.GetTexture(name))
        in->write.Texture(to, *texture);
    else if (isSpectrum)
        in->write.Spectrum(to, in->Surface(name, Rgb::Constant(otherwise)));
    else
        in->write.Float(to, in->given.GetFloat(name, otherwise));
}

void CopyImage(V4Reader* in, bool isSpectrum) {
    CopyMapping(in);
    in->Copy(ParameterType::String, {"filename"});
    in->Copy(ParameterType::Float, {"scale"});
    in->Copy(ParameterType::Bool, {"invert"});
    in->Ignore({"filter", "maxanisotropy"});
    std::string wrap = in->given.GetString("wrap", "repeat");
    if (wrap == "octahedralsphere") {
        in->Warn("wrap \"octahedralsphere\" is replaced by \"repeat\"");
        wrap = "repeat";
    }
    in->write.String("wrap", wrap);
    in->write.String("encoding", in->given.GetString("encoding", "sRGB"));
    if (!isSpectrum) in->write.String("channel", "mean or alpha");
}

// Multiplies a texture by another. An image's factor is that of its texels, before inversion.
Entity TranslateScale(V4Reader& in, bool isSpectrum, const std::string& owner) {
    const TextureRef* texture = in.given.GetTexture("tex");
    const int index = !texture ? -1 : isSpectrum ? texture->spectrumIndex : texture->floatIndex;
    const float factor = in.given.GetFloat("scale", 1);
    if (index >= 0 && !in.given.GetTexture("scale")) {
        const TextureEntity& image = in.Context().description.textures[size_t(index)];
        if (image.name == "imagemap") {
            Entity copy = image;
            in.Finish("", owner);
            const float scale = factor * image.parameters.GetFloat("scale", 1);
            copy.loc = in.Loc();
            ParameterWriter(&copy.parameters, in.Loc()).Float("scale", scale);
            return copy;
        }
    }
    // (1 - s) 0 + s tex.
    if (isSpectrum)
        in.write.Spectrum("tex1", Rgb::Zero());
    else
        in.write.Float("tex1", 0.f);
    CopyOperand(&in, "tex", isSpectrum, 1, "tex2");
    CopyOperand(&in, "scale", false, 1, "amount");
    return in.Finish("mix", owner);
}

}  // namespace

Entity TranslateTexture(V4Reader& in) {
    const bool isSpectrum = in.Context().kind == EntityKind::SpectrumTexture;
    const std::string kind = in.Name(), owner = "texture \"" + Printable(kind) + "\"";
    const auto operands = [&](std::initializer_list<const char*> names, float first) {
        for (const char* name : names) {
            CopyOperand(&in, name, isSpectrum, first);
            first = 1 - first;
        }
    };
    if (kind == "scale") return TranslateScale(in, isSpectrum, owner);
    if (kind == "constant") {
        operands({"value"}, 1);
    } else if (kind == "mix") {
        operands({"tex1", "tex2"}, 0);
        CopyOperand(&in, "amount", false, 0.5f);
    } else if (kind == "directionmix") {
        operands({"tex1", "tex2"}, 0);
        const Vec3f dir = in.given.GetVector3("dir", Vec3f::UnitY());
        in.write.Floats(ParameterType::Vector3, "dir", {dir.x(), dir.y(), dir.z()});
    } else if (kind == "imagemap") {
        CopyImage(&in, isSpectrum);
    } else if (kind == "bilerp") {
        CopyMapping(&in);
        operands({"v00", "v01", "v10", "v11"}, 0);
    } else if (kind == "checkerboard") {
        CopyMapping(&in);
        in.Copy(ParameterType::Integer, {"dimension"});
        operands({"tex1", "tex2"}, 1);
    } else if (kind == "dots") {
        CopyMapping(&in);
        operands({"inside", "outside"}, 1);
    } else if (kind == "fbm" || kind == "wrinkled" || (kind == "marble" && isSpectrum)) {
        in.Copy(ParameterType::Integer, {"octaves"});
        in.Copy(ParameterType::Float, {"roughness", "scale", "variation"});
    } else if (kind != "windy") {
        in.Fail(fmt::format("{} texture \"{}\" is not supported", isSpectrum ? "spectrum" : "float",
                            Printable(kind)));
    }
    return in.Finish(kind, owner);
}

namespace {

using Corners = std::array<Vec3f, 4>;

template <typename Vector>
std::vector<Vector> Vectors(const V4Reader& in, ParameterType type, const char* name) {
    constexpr int n = Vector::RowsAtCompileTime;
    const auto values = in.given.GetFloats(type, name);
    std::vector<Vector> vectors(values.size() / n);
    for (size_t i = 0; i < vectors.size(); ++i)
        vectors[i] = Eigen::Map<const Vector>(values.data() + n * i);
    return vectors;
}

// Returns whether the corners p00, p10, p01, p11 lie in a plane, but for rounding.
bool IsPlanar(const Corners& p) {
    const Vec3f n = (p[1] - p[0]).cross(p[2] - p[0]);
    return std::abs(n.dot(p[3] - p[0])) <= 1e-5f * n.norm() * (p[3] - p[0]).norm();
}

template <typename T>
T Bilinear(const std::array<T, 4>& c, float u, float v) {
    return (1 - u) * (1 - v) * c[0] + u * (1 - v) * c[1] + (1 - u) * v * c[2] + u * v * c[3];
}

// Cuts bilinear patches into triangles, 2 where one is flat, and 128 otherwise.
Entity TranslatePatches(V4Reader& in) {
    constexpr int kCurvedSteps = 8;
    const auto p = Vectors<Vec3f>(in, ParameterType::Point3, "P");
    const auto n = Vectors<Vec3f>(in, ParameterType::Normal, "N");
    const auto uv = Vectors<Vec2f>(in, ParameterType::Point2, "uv");
    std::vector<int> indices(in.given.GetInts("indices").begin(),
                             in.given.GetInts("indices").end());
    if (indices.empty() && p.size() == 4) indices = {0, 1, 2, 3};
    if (indices.empty() || indices.size() % 4 != 0)
        in.Fail("a bilinearmesh needs four \"indices\" for each patch");
    if (!in.given.GetString("emissionfilename", "").empty())
        in.Warn("\"emissionfilename\" of a bilinearmesh has no effect on its emission");
    in.Ignore({"faceIndices"});
    const bool hasNormals = !n.empty() && n.size() == p.size();
    struct Patch {
        Corners p, n;
        std::array<Vec2f, 4> uv = {Vec2f(0, 0), Vec2f(1, 0), Vec2f(0, 1), Vec2f(1, 1)};
        bool isPlanar = false;
    };
    std::vector<Patch> patches(indices.size() / 4);
    bool isPlanar = true;
    for (size_t i = 0; i < indices.size(); ++i) {
        Patch& patch = patches[i / 4];
        const int index = indices[i];
        if (index < 0 || size_t(index) >= p.size())
            in.Fail(
                fmt::format("index {} is out of range: the mesh has {} vertices", index, p.size()));
        patch.p[i % 4] = p[size_t(index)];
        if (hasNormals) patch.n[i % 4] = n[size_t(index)];
        if (uv.size() == p.size()) patch.uv[i % 4] = uv[size_t(index)];
        if (i % 4 == 3) patch.isPlanar = IsPlanar(patch.p);
        isPlanar &= i % 4 != 3 || patch.isPlanar;
    }
    std::vector<float> points, normals, uvs;
    std::vector<int> triangles;
    const auto put = [](const auto& v, std::vector<float>* to) {
        to->insert(to->end(), v.data(), v.data() + v.size());
    };
    for (const Patch& patch : patches) {
        const int steps = patch.isPlanar ? 1 : kCurvedSteps, first = int(points.size() / 3);
        for (int y = 0; y <= steps; ++y)
            for (int x = 0; x <= steps; ++x) {
                const float u = float(x) / float(steps), v = float(y) / float(steps);
                const Corners& c = patch.p;
                put(Vec3f(Bilinear(c, u, v)), &points);
                put(Vec2f(Bilinear(patch.uv, u, v)), &uvs);
                if (hasNormals)
                    put(Vec3f(Bilinear(patch.n, u, v)), &normals);
                else if (!isPlanar)
                    put(Vec3f(((1 - v) * (c[1] - c[0]) + v * (c[3] - c[2]))
                                  .cross((1 - u) * (c[2] - c[0]) + u * (c[3] - c[1]))),
                        &normals);
            }
        for (int y = 0; y < steps; ++y)
            for (int x = 0; x < steps; ++x) {
                const int a = first + y * (steps + 1) + x, c = a + steps + 1;
                triangles.insert(triangles.end(), {a, a + 1, c + 1, a, c + 1, c});
            }
    }
    in.write.Floats(ParameterType::Point3, "P", std::move(points));
    in.write.Floats(ParameterType::Point2, "uv", std::move(uvs));
    in.write.Ints("indices", std::move(triangles));
    if (!normals.empty()) in.write.Floats(ParameterType::Normal, "N", std::move(normals));
    return in.Finish("trianglemesh", "Shape \"bilinearmesh\"");
}

void CopyAlpha(V4Reader* in) {
    const float alpha = in->given.GetFloat("alpha", 1);
    if (const TextureRef* texture = in->given.GetTexture("alpha"))
        in->write.Texture("coverage", *texture);
    else if (alpha <= 0)
        in->write.Bool("invisible", true);
    else if (alpha < 1)
        in->write.Float("coverage", alpha);
}

}  // namespace

Entity TranslateShape(V4Reader& in) {
    const std::string& kind = in.Name();
    CopyAlpha(&in);
    if (kind == "bilinearmesh") return TranslatePatches(in);
    if (kind == "trianglemesh") {
        // Three points are a triangle.
        if (!in.given.Find(ParameterType::Integer, "indices") &&
            in.given.GetFloats(ParameterType::Point3, "P").size() == 9)
            in.write.Ints("indices", {0, 1, 2});
        in.Move(ParameterType::Integer, {"indices", "faceIndices"});
        in.Move(ParameterType::Point3, {"P"});
        in.Move(ParameterType::Point2, {"uv"});
        in.Move(ParameterType::Normal, {"N"});
        in.Ignore({"S"});
    } else if (kind == "plymesh") {
        in.Copy(ParameterType::String, {"filename"});
        if (in.given.GetTexture("displacement"))
            in.Fail(
                "\"displacement\" of a plymesh is not supported; displace the mesh itself, or "
                "use the material's \"displacement\", which tilts its normals");
        in.Ignore({"edgelength"});
    } else if (kind == "loopsubdiv") {
        in.Move(ParameterType::Integer, {"levels", "indices"});
        in.Move(ParameterType::Point3, {"P"});
        in.Copy(ParameterType::String, {"scheme"});
    } else if (kind == "sphere" || kind == "cylinder" || kind == "disk") {
        in.Copy(ParameterType::Float,
                {"radius", "zmin", "zmax", "phimax", "height", "innerradius"});
    } else if (kind == "curve") {
        in.Copy(ParameterType::Point3, {"P"});
        in.Copy(ParameterType::Normal, {"N"});
        in.Copy(ParameterType::String, {"type", "basis"});
        in.Copy(ParameterType::Integer, {"degree", "splitdepth"});
        in.Copy(ParameterType::Float, {"width", "width0", "width1", "splitdepth"});
    } else {
        in.Fail(
            fmt::format("Shape \"{}\" is not supported in pbrt-v4; sphere, cylinder, disk, "
                        "trianglemesh, bilinearmesh, loopsubdiv, plymesh and curve are",
                        Printable(kind)));
    }
    return in.Finish(kind, "Shape \"" + kind + "\"");
}

Entity TranslateMedium(V4Reader& in) {
    const std::string& kind = in.Name();
    const std::string owner = "medium \"" + Printable(kind) + "\"";
    in.given.GetString("type", "");
    const bool isHomogeneous = kind == "homogeneous", isRgb = kind == "rgbgrid";
    const bool isGrid = kind == "uniformgrid", isCloud = kind == "cloud", isVdb = kind == "nanovdb";
    if (!isHomogeneous && !isGrid && !isRgb && !isCloud && !isVdb)
        in.Fail(
            fmt::format("{} is unknown; cloud, homogeneous, nanovdb, rgbgrid and uniformgrid "
                        "are",
                        owner));
    in.Copy(ParameterType::Float, {"g"});
    if (!isCloud) in.Copy(ParameterType::Float, {"scale"});
    if (!isHomogeneous && !isVdb) in.Copy(ParameterType::Point3, {"p0", "p1"});
    if (isGrid || isRgb) in.Copy(ParameterType::Integer, {"nx", "ny", "nz"});
    if (isRgb) {
        in.Copy(ParameterType::Spectrum, {"sigma_a", "sigma_s", "Le"});
        in.Copy(ParameterType::Float, {"Lescale"});
        if (!in.given.Find(ParameterType::Spectrum, "sigma_a") &&
            (in.given.Find(ParameterType::Spectrum, "Le") ||
             !in.given.Find(ParameterType::Spectrum, "sigma_s")))
            in.Fail(owner + " needs \"rgb sigma_a\", or without \"Le\" only \"rgb sigma_s\"");
        return in.Finish(kind, owner);
    }
    if (in.given.Find(ParameterType::String, "preset") && isHomogeneous) {
        in.Copy(ParameterType::String, {"preset"});
    } else {
        in.write.Spectrum("sigma_a", in.Surface("sigma_a", Rgb::Ones()));
        in.write.Spectrum("sigma_s", in.Surface("sigma_s", Rgb::Ones()));
    }
    if (isCloud) {
        in.Copy(ParameterType::Float, {"density", "wispiness", "frequency"});
        return in.Finish(kind, owner);
    }
    if (isVdb || isGrid) {
        in.Copy(ParameterType::Float, "temperaturecutoff", "temperatureoffset");
        in.Copy(ParameterType::Float, {"temperatureoffset", "temperaturescale", "Lescale"});
    }
    if (isVdb) {
        in.Copy(ParameterType::String, {"filename", "gridname", "temperaturename"});
        if (!in.given.Find(ParameterType::String, "filename"))
            in.Fail(owner + " needs \"string filename\"");
        return in.Finish(kind, owner);
    }
    const float LeScale = isHomogeneous ? in.given.GetFloat("Lescale", 1) : 1;
    const Rgb Le = in.Light("Le", Rgb::Zero()) * LeScale;
    if (!IsBlack(Le)) in.write.Spectrum("emission", Le);
    if (isHomogeneous) return in.Finish(kind, owner);
    in.Copy(ParameterType::Float, {"density", "temperature"});
    if (in.Spectrum("Le") && in.given.Find(ParameterType::Float, "temperature"))
        in.Fail(owner + " has both \"Le\" and \"temperature\"");
    return in.Finish("heterogeneous", owner);
}

}  // namespace lull
