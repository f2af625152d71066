#include "renderer/scene/materials/matte.h"

namespace lull {

void Matte::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    const Rgb r = in.Color(kd);
    if (IsBlack(r)) return;
    const float degrees = std::clamp(in(sigma), 0.f, 90.f);
    if (degrees == 0)
        bsdf->Add(LambertianReflection{r});
    else
        bsdf->Add(OrenNayar(r, degrees));
}

}  // namespace lull
