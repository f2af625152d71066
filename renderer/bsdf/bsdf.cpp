#include "renderer/bsdf/bsdf.h"

#include "renderer/bsdf/lobe_albedo_internal.h"

namespace lull {
namespace {

// Drops values beyond the range of float. f is nonnegative, so that its sum tells.
BsdfValue Finite(const BsdfValue& v) {
    return v.f.sum() < kInfinity && v.pdf < kInfinity ? v : BsdfValue();
}

template <typename L>
constexpr bool IsTwoSided() {
    return requires { L::kIsTwoSided; };
}

// Returns whether light that a lobe scatters below the surface is reflected there once more. Of the
// others, f behind the shading normal makes up for it, as in pbrt-v3.
template <typename L>
constexpr bool ReflectsAgain() {
    return IsMirrorLike<L>() && !L::kIsSpecular && !std::is_same_v<L, FresnelBlend>;
}

template <typename L>
bool KeepsSide(bool reflects, bool sameHemisphere) {
    if constexpr (requires { L::kTellsSides; })
        return reflects == sameHemisphere;
    else
        return IsTwoSided<L>() || reflects != L::kTransmits;
}

template <typename L>
void Scale(L* lobe, const Rgb& s) {
    if constexpr (requires { lobe->scale; }) {
        lobe->scale *= s;
    } else {
        if constexpr (requires { lobe->r; }) lobe->r *= s;
        if constexpr (requires { lobe->t; }) lobe->t *= s;
    }
}
void Scale(std::monostate*, const Rgb&) {}

}  // namespace

Lobe Scaled(const Lobe& lobe, const Rgb& scale) {
    Lobe scaled = lobe;
    Visit(scaled, [&](auto& l) { Scale(&l, scale); });
    return scaled;
}

float EstimatedAlbedo(const Lobe& lobe, const Vec3f& wo) {
    return VisitLobe(lobe, LobeAlbedo<float>(wo));
}

void ChoosePartsByShare(const Vec3f& wo, float least, Lobe* lobe) {
    FresnelBlend* blend = std::get_if<FresnelBlend>(lobe);
    if (!blend) return;
    const LobeAlbedo<float> albedo(wo);
    const float diffuse = albedo.OfDiffuse(*blend), glossy = albedo.OfGlossy(*blend);
    const float share = glossy / (diffuse + glossy);
    if (share >= 0) blend->glossyShare = std::clamp(share, least, 1 - least);
}

bool Bsdf::Transmits() const {
    for (int i = 0; i < lobeCount; ++i)
        if (VisitLobe(lobes[i], []<typename L>(const L&) {
                return !L::kIsSpecular && (L::kTransmits || IsTwoSided<L>());
            }))
            return true;
    return false;
}

void Bsdf::ChooseByShare(const Vec3f& woWorld) {
    // No lobe gets less: the estimates know nothing of where light comes from.
    constexpr float kLeast = 0.1f;
    if (lobeCount == 0 || (lobeCount == 1 && !std::holds_alternative<FresnelBlend>(lobes[0])))
        return;
    const Vec3f wo = FrameTowards(woWorld).ToLocal(woWorld);
    if (wo.z() == 0) return;
    for (int i = 0; i < lobeCount; ++i) ChoosePartsByShare(wo, kLeast, &lobes[i]);
    if (lobeCount < 2) return;
    float sum = 0;
    for (int i = 0; i < lobeCount; ++i) sum += shares[i] = EstimatedAlbedo(lobes[i], wo);
    if (!(sum > 0 && sum < kInfinity)) return;
    for (int i = 0; i < lobeCount; ++i)
        shares[i] = kLeast + (1 - kLeast * float(lobeCount)) * (shares[i] / sum);
    hasShares = true;
}

Bsdf Bsdf::WithoutShares() const {
    Bsdf bsdf = *this;
    bsdf.hasShares = false;
    for (int i = 0; i < lobeCount; ++i)
        if (auto* blend = std::get_if<FresnelBlend>(&bsdf.lobes[i])) blend->glossyShare = 0.5f;
    return bsdf;
}

Rgb Bsdf::StraightThrough(const Vec3f& woWorld) const {
    const float cosine = woWorld.dot(FrameTowards(woWorld).n);
    Rgb sum = Rgb::Zero();
    if (cosine == 0) return sum;
    for (int i = 0; i < lobeCount; ++i)
        if (const auto* sheet = std::get_if<ThinSpecular>(&lobes[i]))
            sum += sheet->StraightThrough(std::abs(cosine));
    return sum;
}

void Bsdf::BlockStraight() {
    for (int i = 0; i < lobeCount; ++i)
        if (auto* sheet = std::get_if<ThinSpecular>(&lobes[i])) sheet->t = Rgb(Rgb::Zero());
}

const Lobe& Bsdf::Choose(int choice, LobeSet set) const {
    if (set == LobeSet::All || specularCount == 0) return lobes[choice];
    int i = 0;
    while (IsSpecular(lobes[i]) || choice-- > 0) ++i;
    return lobes[i];
}

// In the plane of both normals, with the geometric one along z, a normal that halves the angle
// between wo and a direction mirrors one into the other, whatever wo has across the plane.
Frame Bsdf::TurnedFrame(const Vec3f& wo) const {
    const float side = wo.dot(ng) < 0 ? -1 : 1;
    const Vec3f g = side * ng;
    const Vec3f x = (side * shading.n - alongNg * g).normalized();
    const float woX = wo.dot(x), woZ = wo.dot(g), z = LeastHeight(woZ);
    const float rest = (woZ - z) * (woZ + z);  // of the squared length in the plane
    const float root = std::sqrt(Sqr(woX) + rest);
    const Vec3f n = (woX > 0 ? woX + root : rest / (root - woX)) * x + (woZ + z) * g;
    const float length = n.norm();
    Frame frame{{}, {}, length > 0 ? Vec3f(n * (side / length)) : ng};
    const Vec3f s = shading.s - frame.n * frame.n.dot(shading.s);
    if (const float across = s.norm(); across > 1e-4f) {
        frame.s = s / across;
        frame.t =
            std::copysign(1.f, shading.n.cross(shading.s).dot(shading.t)) * frame.n.cross(frame.s);
    } else {
        CoordinateSystem(frame.n, &frame.s, &frame.t);
    }
    return frame;
}

Bsdf Bsdf::Turned(const Vec3f& wo) const {
    Bsdf turned = *this;
    turned.shading = TurnedFrame(wo);
    turned.alongNg = turned.shading.n.dot(ng);
    return turned;
}

BsdfValue Bsdf::EvaluateLocal(const Vec3f& wo, const Vec3f& wi, const Vec3f* below, bool reflects,
                              LobeSet set) const {
    const bool sameHemisphere = SameHemisphere(wo, wi);
    const bool byShare = hasShares && set == LobeSet::All;
    BsdfValue sum;
    for (int i = 0; i < lobeCount; ++i) {
        VisitLobe(lobes[i], [&]<typename L>(const L& lobe) {
            if constexpr (!L::kIsSpecular) {
                const bool scatters = KeepsSide<L>(reflects, sameHemisphere) &&
                                      (sameHemisphere || !mayTurn || !ReflectsAgain<L>());
                const bool isSampled = IsTwoSided<L>() || sameHemisphere != L::kTransmits;
                const auto add = [&](const BsdfValue& v, float weight) {
                    if (scatters) sum.f += v.f * weight;
                    sum.pdf += byShare ? shares[i] * v.pdf : v.pdf;
                };
                if (scatters || isSampled) add(lobe.Evaluate(wo, wi), 1);
                if constexpr (ReflectsAgain<L>())
                    if (below && scatters)
                        add(lobe.Evaluate(wo, *below), std::abs(below->z() / wi.z()));
            }
        });
    }
    if (const int count = LobeCount(set); count > 1 && !byShare) sum.pdf /= count;
    return Finite(sum);
}

BsdfValue Bsdf::EvaluateHere(const Vec3f& wo, const Vec3f& woWorld, const Vec3f& wiWorld,
                             LobeSet set) const {
    const Vec3f wi = shading.ToLocal(wiWorld);
    const bool reflects = Reflects(woWorld, wiWorld);
    if (mayTurn && reflects) {
        const float height = wiWorld.dot(ng);
        // Lobes scatter there only above the shading normal's plane.
        if ((wi.z() - 2 * height * alongNg) * wo.z() > 0) {
            const Vec3f below = shading.ToLocal(wiWorld - 2 * height * ng);
            return EvaluateLocal(wo, wi, &below, reflects, set);
        }
    }
    return EvaluateLocal(wo, wi, nullptr, reflects, set);
}

BsdfValue Bsdf::Evaluate(const Vec3f& woWorld, const Vec3f& wiWorld, LobeSet set) const {
    const Vec3f wo = shading.ToLocal(woWorld);
    if (mayTurn && IsTurned(wo.z(), woWorld.dot(ng))) [[unlikely]] {
        const Bsdf turned = Turned(woWorld);
        const Vec3f local = turned.shading.ToLocal(woWorld);
        if (local.z() == 0) return {};
        BsdfValue v = turned.EvaluateHere(local, woWorld, wiWorld, set);
        // Callers multiply by the cosine with the shading normal.
        v.f *= std::abs(wiWorld.dot(turned.shading.n) / wiWorld.dot(shading.n));
        return Finite(v);
    }
    if (wo.z() == 0) return {};
    return EvaluateHere(wo, woWorld, wiWorld, set);
}

std::optional<BsdfSample> Bsdf::Sample(const Vec3f& woWorld, const Vec2f& u, LobeSet set) const {
    const Vec3f wo = shading.ToLocal(woWorld);
    if (mayTurn && IsTurned(wo.z(), woWorld.dot(ng))) [[unlikely]] {
        const Bsdf turned = Turned(woWorld);
        const Vec3f local = turned.shading.ToLocal(woWorld);
        if (local.z() == 0) return {};
        auto sample = turned.SampleHere(local, woWorld, u, set);
        if (!sample) return sample;
        sample->f *= std::abs(sample->wi.dot(turned.shading.n) / sample->wi.dot(shading.n));
        if (!(sample->f.sum() < kInfinity)) return {};
        return sample;
    }
    if (wo.z() == 0) return {};
    return SampleHere(wo, woWorld, u, set);
}

std::optional<BsdfSample> Bsdf::SampleHere(const Vec3f& wo, const Vec3f& woWorld, const Vec2f& u,
                                           LobeSet set) const {
    const int count = LobeCount(set);
    if (count == 0) return {};
    int choice;
    float x, probability;
    if (hasShares && set == LobeSet::All) {
        x = u.x();
        for (choice = 0; choice < count - 1 && x >= shares[choice]; ++choice) x -= shares[choice];
        probability = shares[choice];
        x /= probability;
    } else {
        choice = std::min(int(u.x() * count), count - 1);
        x = u.x() * count - choice;
        probability = 0;  // unused: dividing by the count has other bits
    }
    const Vec2f v(std::min(x, kOneMinusEpsilon), u.y());
    return VisitLobe(
        Choose(choice, set), [&]<typename L>(const L& lobe) -> std::optional<BsdfSample> {
            if constexpr (L::kIsSpecular) {
                SpecularSample s;
                if (!lobe.Sample(wo, v, &s)) return {};
                const float sum = s.f.sum();
                if (!(sum > 0 && sum < kInfinity && s.pdf > 0)) return {};
                const Vec3f wiWorld = shading.FromLocal(s.wi);
                if (mayTurn && !s.isTransmission && !Reflects(woWorld, wiWorld)) return {};
                return BsdfSample{s.f, probability > 0 ? s.pdf * probability : s.pdf / count,
                                  wiWorld, true, s.isTransmission};
            } else {
                Vec3f wi;
                if (!lobe.Sample(wo, v, &wi)) return {};
                Vec3f wiWorld = shading.FromLocal(wi);
                const bool reflects = Reflects(woWorld, wiWorld);
                BsdfValue value;
                if (mayTurn) {
                    if (ReflectsAgain<L>() && !reflects) wiWorld -= 2 * wiWorld.dot(ng) * ng;
                    value = EvaluateHere(wo, woWorld, wiWorld, set);
                } else if (count > 1) {
                    value = EvaluateLocal(wo, wi, nullptr, reflects, set);
                } else if (KeepsSide<L>(reflects, SameHemisphere(wo, wi))) {
                    value = Finite(lobe.Evaluate(wo, wi));
                }
                if (!(value.pdf > 0) || IsBlack(value.f)) return {};
                return BsdfSample{value.f, value.pdf, wiWorld, false, L::kTransmits};
            }
        });
}

Rgb AlbedoOf(const Bsdf& bsdf, const Vec3f& woWorld) {
    const Vec3f wo = bsdf.FrameTowards(woWorld).ToLocal(woWorld);
    Rgb sum = Rgb::Zero();
    if (wo.z() == 0) return sum;
    for (int i = 0; i < bsdf.LobeCount(LobeSet::All); ++i)
        sum += VisitLobe(bsdf.At(i), LobeAlbedo<Rgb>(wo));
    for (float& c : sum) c = c > 0 ? std::min(c, 1.f) : 0;
    return sum;
}

}  // namespace lull
