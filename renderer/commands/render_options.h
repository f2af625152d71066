// Options of `lull render`.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/commands/render_settings.h"
#include "renderer/film/display.h"
#include "renderer/film/layer.h"
#include "renderer/results/image_files.h"

namespace lull::render {

// The times FROM, FROM + 1 / FPS, ... before TO, in seconds; at least one.
struct Sequence {
    double from = 0, to = 0, fps = 1;

    int Count() const;
    double TimeOf(int frame) const { return from + frame / fps; }
};

struct RenderRequest {
    RenderSettings render;
    std::string time, until;     // of a clock, as given; both empty: none
    std::string output, report;  // empty: as the scene says; none
    std::optional<std::string> stop;
    std::string importance;  // mask, or NAME=X, that changes the caution of blocks; empty: none
    std::optional<int> spp;  // nothing: as the rule says
    AovSet aovs;
    std::vector<std::string> lightGroups;  // their names; empty: none
    bool denoise = false, denoiseLayers = false;
    PictureFormat pictures;
    // OpenColorIO's configuration, empty: $OCIO, and view; nothing: neither is used.
    std::optional<std::string> ocio, view;
    std::string display;            // empty: none
    std::optional<double> preview;  // seconds between pictures on the way; nothing: none
    float gradedBy = 0;  // stops by which brightened pictures are judged as well; 0: are not
    // A path to print instead: its pixel, of the whole image, from its upper left; nothing: none.
    std::optional<Vec2i> pixel;
    int sample = 0;
    std::optional<Sequence> sequence;
    int frameNumber = 0;    // in the sequence, from 1; 0: there is none
    bool sameSeed = false;  // for all frames; else frame n has the seed of the settings plus n

    std::string Rule() const;
    // Returns how pictures are graded when noise is judged; none: they are not.
    std::vector<Grade> Grades() const;
    // Returns the clock in words, for headers; empty where there is none.
    std::string ClockText() const;
    bool HasPage() const { return report.ends_with(".html"); }
    // Returns the layers, with no light groups yet.
    LayerOptions WantedLayers() const {
        return {.aovs = aovs,
                .features = denoise || denoiseLayers,
                .groupNoise = denoise,
                .groupBackground = pictures.isTransparent};
    }
};

void AddRenderOptions(CLI::App& app, RenderRequest* request);

// Throws UsageError for options that do not fit together.
void CheckRequest(const RenderRequest&);

// Starts the clock: returns a function of the seconds left; empty without a limit.
std::function<double()> StartClock(const RenderRequest&);

// Begins to show a render whose image is called `name`; null where that is not wanted. Throws Error
// on several ranks.
std::unique_ptr<Display> MakeDisplay(const RenderRequest&, const std::string& name,
                                     const PixelRect& region, int ranks);

// Returns the name of the file of frame `number`, from 1: image.0001.exr for image.exr; "" for "".
std::string NumberedFile(const std::string& file, int number);

}  // namespace lull::render
