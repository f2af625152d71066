#include "renderer/scene/materials/mix.h"
#include "stopping/base/input_file.h"

namespace lull {

Mix::Mix(const MaterialReader& in)
    : amount(in.ShareOfColors("amount", 0.5f)), operands(in.entity.operands) {}

std::string Mix::Problem(const MaterialReader& in) const {
    for (int i = 0; i < 2; ++i) {
        const std::string parameter = "namedmaterial" + std::to_string(i + 1);
        const std::string name = in.entity.parameters.GetString(parameter, "");
        if (operands[i] < 0 || operands[i] >= int(in.made.size()))
            return "\"" + parameter + "\" of a mix: there is no material \"" + Printable(name) +
                   "\"";
    }
    const SurfaceNeeds needs = Traits(in).needs;
    if (needs & kIsInterface) return "a mix of a material and \"none\" is not supported";
    if (needs & kScattersBelow)
        return "a mix with a material that scatters below its surface is not supported; light that "
               "goes in does not come out in pbrt-v3 either";
    return "";
}

MaterialTraits Mix::Traits(const MaterialReader& in) const {
    MaterialTraits traits = in.TraitsOf(0, amount);
    for (const int operand : operands) {
        const MaterialTraits& other = TraitsOfOperand(operand, in.made);
        traits.needs = traits.needs | other.needs;
        traits.mostLobes += other.mostLobes;
        traits.isConstant &= other.isConstant;
    }
    return traits;
}

void Mix::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    const Rgb first = in.Color(amount), second = (1 - first).max(0.f);
    // As in pbrt-v3 a lobe scaled to black stays among those to choose from.
    const int begin = bsdf->LobeCount(LobeSet::All);
    AddOperandLobes(operands[0], in, bsdf);
    const int middle = bsdf->LobeCount(LobeSet::All);
    const float eta = bsdf->Eta();
    AddOperandLobes(operands[1], in, bsdf);
    bsdf->Scale(begin, middle, first);
    bsdf->Scale(middle, bsdf->LobeCount(LobeSet::All), second);
    bsdf->SetEta(eta);  // pbrt-v3 takes the first material's
}

}  // namespace lull
