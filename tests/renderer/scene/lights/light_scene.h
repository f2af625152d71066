// Makes scenes of lights alone.
#pragma once

#include <gtest/gtest.h>

#include "renderer/image/image_io.h"
#include "tests/renderer/scene_of.h"

namespace lull {

// Writes an image whose texel i has value(channel, i) in the channels R, G and B. Returns its file.
template <typename Value>
std::string WriteMap(const TemporaryDirectory& directory, const std::string& name, int width,
                     int height, const Value& value) {
    ExrImage image;
    image.width = width;
    image.height = height;
    for (const char* channel : {"R", "G", "B"}) {
        image.channels.push_back({channel, {}, false});
        for (int i = 0; i < width * height; ++i)
            image.channels.back().values.push_back(value(channel[0], i));
    }
    WriteExr(directory.File(name), image);
    return directory.File(name);
}

// Its folder has an environment map, sky.exr.
struct LightScene {
    TemporaryDirectory directory;
    std::unique_ptr<const Scene> scene;

    explicit LightScene(const std::string& world) {
        WriteMap(directory, "sky.exr", 8, 4,
                 [](char, int i) { return float(i * 7 % 13) + (i == 13) * 90; });
        Warnings warnings;
        // A scene without a shape is worth a warning.
        const std::string text = "Camera \"perspective\"\nWorldBegin\n" + world +
                                 "\nShape \"trianglemesh\" \"integer indices\" [0 1 2] "
                                 "\"point P\" [0 0 -50  .01 0 -50  0 .01 -50]\nWorldEnd\n";
        scene = SceneIn(directory.Write("test.pbrt", text), {}, &warnings);
        for (const auto& [kind, count] : warnings.Counts()) ADD_FAILURE() << kind;
    }
};

}  // namespace lull
