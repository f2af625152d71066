// Callbacks of a running render.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "renderer/progress/progress.h"
#include "renderer/schedule/schedule.h"

namespace lull {

struct RenderResult;

// Each can be empty.
struct RenderEvents {
    // Progress, from one thread at a time, about every `progressInterval` seconds and at the
    // end.
    std::function<void(const RenderProgress&)> onProgress;
    double progressInterval = 0.25;
    // A block that stops, or is at the cap; from any thread, one at a time.
    std::function<void(int index, const Block&)> onStop;
    // The result so far, with no thread at work and all samples in the film, every
    // `previewInterval` seconds. Empty for all ranks, or for none.
    std::function<void(const RenderResult&)> onPreview;
    double previewInterval = 60;
    // Ranks that do not answer, once the render has been cancelled.
    std::function<void(const std::vector<int>& ranks)> onSilence;
    // A rank that was given up, and for how many seconds it was silent.
    std::function<void(int rank, double seconds)> onGivenUp;

    // Of a Session: the progress when it ended, of the first rank alone; and lines on the
    // checkpoint resumed, on learning, and on checkpoints that could not be written.
    std::function<void(const RenderProgress&)> onFinish;
    std::function<void(const std::string&)> onResume, onLearning, onWarning;
};

}  // namespace lull
