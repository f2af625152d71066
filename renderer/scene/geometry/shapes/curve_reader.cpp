#include <fmt/format.h>

#include "renderer/input/spectrum.h"
#include "renderer/scene/geometry/shapes/shape_factory.h"
#include "stopping/base/input_file.h"

namespace lull {
namespace {

constexpr int kMaxSplitDepth = 10;

CurveKind ReadKind(const Entity& entity) {
    const std::string kind = entity.parameters.GetString("type", "flat");
    if (kind == "flat") return CurveKind::Flat;
    if (kind == "cylinder") return CurveKind::Cylinder;
    if (kind == "ribbon") return CurveKind::Ribbon;
    throw Error(entity.loc,
                "curves of type \"{}\" are not supported; flat, cylinder and ribbon are",
                Printable(kind));
}

int ReadSplitDepth(const Entity& entity) {
    // pbrt-v3 takes it of either type.
    const int depth = entity.parameters.GetInt(
        "splitdepth", int(std::clamp(entity.parameters.GetFloat("splitdepth", 3), -1.f, 99.f)));
    if (depth < 0 || depth > kMaxSplitDepth)
        throw Error(entity.loc, "\"splitdepth\" is {}; it has to be between 0 and {}", depth,
                    kMaxSplitDepth);
    return depth;
}

std::array<Vec3f, 4> Elevated(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    return {a, Between(2.f / 3, a, b), Between(1.f / 3, b, c), c};
}

struct Basis {
    bool isSpline;
    int degree;

    std::optional<size_t> PieceCount(size_t n) const {
        if (n < size_t(degree) + 1 || (!isSpline && (n - 1) % degree != 0)) return {};
        return isSpline ? n - degree : (n - 1) / degree;
    }

