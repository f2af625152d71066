// Reads entities of pbrt-v4: film, camera, filter, sampler and integrator here.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "renderer/input/pbrt/v4.h"
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
        const Parameter* parameter = given.Find(type, name);
        if (!parameter) continue;
        const FileLoc& loc = parameter->loc;
        if (const auto* names = std::get_if<std::vector<std::string>>(&parameter->values)) {
            if (names->size() != 1) throw Error(loc, "\"{}\" has to name one spectrum", name);
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
        throw Error(loc, "\"{}\" has {} numbers; it needs {}", name, values.size(),
                    type == ParameterType::Blackbody ? "one, in kelvin" : "three");
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
    const Parameter* rgb = given.Find(ParameterType::Spectrum, name);
    if (isSrgb && rgb && (color > 1).any())
        throw Error(rgb->loc, "\"rgb {}\" has a part above 1; a reflectance lies between 0 and 1",
                    name);
    return color.max(0.f).min(1.f);
}

void V4Reader::Ignore(std::initializer_list<const char*> names) const {
    for (const char* name : names)
        for (const Parameter& parameter : given.All())
            if (parameter.name == name) parameter.lookedUp = true;
}

void V4Reader::Copy(ParameterType type, const char* name, const char* to) {
    const Parameter* parameter = given.Find(type, name);
    if (!parameter) return;
    Parameter copy = *parameter;
    copy.name = to;
    copy.lookedUp = false;
    written.Add(std::move(copy));
}

void V4Reader::Copy(ParameterType type, std::initializer_list<const char*> names) {
    for (const char* name : names) Copy(type, name, name);
}

void V4Reader::Move(ParameterType type, std::initializer_list<const char*> names) {
    for (const char* name : names)
        if (std::optional<Parameter> parameter = from.parameters.Take(type, name)) {
            parameter->lookedUp = false;
            written.Add(std::move(*parameter));
        }
}

void V4Reader::CopyFloat(const char* name, const char* to) {
    Copy(ParameterType::Float, name, to ? to : name);
    Copy(ParameterType::Texture, name, to ? to : name);
}

void V4Reader::CopyReflectance(const char* name, const char* to, float otherwise) {
    if (const TextureRef* texture = given.GetTexture(name))
        write.Texture(to, *texture);
    else
        write.Spectrum(to, Reflectance(name, Rgb::Constant(otherwise)));
}

void V4Reader::CopySurface(const char* name, const char* to) {
    if (const TextureRef* texture = given.GetTexture(name))
        write.Texture(to, *texture);
    else if (Spectrum(name))
        write.Spectrum(to, Surface(name, Rgb::Ones()));
}

TextureRef V4Reader::AddImage(const std::string& file, bool isData) const {
    TextureEntity image;
    image.name = "imagemap";
    image.loc = from.loc;
    image.isSpectrum = true;
    image.textureName = file;
    const ParameterWriter of(&image.parameters, from.loc);
    of.String("filename", file);
    if (isData) of.String("encoding", "linear");
    context.description.textures.push_back(std::move(image));
    return {file, -1, int(context.description.textures.size()) - 1};
}

