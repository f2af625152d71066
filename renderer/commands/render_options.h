// Options of `lull render`.
#pragma once

#include "renderer/commands/output_options.h"
#include "renderer/commands/path_printer.h"
#include "renderer/commands/render_settings.h"
#include "renderer/commands/time_options.h"

namespace lull::render {

struct RenderRequest {
    RenderSettings render;
    ClockOptions clock;
    std::string output, report;  // empty: as the scene says; none
    std::optional<std::string> stop;
    int spp = 0;  // 0: as the rule says
    AovSet aovs;
    std::vector<std::string> lightGroups;  // their names; empty: none
    bool denoise = false, denoiseLayers = false;
    PictureOptions pictures;
    float gradedBy = 0;  // stops by which brightened pictures are judged as well; 0: are not
    PathOfSample path;   // to print, instead
    std::optional<Sequence> sequence;
    int frameNumber = 0;  // in the sequence, from 1; 0: there is none

    // Returns the rule of --stop, --spp and --denoise.
    std::string Rule() const;
    // Returns how pictures are graded when noise is judged; none: they are not.
    std::vector<Grade> Grades() const;
    // Returns whether the report is a page, with curves.
    bool HasPage() const { return report.ends_with(".html"); }
    // Returns the layers, with no light groups yet.
    LayerOptions WantedLayers() const {
        return {.aovs = aovs,
                .features = denoise || denoiseLayers,
                .groupNoise = denoise,
                .groupBackground = pictures.format.isTransparent};
    }
};

void AddRenderOptions(CLI::App& app, RenderRequest* request);

// Throws UsageError for options that do not fit together.
void CheckRequest(const RenderRequest&);

}  // namespace lull::render
