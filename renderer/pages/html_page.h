// Writes reports for people: one HTML file with everything in it, which opens from disk.
#pragma once

#include <string_view>

#include "renderer/render/block_monitor.h"
#include "renderer/results/report.h"

namespace lull {

// Returns the embedded file `frame` with each {{name}} in it replaced: by the piece of that name,
// or else by the embedded file of that name.
std::string FillPage(std::string_view frame, const std::map<std::string, std::string>& pieces);

// Returns JSON that is safe inside a <script>, whatever its texts contain.
std::string JsonForScript(const Json&);

std::string Base64(std::span<const std::byte>);

// Return pictures as data URIs: an image as a display shows it; values in [0, 1] in false colours.
// Images larger than PagePictureScale() allows are averaged down.
std::string PictureUri(const RgbImage&);
std::string MapUri(std::span<const float> values, int width, int height);

// Return how many pixels a side a page shows as one, so that its picture has at most 4 million; and
// that picture, of the means of these pixels (fewer at the right and at the bottom).
int PagePictureScale(int width, int height);
RgbImage PagePicture(const Film&);

// Adds a note to the page if pictures of that size are scaled down.
void NotePictureScale(int width, int height, Json* page);

Json CurvesJson(const BlockCurves&);

// Returns the page for a render. `histories` have the curves of the blocks, or are empty;
// `denoised`, shown before the mean of the samples, may be null.
std::string MakeRenderPage(const Provenance&, const RenderResult&, const Film&,
                           const std::vector<BlockHistory>& histories,
                           const std::map<std::string, int>& warnings,
                           const DenoisedImage* denoised);

// Gives access to files that are part of the program (lull_embed() in cmake/EmbedFiles.cmake).

// Returns the text of a file by its name without folder; empty if there is none.
std::string_view EmbeddedFile(std::string_view name);

}  // namespace lull