Entity V4Reader::Finish(const std::string& name, const std::string& owner) {
    for (const Parameter& parameter : given.All())
        if (!parameter.lookedUp)
            throw Error(parameter.loc, "{} has no parameter \"{} {}\" in pbrt-v4{}", owner,
                        NameOf(parameter.type), Printable(parameter.name),
                        given.Mistyped(parameter.name));
    return {name, std::move(written), from.loc};
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

Entity TranslateV4(const V4Context& context, Entity entity) {
    using Translate = Entity (*)(V4Reader&);
    // By EntityKind.
    constexpr Translate kTranslations[] = {
        TranslateCamera,   TranslateFilm,      TranslateFilter,  TranslateIntegrator,
        TranslateSampler,  TranslateAreaLight, TranslateShape,   TranslateLight,
        TranslateMaterial, TranslateMedium,    TranslateTexture, TranslateTexture};
    V4Reader in(context, entity);
    return kTranslations[size_t(context.kind)](in);
}

// Film, camera, filter, sampler and integrator.

namespace {

constexpr std::string_view kSensors[] = {
    "cie1931",           "canon_eos_100d",      "canon_eos_1dx_mkii",
    "canon_eos_200d",    "canon_eos_200d_mkii", "canon_eos_5d",
    "canon_eos_5d_mkii", "canon_eos_5d_mkiii",  "canon_eos_5d_mkiv",
    "canon_eos_5ds",     "canon_eos_m",         "hasselblad_l1d_20c",
    "nikon_d810",        "nikon_d850",          "sony_ilce_6400",
    "sony_ilce_7m3",     "sony_ilce_7rm3",      "sony_ilce_9"};

}  // namespace

Entity TranslateFilm(V4Reader& in) {
    RefuseKindOfV3("Film", in.Name(), in.Loc());
    if (in.Name() != "rgb" && in.Name() != "gbuffer" && in.Name() != "spectral")
        in.Fail(fmt::format("Film \"{}\" is unknown; rgb, gbuffer and spectral are",
                            Printable(in.Name())));
    if (in.Name() == "spectral")
        in.Warn("Film \"spectral\" is rendered as \"rgb\": its wavelengths are not kept");
    if (in.Name() == "gbuffer") in.given.GetString("coordinatesystem", "");
    in.Copy(ParameterType::Integer, {"xresolution", "yresolution", "pixelbounds"});
    in.Copy(ParameterType::Float, {"cropwindow", "diagonal"});
    in.write.String("filename", in.given.GetString("filename", "pbrt.exr"));
    in.write.Float("scale", in.given.GetFloat("iso", 100) / 100);
    in.Copy(ParameterType::Float, {"maxcomponentvalue"});
    in.Ignore({"savefp16", "nbuckets", "lambdamin", "lambdamax"});
    const std::string sensor = in.given.GetString("sensor", "cie1931");
    if (std::ranges::count(kSensors, sensor) == 0)
        in.Fail(fmt::format("the sensor \"{}\" is unknown", Printable(sensor)));
    if (sensor != "cie1931")
        in.Warn(
            "a camera's sensor has no effect: in RGB it is that of the eye, but for 2 to 4 % "
            "of a saturated colour");
    const float kelvin = in.given.GetFloat("whitebalance", 0);
    const bool isNeutral = kelvin == 0 || (kelvin == 6500 && sensor != "cie1931");
    if (!isNeutral) {
        if (!(kelvin >= 1000 && kelvin <= 25000))
            in.Fail(fmt::format("\"whitebalance\" is {:g} kelvin; it has to be from 1000 to 25000",
                                kelvin));
        const Mat3f m = WhiteBalance(kelvin);
        std::vector<float> rows;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) rows.push_back(m(i, j));
        in.write.Floats(ParameterType::Float, "colormatrix", std::move(rows));
    }
    return in.Finish("image", "Film");
}

Entity TranslateCamera(V4Reader& in) {
    in.Copy(ParameterType::Float, {"shutteropen", "shutterclose"});
    const std::string& name = in.Name();
    const std::string owner = "Camera \"" + Printable(name) + "\"";
    if (name == "realistic") {
        in.Copy(ParameterType::String, {"lensfile"});
        in.Copy(ParameterType::Float, {"aperturediameter", "focusdistance"});
        if (!in.given.GetString("aperture", "").empty())
            in.Warn("\"aperture\" has no effect: the stop of the lens is round");
        in.write.Bool("simpleweighting", true);
        return in.Finish(name, owner);
    }
    in.Copy(ParameterType::Float, {"frameaspectratio", "screenwindow"});
    if (name == "spherical") {
        in.Ignore({"lensradius", "focaldistance"});
        const std::string mapping = in.given.GetString("mapping", "equalarea");
        if (mapping != "equalarea" && mapping != "equirectangular")
            in.Fail(fmt::format("the mapping \"{}\" is unknown; equalarea and equirectangular are",
                                Printable(mapping)));
        return in.Finish(mapping == "equalarea" ? "equalarea" : "environment", owner);
    }
    RefuseKindOfV3("Camera", name, in.Loc());
    if (name == "stereoscopic") {
        // Of the laboratory's fork: parallel eyes, both unless one is named.
        in.Copy(ParameterType::Float, {"lensradius", "focaldistance", "fov"});
        in.write.Float("eyedistance", in.given.GetFloat("eyeDistance", 0.065f));
        in.write.String("eye", in.given.GetString("view", ""));
        return in.Finish("perspective", owner);
    }
    if (name != "perspective" && name != "orthographic")
        in.Fail(fmt::format("{} is unknown; perspective, orthographic, spherical and realistic are",
                            owner));
    in.Copy(ParameterType::Float, {"lensradius", "focaldistance"});
    if (name == "perspective") in.Copy(ParameterType::Float, {"fov"});
    return in.Finish(name, owner);
}

