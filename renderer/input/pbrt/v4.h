// Translates the entities of pbrt-v4 into those of a Description, nearly all of them pbrt-v3's.
// Their parameters are all known, so that a misspelled one is an error.
#pragma once

#include <string>

#include "renderer/input/description.h"
#include "renderer/input/pbrt/pbrt_state.h"
#include "renderer/input/pbrt/v4_spectra.h"

namespace lull {

struct V4Context {
    EntityKind kind;
    Description& description;  // textures may be added
    const GraphicsState& state;
    Warnings& warnings;
};

// Returns the entity in the Description's terms. Throws Error, with the place, for unknown kinds
// and parameters, with what pbrt-v4 has for those of pbrt-v3, and for what is not supported.
Entity TranslateV4(const V4Context& context, const Entity& entity);

// Sets what pbrt-v4 renders where a directive is absent.
void SetV4Defaults(Description* description);

// Takes the exposure time, which the camera has, into the film's scale.
void SetExposureOfV4(Description* description);

// Adds those parameters of Attribute whose names an entity does not have itself; it need not use
// them.
void AddPresets(const Parameters& presets, Parameters* parameters);

}  // namespace lull
