#include "renderer/scene/materials/fourier.h"

#include "renderer/scene/materials/fourier_file.h"

namespace lull {

Fourier::Fourier(const MaterialReader& in) {
    const std::string file = in.entity.parameters.GetString("bsdffile", "");
    if (file.empty()) {
        problem = "a fourier material needs a \"bsdffile\"";
        return;
    }
    try {
        table = std::make_shared<const FourierTable>(
            LoadFourierTable(ResolvePath(in.description, file)));
    } catch (const Error& error) {
        problem = error.what();
    }
}

void Fourier::AddLobes(const MaterialInputs&, Bsdf* bsdf) const {
    bsdf->Add(FourierLobe{Rgb(1, 1, 1), table.get()});
}

}  // namespace lull
