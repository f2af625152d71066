#include "renderer/input/pbrt/pbrt_version.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>

#include "renderer/input/pbrt/pbrt_lexer.h"
#include "stopping/base/input_file.h"

namespace lull {
namespace {

constexpr std::string_view kV2Directives[] = {"Renderer", "SurfaceIntegrator", "Volume",
                                              "VolumeIntegrator"};
constexpr std::string_view kV4Directives[] = {"Attribute", "ColorSpace", "Import", "Option"};

// Kinds that a directive has in one version only.
struct KindOf {
    std::string_view directive, kind;
    PbrtVersion version;
};
constexpr KindOf kKinds[] = {
    {"Film", "image", PbrtVersion::V3},
    {"Film", "gbuffer", PbrtVersion::V4},
    {"Film", "rgb", PbrtVersion::V4},
    {"Film", "spectral", PbrtVersion::V4},
    {"Material", "coatedconductor", PbrtVersion::V4},
    {"Material", "coateddiffuse", PbrtVersion::V4},
    {"Material", "conductor", PbrtVersion::V4},
    {"Material", "dielectric", PbrtVersion::V4},
    {"Material", "diffuse", PbrtVersion::V4},
    {"Material", "diffusetransmission", PbrtVersion::V4},
    {"Material", "interface", PbrtVersion::V4},
    {"Material", "measured", PbrtVersion::V4},
    {"Material", "thindielectric", PbrtVersion::V4},
    {"Material", "disney", PbrtVersion::V3},
    {"Material", "fourier", PbrtVersion::V3},
    {"Material", "glass", PbrtVersion::V3},
    {"Material", "kdsubsurface", PbrtVersion::V3},
    {"Material", "matte", PbrtVersion::V3},
    {"Material", "metal", PbrtVersion::V3},
    {"Material", "mirror", PbrtVersion::V3},
    {"Material", "plastic", PbrtVersion::V3},
    {"Material", "substrate", PbrtVersion::V3},
    {"Material", "translucent", PbrtVersion::V3},
    {"Material", "uber", PbrtVersion::V3},
    {"Integrator", "ao", PbrtVersion::V3},
    {"Integrator", "directlighting", PbrtVersion::V3},
    {"Integrator", "whitted", PbrtVersion::V3},
    {"Integrator", "simplepath", PbrtVersion::V4},
    {"Integrator", "simplevolpath", PbrtVersion::V4},
    {"Sampler", "02sequence", PbrtVersion::V3},
    {"Sampler", "lowdiscrepancy", PbrtVersion::V3},
    {"Sampler", "maxmindist", PbrtVersion::V3},
    {"Sampler", "random", PbrtVersion::V3},
    {"Sampler", "independent", PbrtVersion::V4},
    {"Sampler", "paddedsobol", PbrtVersion::V4},
    {"Sampler", "pmj02bn", PbrtVersion::V4},
    {"Sampler", "zsobol", PbrtVersion::V4},
    {"Camera", "environment", PbrtVersion::V3},
    {"Camera", "spherical", PbrtVersion::V4},
};

// Parameters that one version alone has, whatever the directive.
struct ParameterOf {
    std::string_view name;
    PbrtVersion version;
};
constexpr ParameterOf kVersionsOfParameters[] = {
    {"Kd", PbrtVersion::V3},       {"mapname", PbrtVersion::V3}, {"bumpmap", PbrtVersion::V3},
    {"xwidth", PbrtVersion::V3},   {"xradius", PbrtVersion::V4}, {"reflectance", PbrtVersion::V4},
    {"normalmap", PbrtVersion::V4}};

std::string_view NameOfParameter(std::string_view declaration) {
    const size_t at = declaration.find_last_not_of(" \t");
    const size_t blank = declaration.find_last_of(" \t", at);
    return blank == declaration.npos ? std::string_view()
                                     : declaration.substr(blank + 1, at - blank);
}

// Returns the version that the next tokens belong to, if they tell.
std::optional<PbrtVersion> VersionAt(const Token& token, const Token& next, bool* hasEnded) {
    if (token.kind == TokenKind::String) {
        const std::string_view name = NameOfParameter(token.text);
        const auto* known = std::ranges::find(kVersionsOfParameters, name, &ParameterOf::name);
        if (!name.empty() && known != std::end(kVersionsOfParameters)) return known->version;
        if (token.text == "string type" && next.kind == TokenKind::String)
            for (const KindOf& kind : kKinds)
                if (kind.directive == "Material" && kind.kind == next.text) return kind.version;
        return {};
    }
    if (token.kind != TokenKind::Word) return {};
    if (std::ranges::count(kV4Directives, token.text) > 0) return PbrtVersion::V4;
    if (token.text == "WorldEnd") *hasEnded = true;
    for (const KindOf& kind : kKinds)
        if (kind.directive == token.text && kind.kind == next.text) return kind.version;
    return {};
}

// Returns the version of the first sign; nothing where there is none.
std::optional<PbrtVersion> FindSign(const std::filesystem::path& directory, PbrtLexer& lexer,
                                    bool* hasBegun, bool* hasEnded, Token* last) {
    Token& token = *last;
    while ((token = lexer.Take()).kind != TokenKind::End) {
        if (token.kind == TokenKind::Open || token.kind == TokenKind::Close) continue;
        const bool isWord = token.kind == TokenKind::Word;
        if (isWord && std::ranges::count(kV2Directives, token.text) > 0) return {};
        *hasBegun |= isWord && token.text == "WorldBegin";
        const Token& next = lexer.Peek();
        if (const auto version = VersionAt(token, next, hasEnded)) return version;
        if (!isWord || token.text != "Include" || next.kind != TokenKind::String) continue;
        const std::string path = (directory / lexer.Take().text).string();
        if (ReasonNotToRead(path).empty()) lexer.Include(path, token.loc);
    }
    return {};
}

}  // namespace

PbrtVersion DetectPbrtVersion(const std::string& directory, PbrtLexer* lexer, Warnings& warnings) {
    bool hasBegun = false, hasEnded = false;
    Token last;
    std::optional<PbrtVersion> version;
    try {
        version = FindSign(directory, *lexer, &hasBegun, &hasEnded, &last);
    } catch (const Error&) {
        version = PbrtVersion::V3;  // whose reader will meet the same error
    }
    lexer->Rewind();
    if (version) return *version;
    if (last.kind == TokenKind::Word)
        throw Error(last.loc, "this scene is written for pbrt-v2, as its directive " + last.text +
                                  " shows; lull reads scenes for pbrt-v3 and pbrt-v4");
    if (!hasBegun || hasEnded) return PbrtVersion::V3;
    warnings.Add(last.loc, "a world without an end: the scene is read as for pbrt-v4",
                 "--pbrt 3 reads it as for pbrt-v3");
    return PbrtVersion::V4;
}

}  // namespace lull
