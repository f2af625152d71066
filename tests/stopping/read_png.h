// Reads pictures among the reference data.
#pragma once

#include <gtest/gtest.h>
#include <png.h>

#include <cstdint>
#include <string>
#include <vector>

namespace lull {

// Returns the 8-bit RGB pixels of a PNG that has this size.
inline std::vector<uint8_t> ReadPng(const std::string& path, unsigned width, unsigned height) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    EXPECT_TRUE(png_image_begin_read_from_file(&image, path.c_str())) << image.message;
    EXPECT_EQ(image.width, width);
    EXPECT_EQ(image.height, height);
    image.format = PNG_FORMAT_RGB;
    std::vector<uint8_t> srgb(PNG_IMAGE_SIZE(image));
    EXPECT_TRUE(png_image_finish_read(&image, nullptr, srgb.data(), 0, nullptr)) << image.message;
    return srgb;
}

}  // namespace lull
