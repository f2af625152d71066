#include "renderer/render/provenance.h"

namespace lull {

std::string NameOf(SamplerKind kind) { return kind == SamplerKind::Random ? "random" : "sobol"; }

std::string NameOf(Estimator estimator) {
    return estimator == Estimator::Combined ? "combined" : "pbrt-v3";
}

std::string NameOf(TextureFiltering filtering) {
    return filtering == TextureFiltering::Bilinear ? "bilinear" : "pbrt-v3";
}

}  // namespace lull
