// Reads PNG files whose names contain their samples per pixel (spp).
#pragma once

#include <png.h>

#include <cctype>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

struct Picture {
    int width = 0, height = 0;
    std::vector<unsigned char> pixels;  // 8-bit sRGB, as people saw it
};

// Returns the last number in the name of a file; 0 if there is none.
inline int SppOf(const std::string& file) {
    const std::string stem = std::filesystem::path(file).stem().string();
    size_t end = stem.size();
    while (end > 0 && !std::isdigit(static_cast<unsigned char>(stem[end - 1]))) --end;
    size_t begin = end;
    while (begin > 0 && std::isdigit(static_cast<unsigned char>(stem[begin - 1]))) --begin;
    return end - begin > 0 && end - begin < 9 ? std::stoi(stem.substr(begin, end - begin)) : 0;
}

// Adds a picture to `files`, by spp: 9 before 20, which comes before 100. Returns an error, or
// "".
inline std::string Add(const std::string& file, std::map<int, std::string>* files) {
    const int spp = SppOf(file);
    if (spp == 0) return "has no number of samples in its name, such as room_40.png";
    const auto other = files->emplace(spp, file);
    return other.second ? "" : "has as many samples as " + other.first->second + ", by their names";
}

// Reads a picture. Returns an error, or "".
inline std::string Read(const std::string& file, Picture* picture) {
    png_image png = {};
    png.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_file(&png, file.c_str())) return png.message;
    png.format = PNG_FORMAT_RGB;
    *picture = {int(png.width), int(png.height), std::vector<unsigned char>(PNG_IMAGE_SIZE(png))};
    return png_image_finish_read(&png, nullptr, picture->pixels.data(), 0, nullptr) ? ""
                                                                                    : png.message;
}

// Returns the spp between the pictures, at which a rule looks at the first of them; 0 if they are
// not its whole multiples: they come at any spp then.
inline int PassOf(const std::map<int, std::string>& files) {
    const int pass = files.begin()->first;
    int expected = 0;
    for (const auto& [spp, file] : files)
        if (spp != (expected += pass)) return 0;
    return pass;
}
