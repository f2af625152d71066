// Lets a render make a sequence of images: a frame of an animation after the other.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

namespace lull {

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
