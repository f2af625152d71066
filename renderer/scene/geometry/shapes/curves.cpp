#include "renderer/scene/geometry/shapes/curves.h"

#include "renderer/scene/geometry/animated_transform.h"

namespace lull {
namespace {

using ControlPoints = std::array<Vec3f, 4>;

// Returns the blossom of the curve: its points where u0 = u1 = u2, control points of parts else.
Vec3f Blossom(const ControlPoints& p, float u0, float u1, float u2) {
    const Vec3f a = Between(u0, p[0], p[1]), b = Between(u0, p[1], p[2]),
                c = Between(u0, p[2], p[3]);
    return Between(u2, Between(u1, a, b), Between(u1, b, c));
}

ControlPoints PartOf(const ControlPoints& p, float u0, float u1) {
    return {Blossom(p, u0, u0, u0), Blossom(p, u0, u0, u1), Blossom(p, u0, u1, u1),
            Blossom(p, u1, u1, u1)};
}

struct PointOnCurve {
    Vec3f p, derivative;
};

// Evaluates the curve; where the derivative vanishes, as at the ends of curves whose first points
// are the same, the direction from end to end stands for it.
PointOnCurve Evaluate(const ControlPoints& p, float u) {
    const Vec3f a = Between(u, p[0], p[1]), b = Between(u, p[1], p[2]), c = Between(u, p[2], p[3]);
    const Vec3f d = Between(u, a, b), e = Between(u, b, c);
    const Vec3f derivative = e - d;
    return {Between(u, d, e),
            derivative.squaredNorm() > 0 ? Vec3f(3 * derivative) : Vec3f(p[3] - p[0])};
}

// Returns the normal of a ribbon at u, between those at its ends on the sphere. The angle between
// them counts as at most 90 degrees, as in pbrt-v3.
Vec3f RibbonNormal(const std::array<Vec3f, 2>& n, float u) {
    const float angle = std::acos(std::clamp(n[0].dot(n[1]), 0.f, 1.f));
    if (angle < 1e-3f) return Between(u, n[0], n[1]);  // pbrt-v3's is 0 / 0 where they are the same
    return (std::sin((1 - u) * angle) * n[0] + std::sin(u * angle) * n[1]) / std::sin(angle);
}

float SeenWidth(const CurvePiece& piece, const Vec3f* n, const Vec3f& direction, float u) {
    const float width = Lerp(u, piece.width[0], piece.width[1]);
    return n ? width * std::abs(n->dot(direction)) : width;
}

std::array<float, 2> RangeOf(const Curves& curves, uint32_t primitive) {
    const uint32_t parts = 1u << curves.splitDepth, part = primitive & (parts - 1);
    return {float(part) / float(parts), float(part + 1) / float(parts)};
}

Ray IntoShape(const Curves& curves, const Ray& ray) {
    if (!curves.place) return ray;
    const ShapeRay local(*curves.place, ray);
    return {local.o.cast<float>(), local.d.cast<float>(), ray.tMax};
}

// Looks for the ray in the plane across it: x roughly along the curve, z along the ray.
class Search {
  public:
    Search(const Curves& curves, uint32_t primitive, const Ray& ray)
        : piece(curves.pieces[primitive >> curves.splitDepth]),
          normals(curves.kind == CurveKind::Ribbon ? &curves.normals[primitive >> curves.splitDepth]
                                                   : nullptr),
          rayLength(ray.d.norm()),
          direction(ray.d / rayLength),
          zMax(rayLength * ray.tMax) {
        const auto [u0, u1] = RangeOf(curves, primitive);
        ControlPoints p = PartOf(piece.p, u0, u1);
        const Vec3f chord = p[3] - p[0];
        Vec3f x = chord - direction * direction.dot(chord), y;
        if (const float length = x.norm(); length > 0) {
            x /= length;
            y = direction.cross(x);
        } else {
            CoordinateSystem(direction, &x, &y);
        }
        for (Vec3f& q : p) {
            const Vec3f o = q - ray.o;
            q = {x.dot(o), y.dot(o), direction.dot(o)};
        }
        if (CanHit(p, u0, u1)) Descend(p, u0, u1, DepthFor(p));
    }

