// Makes scenes of lights alone.
#pragma once

#include <gtest/gtest.h>

#include "renderer/image/image_io.h"
#include "tests/renderer/scene_of.h"

namespace lull {

// Its folder has an environment map, sky.exr.
struct LightScene {
    TemporaryDirectory directory;
    std::unique_ptr<const Scene> scene;

    explicit LightScene(const std::string& world) {
        ExrImage sky;
        sky.width = 8;
        sky.height = 4;
        for (const char* channel : {"R", "G", "B"}) {
            sky.channels.push_back({channel, {}, false});
            for (int i = 0; i < 32; ++i)
                sky.channels.back().values.push_back(float(i * 7 % 13) + (i == 13) * 90);
        }
        WriteExr(directory.File("sky.exr"), sky);
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
