// Writes the files of a render.
#pragma once

#include "renderer/measure/block_observer.h"
#include "renderer/measure/image_files.h"

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

// Holds what there is to write of a render; `histories` have the curves for a page.
struct FinishedRender {
    PictureOrigin origin;
    const Film& film;
    const RenderResult& result;
    const std::vector<BlockHistory>& histories;
    const Warnings& warnings;
    const AovFilm* aovs;                    // null: no layers
    const DenoisedImage* denoised;          // null: the image is the means of the film
    const std::vector<ExrChannel>& halves;  // what can be denoised later
    const Description& description;
    const PictureFormat& pictures;
};

// Writes all files, each whole or not at all; a report whose name ends in .html as a page. Throws
// Error.
void WriteFiles(const RenderFiles&, const FinishedRender&);

}  // namespace lull
