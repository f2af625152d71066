// Lets a render end by the clock.
#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <functional>
#include <string>

#include "renderer/commands/talk.h"
#include "renderer/progress/progress.h"

namespace lull {

struct ClockOptions {
    std::string time, until;  // as given; both empty: no clock

    // Returns it in words, for headers; empty where there is none.
    std::string Text() const;
};

// Adds --time and --until, of which there can be one.
void AddClockOptions(CLI::App& app, ClockOptions* options);

// Starts the clock: returns a function of the seconds left; empty without a limit.
std::function<double()> StartClock(const ClockOptions&);

using ProgressListener = std::function<void(const RenderProgress&)>;

// Returns a listener that forwards all progress and warns, once and as early as possible, where the
// first sample of all `pixels` will take longer than the time that is left.
ProgressListener WarnOfFirstSamples(int64_t pixels, const Talk&, ProgressListener listener);

}  // namespace lull
