// A render of `lull render` that is ready to begin.
#pragma once

#include "renderer/commands/render_job.h"
#include "renderer/commands/render_options.h"
#include "renderer/render/block_monitor.h"
#include "renderer/results/denoised_image.h"

namespace lull::render {

// Names the files, all but the report in one folder; a report that is not wanted is empty.
struct RenderFiles {
    std::string exr, png, sppMap, thresholds, report;
};

// The attribute of an EXR that has SettingsOf() a finished frame.
inline constexpr const char* kSettingsAttribute = "settings";

struct PreparedRender : RenderJob {
    PreparedRender(const RenderRequest& request, std::function<double()> clock, MpiJob* ranks)
        : RenderJob(request.render, ranks, false),
          request(request),
          clock(std::move(clock)),
          grades(request.Grades()) {}

    const RenderRequest request;
    const std::function<double()> clock;  // started before the scene was read
    const std::vector<Grade> grades;
    Rule rule;
    std::vector<Block> blocks;     // without samples
    std::vector<double> cautions;  // of the blocks, by --importance; empty: that of the settings
    FilmOptions film;
    RenderFiles files;
    std::unique_ptr<Display> display;  // null: none
    std::vector<BlockHistory> histories;
};

// Reads scene and rule, and names the files. Throws Error or UsageError for all that can be wrong.
std::unique_ptr<PreparedRender> Prepare(const RenderRequest& request, MpiJob* ranks);

std::vector<Grading> GradingsOf(const std::vector<Grade>&);

// Frames of `lull render --frames --resume` whose files are there.

// Returns all that decides the files of a frame, by which --resume knows it; a line each.
std::string SettingsOf(const PreparedRender&);

// Returns whether all files of a frame are there. Throws Error where they are of another render.
bool IsFinished(const PreparedRender&);

}  // namespace lull::render
