// Writes the files of a render.
#pragma once

#include <vector>

#include "renderer/commands/scene_options.h"
#include "renderer/files/outputs.h"
#include "renderer/render/block_monitor.h"
#include "renderer/results/image_files.h"

namespace lull {

// The attribute of an EXR that has FinishedRender::settings.
inline constexpr const char* kSettingsAttribute = "settings";

// Names the files; a report that is not wanted is empty.
struct RenderFiles {
    std::string exr, png, sppMap, thresholds, report;
};

// Returns the names for `output`, a name that ends in .exr or .png; all are in one folder.
RenderFiles NameFiles(const std::string& output, const std::string& report);

// Returns the image to write where the command names none: the scene's `filename`, or the name of
// the scene if that is empty or "scene", as of many scenes.
std::string DefaultOutput(const std::string& filename, const std::string& scene);

// Returns whether `output` ends as an image that can be written.
bool HasImageExtension(const std::string& output);

// Returns all files that may be written or removed, for CheckOutputs().
std::vector<NamedFile> OutputsOf(const RenderFiles&);

// Returns whether all files but the EXR that a render ends with are there, none of them cut short.
bool AreWhole(const RenderFiles&);

// A finished render; `histories` have the curves for a page.
struct FinishedRender {
    PictureOrigin origin;
    const Film& film;
    const RenderResult& result;
    const std::vector<BlockHistory>& histories;
    Warnings& warnings;                     // for the report; clamped values are added
    const DenoisedImage* denoised;          // null: the image is the means of the film
    const std::vector<ExrChannel>& halves;  // inputs of `lull denoise`
    const Description& description;
    const PictureFormat& pictures;
    std::string settings{};  // for the header of the EXR, by which a finished one is known; or none
};

// Writes all files, each whole or not at all; a report whose name ends in .html as a page. Those of
// an earlier render that this one has none of are removed.
ResultFiles WriteFiles(const RenderFiles&, const FinishedRender&);

// Names the files that a command reads, so that its results do not replace them.

// Returns the files of a scene that has been read, with the one that --environment names; for
// CheckOutputs().
std::vector<NamedFile> InputsOf(const SceneOptions&, const Description&);

// Adds the file that a stopping rule names, "learned:M.h5" or "thresholds:F.csv:NAME", if it does.
void AddFileOfRule(const std::string& rule, std::vector<NamedFile>* inputs);

}  // namespace lull