    std::optional<ShapeHit> nearest;

  private:
    // Returns whether the ray goes through the part's box; its y range, the smallest, comes first.
    bool CanHit(const ControlPoints& p, float u0, float u1) const {
        const float half = 0.5f * std::max(Lerp(u0, piece.width[0], piece.width[1]),
                                           Lerp(u1, piece.width[0], piece.width[1]));
        for (const int axis : {1, 0, 2}) {
            const auto [lower, upper] =
                std::minmax({p[0][axis], p[1][axis], p[2][axis], p[3][axis]});
            if (upper + half < 0 || lower - half > (axis == 2 ? zMax : 0)) return false;
        }
        return true;
    }

    // Returns how often the part has to be halved to be straight within a twentieth of the width
    // (Wang's formula), with the logarithm rounded as by pbrt-v3, on which the image depends.
    int DepthFor(const ControlPoints& p) const {
        float bend = 0;
        for (int i = 0; i < 2; ++i)
            bend = std::max(bend, (p[i] - 2 * p[i + 1] + p[i + 2]).cwiseAbs().maxCoeff());
        const float tolerance = 0.05f * std::max(piece.width[0], piece.width[1]);
        const float ratio = std::numbers::sqrt2_v<float> * 6 * bend / (8 * tolerance);
        if (!(ratio >= 1)) return 0;
        constexpr float kMost = 0x1p24f;
        const uint32_t bits = std::bit_cast<uint32_t>(std::min(ratio, kMost));
        const int log2 = int(bits >> 23) - 127 + ((bits & (1u << 22)) ? 1 : 0);
        return std::min(log2 / 2, 10);
    }

    void Descend(const ControlPoints& p, float u0, float u1, int depth) {
        if (depth == 0) {
            MeetStraight(p, u0, u1);
            return;
        }
        const Vec3f middle = (p[0] + 3 * p[1] + 3 * p[2] + p[3]) / 8;
        const ControlPoints halves[2] = {
            {p[0], (p[0] + p[1]) / 2, (p[0] + 2 * p[1] + p[2]) / 4, middle},
            {middle, (p[1] + 2 * p[2] + p[3]) / 4, (p[2] + p[3]) / 2, p[3]}};
        const float u[3] = {u0, (u0 + u1) / 2, u1};
        for (int i = 0; i < 2; ++i)
            if (CanHit(halves[i], u[i], u[i + 1])) Descend(halves[i], u[i], u[i + 1], depth - 1);
    }

    void MeetStraight(const ControlPoints& p, float u0, float u1) {
        // Leave out points beyond the perpendiculars at the ends.
        const auto beyond = [](const Vec3f& end, const Vec3f& next) {
            return (next.y() - end.y()) * -end.y() + end.x() * (end.x() - next.x()) < 0;
        };
        if (beyond(p[0], p[1]) || beyond(p[3], p[2])) return;
        const Vec2f along = (p[3] - p[0]).head<2>();
        const float length2 = along.squaredNorm();
        if (length2 == 0) return;
        const float w = std::clamp(-p[0].head<2>().dot(along) / length2, 0.f, 1.f);
        const float u = std::clamp(Lerp(w, u0, u1), u0, u1);
        Vec3f n;
        if (normals) n = RibbonNormal(*normals, u);
        const float width = SeenWidth(piece, normals ? &n : nullptr, direction, u);
        const auto [at, slope] = Evaluate(p, w);
        const float distance2 = at.head<2>().squaredNorm();
        if (!(width > 0) || distance2 > 0.25f * Sqr(width)) return;
        if (at.z() < 0 || at.z() > zMax) return;
        const float aside = std::sqrt(distance2) / width;
        const bool isLeft = at.x() * slope.y() - at.y() * slope.x() > 0;
        const float t = at.z() / rayLength;
        if (!(t > 0)) return;
        nearest = ShapeHit{t, u, isLeft ? 0.5f + aside : 0.5f - aside};
        zMax = at.z();
    }

