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
    {"\x1f\x8b"sv, "compressed (gzip); unpack it first"},
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
    {"<?xml"sv, "an XML file, as Mitsuba's scenes are; export the scene for pbrt-v3 or as glTF"},
    {"<scene"sv, "an XML file, as Mitsuba's scenes are; export the scene for pbrt-v3 or as glTF"},
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

constexpr std::string_view kV2Directives[] = {"Renderer", "SurfaceIntegrator", "Volume",
                                              "VolumeIntegrator"};
constexpr std::string_view kV4Directives[] = {"Attribute", "ColorSpace", "Import", "Option"};
constexpr std::pair<std::string_view, std::string_view> kV4Kinds[] = {
    {"Film", "gbuffer"},
    {"Film", "rgb"},
    {"Film", "spectral"},
    {"Material", "coatedconductor"},
    {"Material", "coateddiffuse"},
    {"Material", "conductor"},
    {"Material", "dielectric"},
    {"Material", "diffuse"},
    {"Material", "diffusetransmission"},
    {"Material", "interface"},
    {"Material", "measured"},
    {"Material", "thindielectric"},
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
    return "a binary file; name a scene of pbrt-v3 or glTF";
}

std::string OtherVersion(std::string_view directive, std::string_view kind) {
    if (std::ranges::count(kV2Directives, directive) > 0) return "pbrt-v2";
    const bool isV4 = std::ranges::count(kV4Directives, directive) > 0 ||
                      std::ranges::count(kV4Kinds, std::pair(directive, kind)) > 0;
    return isV4 ? "pbrt-v4" : "";
}

}  // namespace lull
