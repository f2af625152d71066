#include "renderer/scene/geometry/shapes/shape_factory.h"

#include <fmt/format.h>
#include <Eigen/SVD>

#include "renderer/input/loop_subdivision.h"
#include "renderer/input/ply_loader.h"
#include "renderer/input/spectrum.h"
#include "renderer/scene/kinds.h"
#include "stopping/base/input_file.h"

namespace lull {
namespace {

template <typename Vector>
std::vector<Vector> VectorsOf(std::span<const float> values) {
    constexpr int n = Vector::RowsAtCompileTime;
    std::vector<Vector> vectors(values.size() / n);
    for (size_t i = 0; i < vectors.size(); ++i)
        vectors[i] = Eigen::Map<const Vector>(values.data() + n * i);
    return vectors;
}

std::vector<std::array<uint32_t, 3>> TrianglesOf(const ShapeEntity& entity, size_t vertexCount) {
    const auto indices = entity.parameters.GetInts("indices");
    if (indices.empty() || indices.size() % 3 != 0)
        throw Error(entity.loc, "\"indices\" has {} values; a mesh needs three for each triangle{}",
                    indices.size(), entity.parameters.Mistyped("indices"));
    std::vector<std::array<uint32_t, 3>> triangles(indices.size() / 3);
    for (size_t i = 0; i < indices.size(); ++i) {
        if (indices[i] < 0 || size_t(indices[i]) >= vertexCount)
            throw Error(entity.loc, "index {} is out of range: the mesh has {} vertices",
                        indices[i], vertexCount);
        triangles[i / 3][i % 3] = uint32_t(indices[i]);
    }
    return triangles;
}

std::vector<Vec3f> PositionsOf(const ShapeEntity& entity) {
    const auto positions =
        VectorsOf<Vec3f>(entity.parameters.GetFloats(ParameterType::Point3, "P"));
    if (positions.empty())
        throw Error(entity.loc, "the mesh has no vertices: \"point P\" is missing" +
                                    entity.parameters.Mistyped("P"));
    return positions;
}

MeshData TriangleMesh(const ShapeEntity& entity, Warnings& warnings) {
    const Parameters& params = entity.parameters;
    MeshData data;
    data.positions = PositionsOf(entity);
    data.triangles = TrianglesOf(entity, data.positions.size());
    // Texture coordinates come under two names and two types.
    for (const char* name : {"uv", "st"})
        for (const ParameterType type : {ParameterType::Point2, ParameterType::Float})
            if (data.uvs.empty()) data.uvs = VectorsOf<Vec2f>(params.GetFloats(type, name));
    if (data.uvs.size() < data.positions.size()) {
        if (!data.uvs.empty())
            warnings.Add(entity.loc, "too few \"uv\" for the mesh; they are left out");
        data.uvs.clear();
    } else {
        data.uvs.resize(data.positions.size());
    }
    data.normals = VectorsOf<Vec3f>(params.GetFloats(ParameterType::Normal, "N"));
    if (!data.normals.empty() && data.normals.size() != data.positions.size()) {
        warnings.Add(entity.loc, "as many \"N\" as \"P\" are needed; the normals are left out");
        data.normals.clear();
    }
    params.GetInts("faceIndices");  // only Ptex reads them
    return data;
}

std::vector<std::array<float, 4>> FoursOf(const ShapeEntity& entity, const char* name,
                                          size_t vertexCount) {
    const auto values = entity.parameters.GetFloats(ParameterType::Float, name);
    if (values.size() != 4 * vertexCount) return {};
    std::vector<std::array<float, 4>> fours(vertexCount);
    for (size_t i = 0; i < values.size(); ++i) fours[i / 4][i % 4] = values[i];
    return fours;
}

MeshData SubdividedMesh(const ShapeEntity& entity) {
    const Parameters& params = entity.parameters;
    const int levels = params.GetInt("levels", params.GetInt("nlevels", 3));
    params.GetString("scheme", "loop");
    return LoopSubdivide(params.GetFloats(ParameterType::Point3, "P"), params.GetInts("indices"),
                         levels, entity.loc);
}

// Reads attributes of glTF's meshes alone, four numbers a vertex and two of the second texture
// coordinates: "color", "tangent", "uv1".
void ReadExtraAttributes(const ShapeEntity& entity, size_t vertexCount, Mesh* mesh) {
    mesh->colors = FoursOf(entity, "color", vertexCount);
    mesh->tangents = FoursOf(entity, "tangent", vertexCount);
    const auto uv1 = entity.parameters.GetFloats(ParameterType::Float, "uv1");
    if (uv1.size() == 2 * vertexCount) mesh->uv1 = VectorsOf<Vec2f>(uv1);
    for (auto& t : mesh->tangents) {
        const Vec3f along = TransformVector(entity.worldFromObject, Vec3f(t[0], t[1], t[2]));
        // A mirror turns the cross product of normal and tangent round, not the other tangent.
        t = {along.x(), along.y(), along.z(), Mirrors(entity.worldFromObject) ? -t[3] : t[3]};
    }
}

// Carries the mesh to its place and drops triangles without area.
Mesh PlaceMesh(MeshData data, const ShapeEntity& entity, Warnings& warnings) {
    const Mat4d& m = entity.worldFromObject;
    const Mat4d inverse = m.inverse();
    Mesh mesh;
    mesh.reverseOrientation = entity.reverseOrientation;
    mesh.flipNormals = entity.reverseOrientation != Mirrors(m);
    mesh.frontByWinding = entity.parameters.GetBool("frontbywinding", false);  // as in glTF
    for (Vec3f& p : data.positions) p = TransformPoint(m, p);
    for (const auto& triangle : data.triangles)  // other vertices may be anywhere
        for (const uint32_t v : triangle)
            if (!data.positions[v].allFinite())
                throw Error(entity.loc, "vertex {} is not finite once transformed", v);
    for (Vec3f& n : data.normals) n = TransformNormal(inverse, n);
    ReadExtraAttributes(entity, data.positions.size(), &mesh);
    mesh.p = std::move(data.positions);
    mesh.triangles = std::move(data.triangles);
    std::erase_if(mesh.triangles, [&](const auto& v) {
        const Vec3f &p0 = mesh.p[v[0]], &p1 = mesh.p[v[1]], &p2 = mesh.p[v[2]];
        const float twiceArea = LengthOf((p1 - p0).cross(p2 - p0));
        if (std::isfinite(twiceArea) && std::isfinite(2 / twiceArea)) return false;
        warnings.AddMinor(entity.loc, "zero-area triangle left out");
        return true;
    });
    mesh.SetCorners(data.normals, data.uvs);
    mesh.p.push_back(Vec3f::Zero());  // the accelerator reads past the last vertex
    return mesh;
}

float PhiMaxOf(const Parameters& params) {
    return std::clamp(params.GetFloat("phimax", 360), 0.f, 360.f) * kPi / 180;
}

Sphere MakeSphere(const ShapeEntity& entity) {
    const Parameters& params = entity.parameters;
    Sphere sphere;
    float scale;
    sphere.place = PlacementOf(entity, &scale);
    const float r = params.GetFloat("radius", 1);
    if (!(r > 0) || !std::isfinite(r))
        throw Error(entity.loc, "a sphere's radius has to be positive; it is {}", r);
    const float z0 = params.GetFloat("zmin", -r), z1 = params.GetFloat("zmax", r);
    sphere.radius = scale * r;
    sphere.zMin = scale * std::clamp(std::min(z0, z1), -r, r);
    sphere.zMax = scale * std::clamp(std::max(z0, z1), -r, r);
    sphere.phiMax = PhiMaxOf(params);
    if (!(sphere.Area() > 0))
        throw Error(entity.loc, "the sphere has no area left by its clipping");
    return sphere;
}

Disk MakeDisk(const ShapeEntity& entity) {
    const Parameters& params = entity.parameters;
    Disk disk;
    float scale;
    disk.place = PlacementOf(entity, &scale);
    disk.height = scale * params.GetFloat("height", 0);
    disk.radius = scale * params.GetFloat("radius", 1);
    disk.innerRadius = scale * GetNonnegative(entity, "innerradius", 0);
    disk.phiMax = PhiMaxOf(params);
    if (!(disk.radius > 0) || !(disk.Area() > 0))
        throw Error(entity.loc, "the disk has no area; \"radius\" has to be above \"innerradius\"");
    return disk;
}

Revolved MakeRevolved(const ShapeEntity& entity) {
    const Parameters& params = entity.parameters;
    if (entity.areaLight && entity.name != "cylinder")
        throw Error(
            entity.loc,
            "a light of shape \"{}\" is not supported; pbrt-v3 cannot sample it either, a mesh is",
            entity.name);
    float scale;
    const QuadricPlacement place = PlacementOf(entity, &scale);
    const float phiMax = PhiMaxOf(params);
    const auto size = [&](const char* name, float otherwise) {
        return scale * params.GetFloat(name, otherwise);
    };
    Revolved shape;
    if (entity.name == "cylinder") {
        shape = MakeCylinder(size("radius", 1), size("zmin", -1), size("zmax", 1), phiMax);
    } else if (entity.name == "cone") {
        shape = MakeCone(size("radius", 1), size("height", 1), phiMax);
        if (shape.end.z() <= 0) throw Error(entity.loc, "a cone's \"height\" has to be positive");
    } else if (entity.name == "paraboloid") {
        shape = MakeParaboloid(size("radius", 1), size("zmin", 0), size("zmax", 1), phiMax);
    } else {
        shape = MakeHyperboloid(scale * params.GetPoint3("p1", Vec3f(0, 0, 0)),
                                scale * params.GetPoint3("p2", Vec3f(1, 1, 1)), phiMax);
    }
    shape.place = place;
    if (!HasArea(shape))
        throw Error(entity.loc,
                    "the {} has no area; its sizes and the range of its heights have to be "
                    "positive and finite",
                    entity.name);
    return shape;
}

// Reads an alpha parameter, in which only 0 matters: such points are cut out.
std::optional<FloatTexture> ReadAlpha(const TextureTable& textures, const ShapeEntity& entity,
                                      const char* name) {
    if (entity.parameters.GetBool("invisible", false)) return FloatTexture{0};
    FloatTexture alpha = textures.GetFloat(entity, name, 1);
    if (alpha.IsConstant()) alpha.constant = RaisedToZero(alpha.constant);
    if (alpha.IsConstant() && alpha.constant != 0) return {};
    return alpha;
}

// Reads "coverage", the share of the mesh that is there, times "coveragefactor" and, with
// "coveragecolors", the alpha of the vertices' colours; "alphacutoff" makes it all or nothing. With
// "openbehind" rays from behind pass, with "singlesided" those of the camera. Nothing is returned
// where all of it is there.
std::optional<Coverage> ReadCoverage(const TextureTable& textures, const ShapeEntity& entity) {
    const Parameters& params = entity.parameters;
    // An alpha that was rounded to just below the cutoff is not below it.
    const float cutoff = params.GetFloat("alphacutoff", -1) * float(1 - kRounding);
    Coverage coverage{textures.GetFloat(entity, "coverage", 1),
                      params.GetFloat("coveragefactor", 1),
                      cutoff,
                      params.GetInt("coverageuv", 0) == 1,
                      params.GetBool("coveragecolors", false),
                      params.GetBool("openbehind", false),
                      params.GetBool("singlesided", false)};
    if (!coverage.IsWhole()) return coverage;
    if (!coverage.openBehind && !coverage.singleSided) return {};
    coverage.factor = 1;
    return coverage;
}

struct ShapeReader {
    const Description& description;
    const ShapeEntity& entity;
    const TextureTable& textures;
    Warnings& warnings;
};

Shape MakeCutOutMesh(const ShapeReader& in, MeshData data) {
    return {.geometry = PlaceMesh(std::move(data), in.entity, in.warnings),
            .alpha = ReadAlpha(in.textures, in.entity, "alpha"),
            .shadowAlpha = ReadAlpha(in.textures, in.entity, "shadowalpha"),
            .coverage = ReadCoverage(in.textures, in.entity)};
}

Shape MakePlyMesh(const ShapeReader& in) {
    const std::string file = in.entity.parameters.GetString("filename", "");
    if (file.empty()) throw Error(in.entity.loc, "plymesh needs a \"filename\"");
    MeshData mesh;
    try {
        mesh = LoadPly(ResolvePath(in.description, file), in.warnings, in.entity.loc);
    } catch (const Error& error) {
        in.warnings.Substitute(error, "the mesh is left out");
        return {};
    }
    if (mesh.triangles.empty()) return {};
    return MakeCutOutMesh(in, std::move(mesh));
}
Shape MakeTriangleMesh(const ShapeReader& in) {
    return MakeCutOutMesh(in, TriangleMesh(in.entity, in.warnings));
}
Shape MakeSubdividedMesh(const ShapeReader& in) {
    return MakeCutOutMesh(in, SubdividedMesh(in.entity));
}

// Makes a shape that is no mesh, of which parts may be missing in scenes for pbrt-v4.
template <typename Geometry>
Shape MakeCovered(const ShapeReader& in, Geometry geometry) {
    Shape shape{.geometry = std::move(geometry)};
    if (in.entity.parameters.GetBool("invisible", false)) shape.alpha = FloatTexture{0};
    shape.coverage = ReadCoverage(in.textures, in.entity);
    return shape;
}

// Adapt makers to the table of kinds.
template <auto Make>
Shape MakePatches(const ShapeReader& in) {
    return {.geometry = PlaceMesh(Make(in.entity), in.entity, in.warnings)};
}
bool IsOneSidedLight(const ShapeEntity& entity) {
    return entity.areaLight && entity.areaLight->name == "diffuse" &&
           !entity.areaLight->parameters.GetBool("twosided", false);
}
// Returns whether light that passes the surface differs by the side that it comes from.
bool HasAnInside(const Description& description, const ShapeEntity& entity) {
    if (entity.insideMedium != entity.outsideMedium) return true;
    if (entity.material < 0) return false;
    const MaterialEntity& material = description.materials[size_t(entity.material)];
    return material.name == "glass" || material.name == "subsurface" ||
           material.name == "kdsubsurface";
}

template <auto Make>
Shape MakeSolid(const ShapeReader& in) {
    const ShapeEntity& entity = in.entity;
    if (Mirrors(entity.worldFromObject) && IsOneSidedLight(entity))
        in.warnings.Add(entity.loc,
                        "a mirrored sphere, disk or cylinder is seen to shine to one side, and "
                        "lights the other, as in pbrt-v3; use a mesh, or no mirroring transform",
                        entity.name);
    if (Mirrors(entity.worldFromObject) && !entity.reverseOrientation &&
        HasAnInside(in.description, entity))
        in.warnings.Add(entity.loc,
                        "a mirrored quadric is inside out, as in pbrt-v3; add ReverseOrientation, "
                        "or use no mirroring transform",
                        entity.name);
    return MakeCovered(in, Make(entity));
}
Shape MakeCurves(const ShapeReader& in) {
    return MakeCovered(in, ReadCurves(in.entity, in.warnings));
}

constexpr Kind<Shape(const ShapeReader&)> kShapes[] = {
    {"plymesh", MakePlyMesh},
    {"trianglemesh", MakeTriangleMesh},
    {"loopsubdiv", MakeSubdividedMesh},
    {"heightfield", MakePatches<HeightfieldMesh>},
    {"nurbs", MakePatches<NurbsMesh>},
    {"sphere", MakeSolid<MakeSphere>},
    {"disk", MakeSolid<MakeDisk>},
    {"cylinder", MakeSolid<MakeRevolved>},
    {"cone", MakeSolid<MakeRevolved>},
    {"paraboloid", MakeSolid<MakeRevolved>},
    {"hyperboloid", MakeSolid<MakeRevolved>},
    {"curve", MakeCurves},
};

// Replaces the linear part by the nearest rotation, mirrored where it mirrors, and returns its mean
// scale. Nothing is returned where it stretches by more than matrices of three decimals do.
std::optional<float> TakeNearestScale(Mat4d* m) {
    constexpr double kMostStretch = 5e-3;
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m->topLeftCorner<3, 3>(),
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Vector3d scales = svd.singularValues();  // the largest first
    if (!(scales[0] - scales[2] <= kMostStretch * scales[0])) return {};
    m->topLeftCorner<3, 3>() = svd.matrixU() * svd.matrixV().transpose();
    return float(scales.mean());
}

}  // namespace

Shape MakeShape(const Description& description, const ShapeEntity& entity,
                const TextureTable& textures, Warnings& warnings) {
    Shape shape;
    if (const auto* kind = FindKind(kShapes, entity.name)) {
        shape = kind->make({description, entity, textures, warnings});
        if (entity.parameters.GetBool("hiddenfromcamera", false)) shape.hiddenFrom |= kCameraRay;
        if (entity.parameters.GetBool("castsnoshadow", false)) shape.hiddenFrom |= kShadowRay;
        entity.parameters.ReportUnused("Shape \"" + entity.name + "\"", warnings);
    } else {
        warnings.Substitute(entity.loc,
                            fmt::format("Shape \"{}\" is not supported; {} are",
                                        Printable(entity.name), NamesOf(kShapes)),
                            "it is left out");
    }
    shape.material = entity.material;
    return shape;
}

bool Mirrors(const Mat4d& m) { return m.topLeftCorner<3, 3>().determinant() < 0; }

std::optional<float> TakeScale(Mat4d* m) {
    auto linear = m->topLeftCorner<3, 3>();
    const double scale = linear.col(0).norm();
    if (!(linear.transpose() * linear).isApprox(scale * scale * Eigen::Matrix3d::Identity(), 1e-4))
        return {};
    linear /= scale;
    return float(scale);
}

QuadricPlacement PlacementOf(const ShapeEntity& entity, float* scale) {
    Mat4d m = entity.worldFromObject;
    std::optional<float> taken = TakeScale(&m);
    if (!taken && entity.areaLight) taken = TakeNearestScale(&m);
    if (!taken && entity.areaLight)
        throw Error(entity.loc,
                    "a light of shape \"{}\" under a transform that stretches it is not supported; "
                    "a mesh is",
                    entity.name);
    *scale = taken.value_or(1);
    return {m, m.inverse(), entity.reverseOrientation, entity.reverseOrientation != Mirrors(m)};
}

}  // namespace lull