    const CurvePiece& piece;
    const std::array<Vec3f, 2>* normals;
    float rayLength;
    Vec3f direction;
    float zMax;
};

// Returns the unit vector across the curve at v; `n` is the normal of a flat curve or a ribbon.
Vec3f AcrossAt(CurveKind kind, const Vec3f& n, const Vec3f& along, float v) {
    Vec3f across = n.cross(along);
    if (const float length = across.norm(); length > 0) {
        across /= length;
    } else {  // the curve points at the ray
        Vec3f other;
        CoordinateSystem(along, &across, &other);
    }
    if (kind != CurveKind::Cylinder) return across;
    // Turn it about the curve, from 90 degrees where v is 0 to -90 where it is 1.
    const float theta = (0.5f - v) * kPi;
    return std::cos(theta) * across + std::sin(theta) * along.cross(across);
}

}  // namespace

Bounds3f Curves::WorldBounds(uint32_t primitive) const {
    const CurvePiece& piece = pieces[primitive >> splitDepth];
    const auto [u0, u1] = RangeOf(*this, primitive);
    Bounds3f bounds;
    for (const Vec3f& p : PartOf(piece.p, u0, u1)) bounds.Extend(p);
    const Vec3f half = Vec3f::Constant(0.5f * std::max(Lerp(u0, piece.width[0], piece.width[1]),
                                                       Lerp(u1, piece.width[0], piece.width[1])));
    bounds.lower -= half;
    bounds.upper += half;
    return place ? TransformBox(place->worldFromShape, bounds) : bounds;
}

Bounds3f Curves::WorldBounds() const {
    Bounds3f bounds;
    for (uint32_t i = 0; i < PrimitiveCount(); ++i) bounds.Extend(WorldBounds(i));
    return bounds;
}

std::optional<ShapeHit> Intersect(const Curves& curves, uint32_t primitive, const Ray& ray) {
    return Search(curves, primitive, IntoShape(curves, ray)).nearest;
}

void Interact(const Curves& curves, const Ray& worldRay, const Hit& found, SurfaceNeeds,
              SurfaceInteraction* hit) {
    const uint32_t index = found.primitive >> curves.splitDepth;
    const CurvePiece& piece = curves.pieces[index];
    const float u = found.b1, v = found.b2;
    const Ray ray = IntoShape(curves, worldRay);
    const Vec3f direction = ray.d.normalized();
    const bool isRibbon = curves.kind == CurveKind::Ribbon;
    Vec3f facing = direction;
    if (isRibbon) facing = RibbonNormal(curves.normals[index], u);
    const float width = SeenWidth(piece, isRibbon ? &facing : nullptr, direction, u);

    hit->uv = {u, v};
    hit->dpdu = Evaluate(piece.p, u).derivative;
    // A curve that ends where it begins may stand still there; any direction will do.
    if (!(hit->dpdu.squaredNorm() > 0)) hit->dpdu = Vec3f::UnitX();
    const Vec3f along = hit->dpdu.stableNormalized();
    const Vec3f across = AcrossAt(curves.kind, facing, along, v);
    hit->dpdv = width * across;
    hit->surfaceDpdu = hit->dpdu;
    hit->surfaceDpdv = hit->dpdv;
    hit->dndu = hit->dndv = Vec3f::Zero();
    hit->n = along.cross(across);
    hit->p = ray.o + found.t * ray.d;
    // Add the rounding error of the point, which counts where the width is next to nothing.
    hit->pError =
        curves.errorPerWidth * width + Gamma(5) * (ray.o.cwiseAbs() + (found.t * ray.d).cwiseAbs());
    if (curves.place) {
        const Vec3f n = TransformNormal(curves.place->shapeFromWorld, hit->n);
        FinishQuadricHit(*curves.place, hit->p, hit->pError, UnitOf(hit->dpdu.cross(hit->dpdv)),
                         kNeedsTangents, hit);
        hit->n = n;
    }
    hit->n.stableNormalize();
    if (curves.flipNormals) hit->n = -hit->n;
    hit->ns = hit->n;
}

}  // namespace lull