    std::array<Vec3f, 4> Piece(const std::vector<Vec3f>& points, size_t i) const {
        const Vec3f* p = &points[isSpline ? i : i * degree];
        if (!isSpline && degree == 3) return {p[0], p[1], p[2], p[3]};
        if (!isSpline) return Elevated(p[0], p[1], p[2]);
        if (degree == 2) return Elevated((p[0] + p[1]) / 2, p[1], (p[1] + p[2]) / 2);
        const Vec3f b = Between(1.f / 3, p[1], p[2]), c = Between(2.f / 3, p[1], p[2]);
        return {(Between(2.f / 3, p[0], p[1]) + b) / 2, b, c,
                (c + Between(1.f / 3, p[2], p[3])) / 2};
    }
};

Basis ReadBasis(const Entity& entity) {
    const int degree = entity.parameters.GetInt("degree", 3);
    if (degree != 2 && degree != 3)
        throw Error(entity.loc, "curves of degree {} are not supported; 2 and 3 are", degree);
    const std::string basis = entity.parameters.GetString("basis", "bezier");
    if (basis != "bezier" && basis != "bspline")
        throw Error(entity.loc, "curves of basis \"{}\" are not supported; bezier and bspline are",
                    Printable(basis));
    return {basis == "bspline", degree};
}

std::vector<Vec3f> ReadVectors(const Entity& entity, ParameterType type, const char* name) {
    const auto values = entity.parameters.GetFloats(type, name);
    std::vector<Vec3f> vectors(values.size() / 3);
    for (size_t i = 0; i < vectors.size(); ++i) {
        vectors[i] = Eigen::Map<const Vec3f>(values.data() + 3 * i);
        if (!vectors[i].allFinite())
            throw Error(entity.loc, "\"{}\" of the curve is not finite", name);
    }
    return vectors;
}

std::vector<Vec3f> ReadNormals(const Entity& entity, CurveKind kind, size_t pieces,
                               Warnings& warnings) {
    std::vector<Vec3f> normals = ReadVectors(entity, ParameterType::Normal, "N");
    if (kind != CurveKind::Ribbon) {
        if (!normals.empty())
            warnings.Add(entity.loc, "\"N\" of a curve that is no ribbon has no effect");
        return {};
    }
    if (normals.size() != pieces + 1)
        throw Error(entity.loc, "a ribbon of {} pieces needs {} normals \"N\"; it has {}", pieces,
                    pieces + 1, normals.size());
    for (Vec3f& n : normals) {
        if (!(n.stableNorm() > 0)) throw Error(entity.loc, "a normal of the ribbon is zero");
        n.stableNormalize();
    }
    return normals;
}

std::array<float, 2> ReadWidths(const Entity& entity) {
    const float width = entity.parameters.GetFloat("width", 1);
    // Nothing asks for the width where both ends have their own.
    return {GetNonnegative(entity, "width0", width), GetNonnegative(entity, "width1", width)};
}

void AddStrand(const Entity& entity, Curves* curves, Warnings& warnings) {
    const Basis basis = ReadBasis(entity);
    const std::vector<Vec3f> points = ReadVectors(entity, ParameterType::Point3, "P");
    const auto count = basis.PieceCount(points.size());
    if (!count)
        throw Error(entity.loc, "the curve has {} points \"P\"; {} are needed", points.size(),
                    basis.isSpline ? fmt::format("{} or more", basis.degree + 1)
                                   : fmt::format("{} + n * {}", basis.degree + 1, basis.degree));
    const std::vector<Vec3f> normals = ReadNormals(entity, curves->kind, *count, warnings);
    const auto [width0, width1] = ReadWidths(entity);
    for (size_t i = 0; i < *count; ++i) {
        const auto widthAt = [&, from = width0, to = width1](size_t k) {
            return Lerp(float(k) / float(*count), from, to);
        };
        const CurvePiece piece{basis.Piece(points, i), {widthAt(i), widthAt(i + 1)}};
        if (piece.p[0] == piece.p[1] && piece.p[0] == piece.p[2] && piece.p[0] == piece.p[3]) {
            warnings.Add(entity.loc, "curve without length left out");
            continue;
        }
        curves->pieces.push_back(piece);
        if (!normals.empty()) curves->normals.push_back({normals[i], normals[i + 1]});
    }
}

void Place(const ShapeEntity& entity, Curves* curves) {
    Mat4d rigid = entity.worldFromObject;
    const bool mirrors = Mirrors(rigid);
    curves->flipNormals = entity.reverseOrientation != mirrors;
    const std::optional<float> scale = TakeScale(&rigid);
    if (!scale || mirrors) {
        curves->place = {entity.worldFromObject, entity.worldFromObject.inverse(),
                         entity.reverseOrientation, curves->flipNormals};
    } else {
        for (CurvePiece& piece : curves->pieces) {
            for (Vec3f& p : piece.p) p = TransformPoint(entity.worldFromObject, p);
            for (float& w : piece.width) w *= *scale;
        }
        for (auto& pair : curves->normals)
            for (Vec3f& n : pair) n = TransformVector(rigid, n);
        curves->errorPerWidth =
            2 * rigid.topLeftCorner<3, 3>().cwiseAbs().rowwise().sum().cast<float>();
    }
    if (const Bounds3f b = curves->WorldBounds();
        !b.IsEmpty() && !(b.lower.allFinite() && b.upper.allFinite()))
        throw Error(entity.loc, "the curve is not finite once transformed");
}

}  // namespace

Curves ReadCurves(const ShapeEntity& entity, Warnings& warnings) {
    if (entity.areaLight)
        throw Error(entity.loc,
                    "a light of shape \"curve\" is not supported; pbrt-v3 cannot sample it either");
    Curves curves;
    curves.kind = ReadKind(entity);
    curves.splitDepth = ReadSplitDepth(entity);
    AddStrand(entity, &curves, warnings);
    for (const Entity& strand : entity.strands) {
        ReadKind(strand);  // as the first one's, and so is the depth
        ReadSplitDepth(strand);
        AddStrand(strand, &curves, warnings);
        strand.parameters.ReportUnused("Shape \"curve\"", warnings);
    }
    if (uint64_t(curves.pieces.size()) << curves.splitDepth > uint64_t(1) << 31)
        throw Error(entity.loc, "there are too many curves; a smaller \"splitdepth\" helps");
    Place(entity, &curves);
    return curves;
}

}  // namespace lull
