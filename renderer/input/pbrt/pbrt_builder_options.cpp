// PbrtBuilder's readers, and the directives that set transforms and rendering options.

#include <Eigen/LU>
#include <algorithm>
#include <string_view>
#include <utility>

#include "renderer/input/pbrt/pbrt_builder.h"
#include "renderer/input/pbrt/v4.h"
#include "stopping/base/input_file.h"

namespace lull {

std::string PbrtBuilder::ReadString(const char* what) {
    const Token token = lexer.Take();
    if (token.kind != TokenKind::String)
        throw Error(token.loc, std::string("expected ") + what + " in quotes, but there is " +
                                   Describe(token));
    return token.text;
}

double PbrtBuilder::ReadNumber() {
    double value;
    if (lexer.TakeNumber(&value)) return value;
    const Token token = lexer.Take();
    throw Error(token.loc, "expected a number, but there is " + Describe(token));
}

template <size_t N>
std::array<double, N> PbrtBuilder::ReadNumbers() {
    std::array<double, N> values;
    for (double& value : values) value = ReadNumber();
    return values;
}

Mat4d PbrtBuilder::ReadMatrix() {
    const Token open = lexer.Take();
    if (open.kind != TokenKind::Open)
        throw Error(open.loc, "expected 16 numbers in brackets, but there is " + Describe(open));
    const std::array<double, 16> numbers = ReadNumbers<16>();
    const Token close = lexer.Take();
    if (close.kind != TokenKind::Close)
        throw Error(close.loc, "expected ']' after 16 numbers, but there is " + Describe(close));
    return ColumnsMatrix(numbers, loc);
}

Entity PbrtBuilder::ReadEntity() {
    std::string name = ReadString("a name");
    return {std::move(name), ReadParameters(lexer, context, state.rgbFromColorSpace, warnings),
            loc};
}

Entity PbrtBuilder::Translated(EntityKind kind, Entity entity) {
    if (!IsV4()) return entity;
    const auto preset = state.attributes.find(kind);
    if (preset != state.attributes.end()) AddPresets(preset->second, &entity.parameters);
    return TranslateV4({kind, description, state, warnings}, std::move(entity));
}

void PbrtBuilder::ReadOption(EntityKind kind, Entity* entity, const char* directive) {
    *entity = Translated(kind, ReadEntity());
    if (!optionsSeen.emplace(directive, loc).second)
        warnings.Add(loc, std::string(directive) + " given again; the later one counts");
}

void PbrtBuilder::Film() { ReadOption(EntityKind::Film, &description.film, "Film"); }
void PbrtBuilder::Integrator() {
    ReadOption(EntityKind::Integrator, &description.integrator, "Integrator");
}
void PbrtBuilder::PixelFilter() {
    ReadOption(EntityKind::Filter, &description.filter, "PixelFilter");
}
void PbrtBuilder::Sampler() { ReadOption(EntityKind::Sampler, &description.sampler, "Sampler"); }
void PbrtBuilder::Accelerator() { ReadEntity(); }  // Embree builds its own
void PbrtBuilder::TransformTimes() { description.transformTimes = ReadNumbers<2>(); }

// Directives of pbrt-v4 alone.

void PbrtBuilder::Attribute() {
    constexpr std::pair<const char*, EntityKind> kTargets[] = {
        {"light", EntityKind::Light},
        {"material", EntityKind::Material},
        {"medium", EntityKind::Medium},
        {"shape", EntityKind::Shape},
        {"texture", EntityKind::FloatTexture}};
    const std::string target = ReadString("\"shape\", \"light\" or the like");
    const Parameters given = ReadParameters(lexer, context, state.rgbFromColorSpace, warnings);
    const auto* known = std::ranges::find(kTargets, target, [](const auto& t) { return t.first; });
    if (known == std::end(kTargets))
        throw Error(loc, "Attribute \"" + Printable(target) +
                             "\" is unknown; light, material, medium, shape and texture are");
    const auto add = [&](EntityKind kind) {
        for (const Parameter& parameter : given.All()) state.attributes[kind].Add(parameter);
    };
    add(known->second);
    if (known->second == EntityKind::Light) add(EntityKind::AreaLight);
    if (known->second == EntityKind::FloatTexture) add(EntityKind::SpectrumTexture);
}

void PbrtBuilder::ColorSpace() {
    state.rgbFromColorSpace = RgbFromColorSpace(ReadString("the name of a colour space"), loc);
}

void PbrtBuilder::Option() {
    constexpr std::string_view kKnown[] = {"disablepixeljitter",
                                           "disabletexturefiltering",
                                           "disablewavelengthjitter",
                                           "displacementedgescale",
                                           "forcediffuse",
                                           "msereferenceimage",
                                           "msereferenceout",
                                           "pixelstats",
                                           "rendercoordsys",
                                           "seed",
                                           "wavefront"};
    const std::string given = ReadString("the name of an option");
    lexer.Take();  // its value, one word
    std::string name = LowerCase(given);
    std::erase_if(name, [](char c) { return c == '_' || c == '-'; });
    if (std::ranges::count(kKnown, name) == 0)
        throw Error(loc, "Option \"" + Printable(given) + "\" is unknown");
    if (name != "seed") warnings.Add(loc, "Option \"" + name + "\" has no effect");
}

void PbrtBuilder::Camera() {
    ReadOption(EntityKind::Camera, &description.camera, "Camera");
    description.cameraFromWorld = state.ctm.at[0];
    description.movingCameraFromWorld.reset();
    if (state.ctm.IsAnimated()) description.movingCameraFromWorld = state.ctm;
    TransformPair worldFromCamera = state.ctm;
    for (Mat4d& m : worldFromCamera.at) m = Mat4d(m.inverse());
    coordinateSystems["camera"] = worldFromCamera;
    mediumOfCamera = state.outsideMedium;
}

// Transforms.

void PbrtBuilder::Check() {
    for (const Mat4d& m : state.ctm.at) CheckInvertible(m, loc);
}

void PbrtBuilder::Apply(const Mat4d& m) {
    for (int i : {0, 1})
        if (state.active & (1 << i)) state.ctm.at[i] *= m;
    Check();
}

// Returns the current transform for something that cannot move, in pbrt-v3 neither.
const Mat4d& PbrtBuilder::StaticTransform(const char* owner) {
    if (state.ctm.IsAnimated())
        warnings.Add(loc, "motion ignored",
                     std::string(owner) + " does not move; it is where it is at the start");
    return state.ctm.at[0];
}

void PbrtBuilder::ActiveTransform() {
    const Token token = lexer.Take();
    if (token.kind == TokenKind::Word && token.text == "All")
        state.active = kAllTimes;
    else if (token.kind == TokenKind::Word && token.text == "StartTime")
        state.active = kStartTime;
    else if (token.kind == TokenKind::Word && token.text == "EndTime")
        state.active = kEndTime;
    else
        throw Error(token.loc,
                    "ActiveTransform takes All, StartTime or EndTime, not " + Describe(token));
}

void PbrtBuilder::Identity() {
    for (int i : {0, 1})
        if (state.active & (1 << i)) state.ctm.at[i].setIdentity();
}

void PbrtBuilder::Translate() {
    const auto [x, y, z] = ReadNumbers<3>();
    Apply(TranslateMatrix(x, y, z));
}

void PbrtBuilder::Scale() {
    const auto [x, y, z] = ReadNumbers<3>();
    Apply(ScaleMatrix(x, y, z, loc));
}

void PbrtBuilder::Rotate() {
    const auto [degrees, x, y, z] = ReadNumbers<4>();
    Apply(RotateMatrix(degrees, {x, y, z}, loc));
}

void PbrtBuilder::LookAt() {
    const auto v = ReadNumbers<9>();
    Apply(LookAtMatrix({v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}, loc));
}

void PbrtBuilder::ConcatTransform() { Apply(ReadMatrix()); }

void PbrtBuilder::Transform() {
    const Mat4d m = ReadMatrix();
    for (int i : {0, 1})
        if (state.active & (1 << i)) state.ctm.at[i] = m;
    Check();
}

void PbrtBuilder::CoordinateSystem() {
    const std::string name = ReadString("the name of a coordinate system");
    coordinateSystems[name] = state.ctm;
}

void PbrtBuilder::CoordSysTransform() {
    const std::string name = ReadString("the name of a coordinate system");
    const auto it = coordinateSystems.find(name);
    if (it == coordinateSystems.end())
        return SubstituteName("coordinate system \"" + Printable(name) +
                                  "\" is unknown; name it with CoordinateSystem before",
                              "the transform stays as it is");
    state.ctm = it->second;
}

}  // namespace lull
