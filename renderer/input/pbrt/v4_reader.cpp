#include "renderer/input/pbrt/v4_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/input/spectrum.h"
#include "stopping/base/input_file.h"

namespace lull {
namespace {

constexpr ParameterType kSpectrumTypes[] = {ParameterType::Spectrum, ParameterType::SpectrumName,
                                            ParameterType::SpectrumSamples,
                                            ParameterType::Blackbody};

}  // namespace

std::optional<V4Spectrum> V4Reader::Spectrum(const char* name) const {
    for (const ParameterType type : kSpectrumTypes) {
        const Parameter* parameter = from.parameters.Find(type, name);
        if (!parameter) continue;
        const FileLoc& loc = parameter->loc;
        if (const auto* names = std::get_if<std::vector<std::string>>(&parameter->values)) {
            if (names->size() != 1)
                throw Error(loc, fmt::format("\"{}\" has to name one spectrum", name));
            if (IsNamedSpectrum((*names)[0])) return NamedSpectrum{(*names)[0]};
            const std::string path = ResolvePath(context.description, (*names)[0]);
            return SampledSpectrumOf(ReadNumberFile(path, "spectrum", loc), loc);
        }
        const auto& values = std::get<std::vector<float>>(parameter->values);
        if (type == ParameterType::SpectrumSamples) return SampledSpectrumOf(values, loc);
        if (type == ParameterType::Blackbody && values.size() == 1)
            return BlackbodySpectrum{values[0]};
        if (type == ParameterType::Spectrum && values.size() == 3)
            return Rgb(values[0], values[1], values[2]);
        throw Error(loc,
                    fmt::format("\"{}\" has {} numbers; it needs {}", name, values.size(),
                                type == ParameterType::Blackbody ? "one, in kelvin" : "three"));
    }
    return {};
}

Rgb V4Reader::Light(const char* name, const Rgb& otherwise) const {
    const auto spectrum = Spectrum(name);
    return spectrum ? RgbOfLight(*spectrum, from.loc) : otherwise;
}

Rgb V4Reader::Surface(const char* name, const Rgb& otherwise) const {
    const auto spectrum = Spectrum(name);
    return spectrum ? RgbOfSurface(*spectrum, from.loc) : otherwise;
}

Rgb V4Reader::Reflectance(const char* name, const Rgb& otherwise) const {
    const Rgb color = Surface(name, otherwise);
    const bool isSrgb = context.state.rgbFromColorSpace == Mat3f::Identity();
    if (isSrgb && Has(ParameterType::Spectrum, name) && (color > 1).any())
        throw Error(
            from.parameters.Find(ParameterType::Spectrum, name)->loc,
            fmt::format("\"rgb {}\" has a part above 1; a reflectance lies between 0 and 1", name));
    return color.max(0.f).min(1.f);
}

void V4Reader::Ignore(std::initializer_list<const char*> names) const {
    for (const char* name : names)
        for (const Parameter& parameter : from.parameters.All())
            if (parameter.name == name) parameter.lookedUp = true;
}

void V4Reader::Copy(ParameterType type, const char* name, const char* to) {
    const Parameter* parameter = from.parameters.Find(type, name);
    if (!parameter) return;
    Parameter copy = *parameter;
    copy.name = to ? to : name;
    copy.lookedUp = false;
    written.Add(std::move(copy));
}

void V4Reader::CopyFloat(const char* name, const char* to) {
    Copy(ParameterType::Float, name, to);
    Copy(ParameterType::Texture, name, to);
}

void V4Reader::CopyReflectance(const char* name, const char* to, float otherwise) {
    if (const TextureRef* texture = Texture(name))
        SetTexture(to, *texture);
    else
        Set(to, Reflectance(name, Rgb::Constant(otherwise)));
}

TextureRef V4Reader::AddImage(const std::string& file, bool isData) const {
    TextureEntity image;
    image.name = "imagemap";
    image.loc = from.loc;
    image.isSpectrum = true;
    image.textureName = file;
    image.parameters.Add({ParameterType::String, "filename", from.loc, std::vector{file}});
    if (isData)
        image.parameters.Add(
            {ParameterType::String, "encoding", from.loc, std::vector<std::string>{"linear"}});
    context.description.textures.push_back(std::move(image));
    return {file, -1, int(context.description.textures.size()) - 1};
}

Entity V4Reader::Finish(const std::string& name, const std::string& owner) const {
    for (const Parameter& parameter : from.parameters.All())
        if (!parameter.lookedUp)
            throw Error(parameter.loc,
                        fmt::format("{} has no parameter \"{} {}\" in pbrt-v4{}", owner,
                                    NameOf(parameter.type), Printable(parameter.name),
                                    from.parameters.Mistyped(parameter.name)));
    return {name, written, from.loc};
}

void AddPresets(const Parameters& presets, Parameters* parameters) {
    for (const Parameter& preset : presets.All()) {
        const bool isGiven = std::ranges::any_of(
            parameters->All(), [&](const Parameter& p) { return p.name == preset.name; });
        if (isGiven) continue;
        Parameter added = preset;
        added.lookedUp = true;
        parameters->Add(std::move(added));
    }
}

Entity TranslateV4(const V4Context& context, const Entity& entity) {
    const V4Reader in(context, entity);
    switch (context.kind) {
        case EntityKind::Material:
            return TranslateMaterial(in);
        case EntityKind::Light:
            return TranslateLight(in);
        case EntityKind::AreaLight:
            return TranslateAreaLight(in);
        case EntityKind::FloatTexture:
        case EntityKind::SpectrumTexture:
            return TranslateTexture(in, context.kind == EntityKind::SpectrumTexture);
        case EntityKind::Shape:
            return TranslateShape(in);
        case EntityKind::Medium:
            return TranslateMedium(in);
        default:
            return TranslateOption(in);
    }
}

}  // namespace lull
