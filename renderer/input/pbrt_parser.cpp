#include "renderer/input/pbrt_parser.h"

#include <algorithm>
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

// Lists every directive of pbrt-v3, and whether it belongs before WorldBegin, after it or both.
constexpr Directive kDirectives[] = {
    {"Accelerator", Place::Options, &PbrtBuilder::Accelerator},
    {"ActiveTransform", Place::Anywhere, &PbrtBuilder::ActiveTransform},
    {"AreaLightSource", Place::World, &PbrtBuilder::AreaLightSource},
    {"AttributeBegin", Place::World, &PbrtBuilder::AttributeBegin},
    {"AttributeEnd", Place::World, &PbrtBuilder::AttributeEnd},
    {"Camera", Place::Options, &PbrtBuilder::Camera},
    {"ConcatTransform", Place::Anywhere, &PbrtBuilder::ConcatTransform},
    {"CoordSysTransform", Place::Anywhere, &PbrtBuilder::CoordSysTransform},
    {"CoordinateSystem", Place::Anywhere, &PbrtBuilder::CoordinateSystem},
    {"Film", Place::Options, &PbrtBuilder::Film},
    {"Identity", Place::Anywhere, &PbrtBuilder::Identity},
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

const Directive& FindDirective(const Token& token) {
    if (token.kind == TokenKind::Word) {
        const auto it = std::ranges::lower_bound(kDirectives, token.text, {}, &Directive::name);
        if (it != std::end(kDirectives) && it->name == token.text) return *it;
        throw Error(token.loc, "unknown directive " + Describe(token));
    }
    throw Error(token.loc, "expected a directive, but there is " + Describe(token));
}

}  // namespace

Description ParsePbrt(const std::string& file, Warnings& warnings) {
    PbrtBuilder builder(file, warnings);
    Token token;
    while ((token = builder.lexer.Take()).kind != TokenKind::End) {
        const Directive& directive = FindDirective(token);
        const auto stage = builder.CurrentStage();
        if (stage == PbrtBuilder::Stage::Done)
            throw Error(token.loc, Describe(token) +
                                       " after WorldEnd: a file describes one scene; move the "
                                       "others to files of their own");
        if (stage == PbrtBuilder::Stage::Options && directive.place == Place::World)
            throw Error(token.loc, Describe(token) + " must come after WorldBegin");
        if (stage == PbrtBuilder::Stage::World && directive.place == Place::Options)
            throw Error(token.loc, Describe(token) + " must come before WorldBegin");
        builder.loc = token.loc;
        (builder.*directive.run)();
    }
    return builder.Finish(token.loc);
}

}  // namespace lull
