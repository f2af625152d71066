// Lets a render end by the clock.
#pragma once

#include <CLI/App.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "renderer/commands/command.h"
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
ProgressListener WarnOfFirstSamples(int64_t pixels, const Messages&, ProgressListener listener);

// Lets a render make a sequence of images: a frame of an animation after the other.

// The times FROM, FROM + 1 / FPS, ... before TO, in seconds; at least one.
struct Sequence {
    double from = 0, to = 0, fps = 1;

    int Count() const;
    double TimeOf(int frame) const { return from + frame / fps; }
};

// Adds --frames, after --frame and the options that need it, which --frames satisfies as well.
void AddSequenceOptions(CLI::App& app, std::optional<Sequence>* sequence);

// Returns the name of the file of frame `number`, counted from 1: image.0001.exr for image.exr; an
// empty name as it is.
std::string NumberedFile(const std::string& file, int number);

}  // namespace lull
