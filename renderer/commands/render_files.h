// Writes the files of a render.
#pragma once

#include "renderer/commands/aov_options.h"
#include "renderer/commands/picture_options.h"
#include "renderer/measure/block_observer.h"
#include "renderer/measure/image_error.h"
#include "renderer/measure/report.h"

namespace lull {

// Names the files; those not wanted are empty.
struct RenderFiles {
    std::string exr, png, sppMap, thresholds, ranges, report;
};

// Returns the names for `output`, a name that ends in .exr or .png; all lie beside each other.
RenderFiles NameFiles(const std::string& output, const std::string& report, bool withRanges);

// Says whether `output` ends as an image that can be written.
bool HasImageExtension(const std::string& output);

// Throws Error if one of the files could not be written now, or if the report would replace an
// image or the scene.
void CheckWritable(const RenderFiles&, const std::string& scene);

// Names a scene in thresholds files: the file without folder and extension, or the folder where
// the file is called scene.pbrt. Not empty, without what the format has no room for.
std::string SceneName(const std::string& file);

// Writes all files, each whole or not at all; the image has `extra` as well, and a report whose
// name ends in .html as a page, which shows the curves in `histories`. Throws Error.
void WriteFiles(const RenderFiles&, const Scene&, const Film&, const Provenance&,
                const RenderResult&, const Warnings&, const std::vector<BlockHistory>& histories,
                ExtraLayers extra, const PictureOptions&);

// Writes an image as EXR and PNG, as of a render whose block i, of those in `blocks`, took spp[i].
void WriteImage(const std::string& exr, const std::string& png, const Scene&, const RgbImage&,
                const std::vector<Block>& blocks, const std::vector<int>& spp, const Provenance&,
                double seconds);

}  // namespace lull
