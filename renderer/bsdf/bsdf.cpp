#include "renderer/bsdf/bsdf.h"

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

}  // namespace

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
    const Vec3f wo = shading.ToLocal(woWorld);
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

const Lobe& Bsdf::Choose(int choice, LobeSet set) const {
    if (set == LobeSet::All || specularCount == 0) return lobes[choice];
    int i = 0;
    while (IsSpecular(lobes[i]) || choice-- > 0) ++i;
    return lobes[i];
}

BsdfValue Bsdf::EvaluateLocal(const Vec3f& wo, const Vec3f& wi, bool reflects, LobeSet set) const {
    const bool sameHemisphere = SameHemisphere(wo, wi);
    const bool byShare = hasShares && set == LobeSet::All;
    BsdfValue sum;
    for (int i = 0; i < lobeCount; ++i) {
        VisitLobe(lobes[i], [&]<typename L>(const L& lobe) {
            if constexpr (!L::kIsSpecular) {
                const bool scatters = IsTwoSided<L>() || reflects != L::kTransmits;
                const bool isSampled = IsTwoSided<L>() || sameHemisphere != L::kTransmits;
                if (!scatters && !isSampled) return;
                const BsdfValue v = lobe.Evaluate(wo, wi);
                if (scatters) sum.f += v.f;
                sum.pdf += byShare ? shares[i] * v.pdf : v.pdf;
            }
        });
    }
    if (const int count = LobeCount(set); count > 1 && !byShare) sum.pdf /= count;
    return Finite(sum);
}

BsdfValue Bsdf::Evaluate(const Vec3f& woWorld, const Vec3f& wiWorld, LobeSet set) const {
    const Vec3f wo = shading.ToLocal(woWorld);
    if (wo.z() == 0) return {};
    return EvaluateLocal(wo, shading.ToLocal(wiWorld), Reflects(woWorld, wiWorld), set);
}

std::optional<BsdfSample> Bsdf::Sample(const Vec3f& woWorld, const Vec2f& u, LobeSet set) const {
    const int count = LobeCount(set);
    if (count == 0) return {};
    const Vec3f wo = shading.ToLocal(woWorld);
    if (wo.z() == 0) return {};
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
                return BsdfSample{s.f, probability > 0 ? s.pdf * probability : s.pdf / count,
                                  shading.FromLocal(s.wi), true, s.isTransmission};
            } else {
                Vec3f wi;
                if (!lobe.Sample(wo, v, &wi)) return {};
                const Vec3f wiWorld = shading.FromLocal(wi);
                const bool reflects = Reflects(woWorld, wiWorld);
                BsdfValue value;
                if (count > 1)
                    value = EvaluateLocal(wo, wi, reflects, set);
                else if (IsTwoSided<L>() || reflects != L::kTransmits)
                    value = Finite(lobe.Evaluate(wo, wi));
                if (!(value.pdf > 0) || IsBlack(value.f)) return {};
                return BsdfSample{value.f, value.pdf, wiWorld, false, L::kTransmits};
            }
        });
}

}  // namespace lull
