#include "renderer/scene/materials/medium_preset.h"

#include "renderer/bsdf/medium_presets.h"
#include "stopping/base/input_file.h"

namespace lull {

MediumPreset ReadMediumPreset(const std::string& name, const FileLoc& loc, Warnings& warnings) {
    MediumPreset preset{{0.0011f, 0.0024f, 0.014f}, {2.55f, 3.21f, 3.77f}};
    preset.isMeasured = FindMediumPreset(name, &preset.sigmaA, &preset.sigmaS);
    if (!preset.isMeasured && !name.empty())
        warnings.Add(loc, "unknown medium preset, pbrt-v3's default is used", Printable(name));
    return preset;
}

}  // namespace lull
