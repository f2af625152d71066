// Reads scene files of pbrt-v3 and pbrt-v4, and tells them apart.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

#include "renderer/input/pbrt/pbrt_builder.h"
#include "renderer/input/pbrt/v4.h"
#include "renderer/input/pbrt_parser.h"
#include "stopping/base/input_file.h"

namespace lull {
namespace {

enum class Place { Options = 1, World = 2, Anywhere = 3 };

struct Directive {
    std::string_view name;
    Place place;
    void (PbrtBuilder::*run)();
};

// Lists every directive, and whether it belongs before WorldBegin, after it or both.
constexpr Directive kDirectives[] = {
    {"Accelerator", Place::Options, &PbrtBuilder::Accelerator},
    {"ActiveTransform", Place::Anywhere, &PbrtBuilder::ActiveTransform},
    {"AreaLightSource", Place::World, &PbrtBuilder::AreaLightSource},
    {"Attribute", Place::Anywhere, &PbrtBuilder::Attribute},
    {"AttributeBegin", Place::World, &PbrtBuilder::AttributeBegin},
    {"AttributeEnd", Place::World, &PbrtBuilder::AttributeEnd},
    {"Camera", Place::Options, &PbrtBuilder::Camera},
    {"ColorSpace", Place::Anywhere, &PbrtBuilder::ColorSpace},
    {"ConcatTransform", Place::Anywhere, &PbrtBuilder::ConcatTransform},
    {"CoordSysTransform", Place::Anywhere, &PbrtBuilder::CoordSysTransform},
    {"CoordinateSystem", Place::Anywhere, &PbrtBuilder::CoordinateSystem},
    {"Film", Place::Options, &PbrtBuilder::Film},
    {"Identity", Place::Anywhere, &PbrtBuilder::Identity},
    {"Import", Place::World, &PbrtBuilder::Import},
    {"Include", Place::Anywhere, &PbrtBuilder::Include},
    {"Integrator", Place::Options, &PbrtBuilder::Integrator},
    {"LightSource", Place::World, &PbrtBuilder::LightSource},
    {"LookAt", Place::Anywhere, &PbrtBuilder::LookAt},
    {"MakeNamedMaterial", Place::World, &PbrtBuilder::MakeNamedMaterial},
    {"MakeNamedMedium", Place::Anywhere, &PbrtBuilder::MakeNamedMedium},
    {"Material", Place::World, &PbrtBuilder::Material},
    {"MediumInterface", Place::Anywhere, &PbrtBuilder::MediumInterface},
    {"NamedMaterial", Place::World, &PbrtBuilder::NamedMaterial},
    {"ObjectBegin", Place::World, &PbrtBuilder::ObjectBegin},
    {"ObjectEnd", Place::World, &PbrtBuilder::ObjectEnd},
    {"ObjectInstance", Place::World, &PbrtBuilder::ObjectInstance},
    {"Option", Place::Options, &PbrtBuilder::Option},
    {"PixelFilter", Place::Options, &PbrtBuilder::PixelFilter},
    {"ReverseOrientation", Place::World, &PbrtBuilder::ReverseOrientation},
    {"Rotate", Place::Anywhere, &PbrtBuilder::Rotate},
    {"Sampler", Place::Options, &PbrtBuilder::Sampler},
    {"Scale", Place::Anywhere, &PbrtBuilder::Scale},
    {"Shape", Place::World, &PbrtBuilder::Shape},
    {"Texture", Place::World, &PbrtBuilder::Texture},
    {"Transform", Place::Anywhere, &PbrtBuilder::Transform},
    {"TransformBegin", Place::World, &PbrtBuilder::TransformBegin},
    {"TransformEnd", Place::World, &PbrtBuilder::TransformEnd},
    {"TransformTimes", Place::Options, &PbrtBuilder::TransformTimes},
    {"Translate", Place::Anywhere, &PbrtBuilder::Translate},
    {"WorldBegin", Place::Options, &PbrtBuilder::WorldBegin},
    {"WorldEnd", Place::World, &PbrtBuilder::WorldEnd},
};
static_assert(std::ranges::is_sorted(kDirectives, {}, &Directive::name));

const Directive* FindDirective(const Token& token) {
    if (token.kind != TokenKind::Word) return nullptr;
    const auto it = std::ranges::lower_bound(kDirectives, token.text, {}, &Directive::name);
    return it != std::end(kDirectives) && it->name == token.text ? it : nullptr;
}

// Returns the directive that a token begins. Throws Error if it is none, or at a wrong place.
const Directive& DirectiveAt(const Token& token, PbrtBuilder::Stage stage) {
    const Directive* directive = FindDirective(token);
    if (!directive)
        throw Error(token.loc, token.kind == TokenKind::Word
                                   ? "unknown directive " + Describe(token)
                                   : "expected a directive, but there is " + Describe(token));
    if (stage == PbrtBuilder::Stage::Options && directive->place == Place::World)
        throw Error(token.loc, Describe(token) + " must come after WorldBegin");
    if (stage == PbrtBuilder::Stage::World && directive->place == Place::Options)
        throw Error(token.loc, Describe(token) + " must come before WorldBegin");
    return *directive;
}

// Returns whether the directives after one that failed can still be judged: not after one that
// opens or closes a scope, misspelled ones included.
bool CanContinueAfter(const Token& token) {
    const std::string text = LowerCase(token.text);
    return text.find("begin") == text.npos && text.find("end") == text.npos;
}

bool SkipToDirective(PbrtLexer* lexer) {
    try {
        while (lexer->Peek().kind != TokenKind::End && !FindDirective(lexer->Peek())) lexer->Take();
        return true;
    } catch (const Error&) {
        return false;
    }
}

void ReadDirectives(PbrtBuilder* builder, Warnings& warnings) {
    PbrtLexer& lexer = builder->lexer;
    Token token;
    while ((token = lexer.Take()).kind != TokenKind::End) {
        builder->CloseImports();
        if (builder->CurrentStage() == PbrtBuilder::Stage::Done)
            throw Error(token.loc, Describe(token) +
                                       " after WorldEnd: a file describes one scene; move the "
                                       "others to files of their own");
        const auto run = [&] {
            const Directive& directive = DirectiveAt(token, builder->CurrentStage());
            builder->loc = token.loc;
            (builder->*directive.run)();
        };
        if (warnings.Try(run)) continue;
        builder->hasFailed = true;
        if (!CanContinueAfter(token) || !SkipToDirective(&lexer)) break;
    }
    builder->loc = token.loc;
}

}  // namespace

Description ParsePbrt(const std::string& file, Warnings& warnings,
                      std::optional<PbrtVersion> version) {
    PbrtBuilder builder(file, version, warnings);
    Description description;
    const bool isWhole = warnings.Try([&] { ReadDirectives(&builder, warnings); }) &&
                         !builder.hasFailed &&
                         warnings.Try([&] { description = builder.Finish(); });
    if (!isWhole) warnings.ThrowErrors();
    return description;
}

// Tells scenes for pbrt-v3 from those for pbrt-v4.

namespace {

constexpr std::string_view kV2Directives[] = {"Renderer", "SurfaceIntegrator", "Volume",
                                              "VolumeIntegrator"};
constexpr std::string_view kV4Directives[] = {"Attribute", "ColorSpace", "Import", "Option"};

// Kinds that a directive has in one version only.
struct KindOf {
    std::string_view directive, kind;
    const char* instead = nullptr;  // in pbrt-v4
};
constexpr KindOf kKindsOfV3[] = {
    {"Film", "image", "\"rgb\""},
    {"Material", "disney", "\"coateddiffuse\" or \"mix\""},
    {"Material", "fourier", "\"measured\""},
    {"Material", "glass", "\"dielectric\""},
    {"Material", "kdsubsurface", "\"subsurface\" with \"reflectance\" and \"mfp\""},
    {"Material", "matte", "\"diffuse\" with \"reflectance\""},
    {"Material", "metal", "\"conductor\""},
    {"Material", "mirror", "\"conductor\" with \"reflectance\""},
    {"Material", "plastic", "\"coateddiffuse\""},
    {"Material", "substrate", "\"coateddiffuse\""},
    {"Material", "translucent", "\"diffusetransmission\""},
    {"Material", "uber", "\"coateddiffuse\" or \"mix\""},
    {"Integrator", "ao"},
    {"Integrator", "directlighting"},
    {"Integrator", "whitted"},
    {"Sampler", "02sequence", "\"zsobol\""},
    {"Sampler", "lowdiscrepancy", "\"zsobol\""},
    {"Sampler", "maxmindist", "\"zsobol\""},
    {"Sampler", "random", "\"independent\""},
    {"Camera", "environment", "\"spherical\""},
};
constexpr KindOf kKindsOfV4[] = {{"Film", "gbuffer"},
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
                                 {"Integrator", "simplepath"},
                                 {"Integrator", "simplevolpath"},
                                 {"Sampler", "independent"},
                                 {"Sampler", "paddedsobol"},
                                 {"Sampler", "pmj02bn"},
                                 {"Sampler", "zsobol"},
                                 {"Camera", "spherical"}};

std::optional<PbrtVersion> VersionOfKind(std::string_view directive, std::string_view kind) {
    const auto isIt = [&](const KindOf& k) { return k.directive == directive && k.kind == kind; };
    if (std::ranges::any_of(kKindsOfV3, isIt)) return PbrtVersion::V3;
    if (std::ranges::any_of(kKindsOfV4, isIt)) return PbrtVersion::V4;
    return {};
}

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
        const bool isType = token.text == "string type" && next.kind == TokenKind::String;
        return isType ? VersionOfKind("Material", next.text) : std::nullopt;
    }
    if (token.kind != TokenKind::Word) return {};
    if (std::ranges::count(kV4Directives, token.text) > 0) return PbrtVersion::V4;
    if (token.text == "WorldEnd") *hasEnded = true;
    return VersionOfKind(token.text, next.text);
}

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

void RefuseKindOfV3(std::string_view directive, std::string_view kind, const FileLoc& loc) {
    for (const KindOf& known : kKindsOfV3)
        if (known.instead && known.directive == directive && known.kind == kind)
            throw Error(loc, "{} \"{}\" is pbrt-v3's, in a scene for pbrt-v4; write {}", directive,
                        kind, known.instead);
}

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
