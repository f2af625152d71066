#include "renderer/input/pbrt/foreign_file.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "stopping/base/input_file.h"

namespace lull {
namespace {

using namespace std::string_view_literals;

constexpr std::pair<std::string_view, const char*> kFormats[] = {
    {"BLENDER"sv, "a Blender file; render it in Blender with the add-on, or export it as glTF"},
    {"\x28\xb5\x2f\xfd"sv,
     "compressed (zstd), as Blender's files are; render those in Blender with the add-on"},
    {"PK\x03\x04"sv, "a ZIP archive; unpack it first"},
    {"7z\xbc\xaf"sv, "a 7z archive; unpack it first"},
    {"glTF"sv, "a binary glTF file; name it .glb"},
    {"ply\n"sv, "a PLY mesh; name a scene that uses it"},
    {"ply\r"sv, "a PLY mesh; name a scene that uses it"},
    {"\x89PNG"sv, "a PNG image; name a scene"},
    {"\xff\xd8\xff"sv, "a JPEG image; name a scene"},
    {"\x76\x2f\x31\x01"sv, "an OpenEXR image; name a scene"},
    {"\x89HDF"sv, "an HDF5 file; name a scene"},
    {"Kaydara FBX"sv, "an FBX file; export the scene as glTF"},
    {"PXR-USDC"sv, "a USD file; export the scene as glTF"},
    {"#usda"sv, "a USD file; export the scene as glTF"},
    {"<?xml"sv, "an XML file, as Mitsuba's scenes are; export the scene for pbrt or as glTF"},
    {"<scene"sv, "an XML file, as Mitsuba's scenes are; export the scene for pbrt or as glTF"},
};

constexpr std::pair<std::string_view, const char*> kExtensions[] = {
    {".blend", "a Blender file; render it in Blender with the add-on, or export it as glTF"},
    {".obj", "a Wavefront OBJ mesh; export the scene as glTF"},
    {".mtl", "a Wavefront material; export the scene as glTF"},
    {".stl", "an STL mesh; export the scene as glTF"},
    {".dae", "a COLLADA file; export the scene as glTF"},
    {".fbx", "an FBX file; export the scene as glTF"},
    {".usda", "a USD file; export the scene as glTF"},
};

}  // namespace

std::string ForeignFormat(std::string_view name, std::string_view bytes) {
    std::string lower(name);
    std::ranges::transform(lower, lower.begin(),
                           [](unsigned char c) { return char(std::tolower(c)); });
    for (const auto& [extension, what] : kExtensions)
        if (lower.ends_with(extension)) return what;
    for (const auto& [magic, what] : kFormats)
        if (bytes.starts_with(magic)) return what;
    if (const std::string_view wide = WideEncoding(bytes); !wide.empty())
        return std::string(wide) + " text; save it as UTF-8";
    // No other text has a NUL byte.
    constexpr size_t kLookedAt = 1024;
    if (bytes.substr(0, kLookedAt).find('\0') == std::string_view::npos) return "";
    return "a binary file; name a scene of pbrt or glTF";
}

}  // namespace lull
