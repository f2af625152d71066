// Lets a render write layers beside its image.
#pragma once

#include <CLI/App.hpp>
#include <optional>

#include "renderer/commands/checkpoint_options.h"
#include "renderer/render/aov_channels.h"
#include "renderer/render/extras.h"

namespace lull {

// Adds --aov and --aov-through-specular.
void AddAovOptions(CLI::App& app, AovSet* wanted);

// Makes the film of the layers; nothing where none is wanted. Throws Error where the memory cannot
// hold it.
std::optional<AovFilm> MakeAovFilm(const AovSet& wanted, const PixelRect& region);

// Says in words which layers are wanted, for checkpoints and headers.
std::string TextOf(const AovSet& wanted);

// Do as without layers, which are null where there are none (checkpoint_options.h).
std::optional<RenderState> Resume(const CheckpointOptions&, const RenderIdentity&, Film*,
                                  std::vector<std::byte>* guide, AovFilm*);
void WriteCheckpoints(const CheckpointOptions&, const RenderIdentity&, const Film&, RenderOptions*,
                      std::span<const std::byte> guide, const AovFilm*);

// Holds what an EXR is given beside its image.
struct ExtraLayers {
    std::vector<ExrChannel> channels;
    std::map<std::string, ExrAttribute> attributes;
};

// Returns the layers, and in the attributes "objectNames" and "materialNames", each a JSON object
// of the numbers in the image and what they stand for: names where the scene has them, else kind,
// file and line.
ExtraLayers MakeExtraLayers(const AovFilm&, const Film&, const Description&, const Scene&);

}  // namespace lull