Entity TranslateFilter(V4Reader& in) {
    struct Kind {
        std::string_view name;
        float radius;
    };
    constexpr Kind kKinds[] = {
        {"box", 0.5f}, {"gaussian", 1.5f}, {"mitchell", 2}, {"sinc", 4}, {"triangle", 2}};
    const Kind* kind = std::ranges::find(kKinds, std::string_view(in.Name()), &Kind::name);
    if (kind == std::end(kKinds))
        in.Fail(
            fmt::format("PixelFilter \"{}\" is unknown; box, gaussian, mitchell, sinc and "
                        "triangle are",
                        Printable(in.Name())));
    in.write.Float("xwidth", in.given.GetFloat("xradius", kind->radius));
    in.write.Float("ywidth", in.given.GetFloat("yradius", kind->radius));
    if (in.Name() == "gaussian")
        in.write.Float("alpha", 0.5f / Sqr(in.given.GetFloat("sigma", 0.5f)));
    if (in.Name() == "mitchell") in.Copy(ParameterType::Float, {"B", "C"});
    if (in.Name() == "sinc") in.Copy(ParameterType::Float, {"tau"});
    return in.Finish(in.Name(), "PixelFilter");
}

// All that are no independent samples are of one kind here.
Entity TranslateSampler(V4Reader& in) {
    const std::string& name = in.Name();
    in.Ignore({"seed", "randomization"});
    if (name == "stratified") {
        in.write.Int("pixelsamples",
                     in.given.GetInt("xsamples", 4) * in.given.GetInt("ysamples", 4));
        in.given.GetBool("jitter", true);
        return in.Finish("sobol", "Sampler \"stratified\"");
    }
    constexpr std::string_view kKnown[] = {"halton", "paddedsobol", "pmj02bn", "sobol", "zsobol"};
    const bool isIndependent = name == "independent";
    RefuseKindOfV3("Sampler", name, in.Loc());
    if (!isIndependent && std::ranges::count(kKnown, name) == 0)
        in.Fail(
            fmt::format("Sampler \"{}\" is unknown in pbrt-v4; halton, independent, "
                        "paddedsobol, pmj02bn, sobol, stratified and zsobol are",
                        Printable(name)));
    in.write.Int("pixelsamples", in.given.GetInt("pixelsamples", isIndependent ? 4 : 16));
    return in.Finish(isIndependent ? "random" : "sobol", "Sampler \"" + name + "\"");
}

Entity TranslateIntegrator(V4Reader& in) {
    struct Kind {
        std::string_view name;
        const char* as;
        bool isSame;  // paths of the same kind
    };
    constexpr Kind kKinds[] = {{"bdpt", "bdpt", true},
                               {"lightpath", "bdpt", false},
                               {"mlt", "bdpt", false},
                               {"path", "path", true},
                               {"randomwalk", "path", false},
                               {"simplepath", "path", true},
                               {"simplevolpath", "volpath", true},
                               {"sppm", "bdpt", false},
                               {"volpath", "volpath", true}};
    const Kind* kind = std::ranges::find(kKinds, std::string_view(in.Name()), &Kind::name);
    if (kind == std::end(kKinds))
        in.Fail(
            fmt::format("Integrator \"{}\" is not supported; path, volpath, bdpt, simplepath, "
                        "simplevolpath, randomwalk, lightpath, mlt and sppm are",
                        Printable(in.Name())));
    in.write.Int("maxdepth", in.given.GetInt("maxdepth", 5));
    if (in.given.GetBool("regularize", false))
        in.Warn("\"regularize\" has no effect: it would blur reflections of reflections");
    if (!kind->isSame)
        in.Warn(fmt::format("Integrator \"{}\" is rendered as \"{}\"", in.Name(), kind->as));
    in.Ignore(
        {"lightsampler", "samplelights", "samplebsdf", "visualizestrategies", "visualizeweights"});
    if (!kind->isSame)
        for (const Parameter& parameter : in.given.All()) parameter.lookedUp = true;
    return in.Finish(kind->as, "Integrator \"" + in.Name() + "\"");
}

void SetV4Defaults(Description* d) {
    Warnings none;
    const GraphicsState state;
    const auto set = [&](EntityKind kind, const char* name, Entity* entity) {
        *entity = TranslateV4({kind, *d, state, none}, Entity{name, {}, {}});
    };
    set(EntityKind::Film, "rgb", &d->film);
    set(EntityKind::Camera, "perspective", &d->camera);
    set(EntityKind::Filter, "gaussian", &d->filter);
    set(EntityKind::Sampler, "zsobol", &d->sampler);
    set(EntityKind::Integrator, "volpath", &d->integrator);
}

void SetExposureOfV4(Description* d) {
    const Parameters& camera = d->camera.parameters;
    const float seconds = camera.GetFloat("shutterclose", 1) - camera.GetFloat("shutteropen", 0);
    if (seconds == 1) return;
    const float scale = d->film.parameters.GetFloat("scale", 1) * seconds;
    if (!(scale > 0))
        throw Error(d->camera.loc, "the shutter is open for {:g} s, so that the image is black",
                    seconds);
    ParameterWriter(&d->film.parameters, d->film.loc).Float("scale", scale);
}

}  // namespace lull
