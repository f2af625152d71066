// Recognises the channels of other programs' EXRs.
#pragma once

#include <string>

#include "renderer/image/image_io.h"

namespace lull {

// Renames the channels that a denoiser needs to those of lull's own images: colours R, G, B and A
// from the only layer that has them, "LAYER.Combined" before others, or from a single Y; "albedo",
// "N" and "Z" from Blender's passes "Denoising Albedo", "Denoising Normal" or "Normal", "Denoising
// Depth" or "Depth". Channels that are there already stay. Throws Error with `file` and a list of
// its channels if there are no colours, or several.
void UseOwnNames(const std::string& file, ExrImage*);

// Throws Error with `file` and a list of its channels unless its colours are linear ones of Rec.
// 709: R, G and B of other primaries ("chromaticities"), or a Y that is one of X, Y and Z, of luma
// and chroma, or of inks.
void CheckColours(const std::string& file, const ExrImage&);

// Lists the names of channels for messages, the first of them where there are many.
std::string ListOfChannels(const ExrImage&);

}  // namespace lull
