#include "renderer/input/pbrt_parser.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <utility>

#include "renderer/input/pbrt/pbrt_builder.h"

namespace lull {
namespace {

enum class Place { Options = 1, World = 2, Anywhere = 3 };

struct Directive {
    std::string_view name;
    Place place;
    void (PbrtBuilder::*run)();
};

// Lists every directive, and whether it belongs before WorldBegin, after it or both. Four of them
// are pbrt-v4's.
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

// Returns null where a token is no directive.
const Directive* FindDirective(const Token& token) {
    if (token.kind != TokenKind::Word) return nullptr;
    const auto it = std::ranges::lower_bound(kDirectives, token.text, {}, &Directive::name);
    return it != std::end(kDirectives) && it->name == token.text ? it : nullptr;
}

// Returns the directive that a token begins. Throws Error if it is none, or stands where it must
// not.
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
    std::string text = token.text;
    for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
    return text.find("begin") == text.npos && text.find("end") == text.npos;
}

// Returns false where the rest cannot be cut into tokens.
bool SkipToDirective(PbrtLexer* lexer) {
    try {
        while (lexer->Peek().kind != TokenKind::End && !FindDirective(lexer->Peek())) lexer->Take();
        return true;
    } catch (const Error&) {
        return false;
    }
}

// Reads directives until the end, or an error after which none can be judged.
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

}  // namespace lull
