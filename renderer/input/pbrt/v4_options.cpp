// Film, camera, filter, sampler and integrator of pbrt-v4.

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "renderer/input/pbrt/v4_reader.h"
#include "stopping/base/input_file.h"

namespace lull {
namespace {

constexpr std::string_view kSensors[] = {
    "cie1931",           "canon_eos_100d",      "canon_eos_1dx_mkii",
    "canon_eos_200d",    "canon_eos_200d_mkii", "canon_eos_5d",
    "canon_eos_5d_mkii", "canon_eos_5d_mkiii",  "canon_eos_5d_mkiv",
    "canon_eos_5ds",     "canon_eos_m",         "hasselblad_l1d_20c",
    "nikon_d810",        "nikon_d850",          "sony_ilce_6400",
    "sony_ilce_7m3",     "sony_ilce_7rm3",      "sony_ilce_9"};

constexpr const char* kDefaultFile = "pbrt.exr";

Entity TranslateFilm(V4Reader in) {
    if (in.Name() == "image") in.Fail("Film \"image\" is pbrt-v3's; pbrt-v4 has \"rgb\"");
    if (in.Name() != "rgb" && in.Name() != "gbuffer" && in.Name() != "spectral")
        in.Fail(fmt::format("Film \"{}\" is unknown; rgb, gbuffer and spectral are",
                            Printable(in.Name())));
    if (in.Name() == "spectral")
        in.Warn("Film \"spectral\" is rendered as \"rgb\": its wavelengths are not kept");
    if (in.Name() == "gbuffer") in.String("coordinatesystem");
    for (const char* name : {"xresolution", "yresolution", "pixelbounds"})
        in.Copy(ParameterType::Integer, name);
    for (const char* name : {"cropwindow", "diagonal"}) in.Copy(ParameterType::Float, name);
    in.SetString("filename", in.String("filename", kDefaultFile));
    in.Set("scale", in.Float("iso", 100) / 100);
    in.Copy(ParameterType::Float, "maxcomponentvalue");
    in.Ignore({"savefp16", "nbuckets", "lambdamin", "lambdamax"});
    const std::string sensor = in.String("sensor", "cie1931");
    if (std::ranges::count(kSensors, sensor) == 0)
        in.Fail(fmt::format("the sensor \"{}\" is unknown", Printable(sensor)));
    if (sensor != "cie1931")
        in.Warn(
            "a camera's sensor has no effect: in RGB it is that of the eye, but for 2 to 4 % "
            "of a saturated colour");
    const float kelvin = in.Float("whitebalance", 0);
    const bool isNeutral = kelvin == 0 || (kelvin == 6500 && sensor != "cie1931");
    if (!isNeutral) {
        if (!(kelvin >= 1000 && kelvin <= 25000))
            in.Fail(fmt::format("\"whitebalance\" is {:g} kelvin; it has to be from 1000 to 25000",
                                kelvin));
        const Mat3f m = WhiteBalance(kelvin);
        std::vector<float> rows;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) rows.push_back(m(i, j));
        in.Add(ParameterType::Float, "colormatrix", rows);
    }
    return in.Finish("image", "Film");
}

Entity TranslateCamera(V4Reader in) {
    for (const char* name : {"shutteropen", "shutterclose"}) in.Copy(ParameterType::Float, name);
    const std::string& name = in.Name();
    const std::string owner = "Camera \"" + Printable(name) + "\"";
    if (name == "realistic") {
        in.Copy(ParameterType::String, "lensfile");
        for (const char* p : {"aperturediameter", "focusdistance"})
            in.Copy(ParameterType::Float, p);
        if (!in.String("aperture").empty())
            in.Warn("\"aperture\" has no effect: the stop of the lens is round");
        in.SetBool("simpleweighting", true);
        return in.Finish(name, owner);
    }
    for (const char* p : {"frameaspectratio", "screenwindow"}) in.Copy(ParameterType::Float, p);
    if (name == "spherical") {
        in.Ignore({"lensradius", "focaldistance"});
        const std::string mapping = in.String("mapping", "equalarea");
        if (mapping != "equalarea" && mapping != "equirectangular")
            in.Fail(fmt::format("the mapping \"{}\" is unknown; equalarea and equirectangular are",
                                Printable(mapping)));
        return in.Finish(mapping == "equalarea" ? "equalarea" : "environment", owner);
    }
    if (name == "environment")
        in.Fail("Camera \"environment\" is pbrt-v3's; pbrt-v4 has \"spherical\"");
    if (name == "stereoscopic") {
        // Of the laboratory's fork: parallel eyes, both unless one is named.
        for (const char* p : {"lensradius", "focaldistance", "fov"})
            in.Copy(ParameterType::Float, p);
        in.Set("eyedistance", in.Float("eyeDistance", 0.065f));
        in.SetString("eye", in.String("view"));
        return in.Finish("perspective", owner);
    }
    if (name != "perspective" && name != "orthographic")
        in.Fail(fmt::format("{} is unknown; perspective, orthographic, spherical and realistic are",
                            owner));
    for (const char* p : {"lensradius", "focaldistance"}) in.Copy(ParameterType::Float, p);
    if (name == "perspective") in.Copy(ParameterType::Float, "fov");
    return in.Finish(name, owner);
}

Entity TranslateFilter(V4Reader in) {
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
    in.Set("xwidth", in.Float("xradius", kind->radius));
    in.Set("ywidth", in.Float("yradius", kind->radius));
    if (in.Name() == "gaussian") in.Set("alpha", 0.5f / Sqr(in.Float("sigma", 0.5f)));
    if (in.Name() == "mitchell")
        for (const char* name : {"B", "C"}) in.Copy(ParameterType::Float, name);
    if (in.Name() == "sinc") in.Copy(ParameterType::Float, "tau");
    return in.Finish(in.Name(), "PixelFilter");
}

// All that are no independent samples are of one kind here.
Entity TranslateSampler(V4Reader in) {
    const std::string& name = in.Name();
    in.Ignore({"seed", "randomization"});
    if (name == "stratified") {
        in.SetInt("pixelsamples", in.Int("xsamples", 4) * in.Int("ysamples", 4));
        in.Bool("jitter", true);
        return in.Finish("sobol", "Sampler \"stratified\"");
    }
    constexpr std::string_view kKnown[] = {"halton", "paddedsobol", "pmj02bn", "sobol", "zsobol"};
    const bool isIndependent = name == "independent";
    if (name == "random") in.Fail("Sampler \"random\" is pbrt-v3's; pbrt-v4 has \"independent\"");
    for (const char* gone : {"02sequence", "lowdiscrepancy", "maxmindist"})
        if (name == gone)
            in.Fail(fmt::format("Sampler \"{}\" is pbrt-v3's; pbrt-v4 has \"zsobol\"", name));
    if (!isIndependent && std::ranges::count(kKnown, name) == 0)
        in.Fail(
            fmt::format("Sampler \"{}\" is unknown in pbrt-v4; halton, independent, "
                        "paddedsobol, pmj02bn, sobol, stratified and zsobol are",
                        Printable(name)));
    in.SetInt("pixelsamples", in.Int("pixelsamples", isIndependent ? 4 : 16));
    return in.Finish(isIndependent ? "random" : "sobol", "Sampler \"" + name + "\"");
}

Entity TranslateIntegrator(V4Reader in) {
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
    in.SetInt("maxdepth", in.Int("maxdepth", 5));
    if (in.Bool("regularize", false))
        in.Warn("\"regularize\" has no effect: it would blur reflections of reflections");
    if (!kind->isSame)
        in.Warn(fmt::format("Integrator \"{}\" is rendered as \"{}\"", in.Name(), kind->as));
    in.Ignore(
        {"lightsampler", "samplelights", "samplebsdf", "visualizestrategies", "visualizeweights"});
    if (!kind->isSame)
        for (const Parameter& parameter : in.All().All()) parameter.lookedUp = true;
    return in.Finish(kind->as, "Integrator \"" + in.Name() + "\"");
}

}  // namespace

Entity TranslateOption(V4Reader in) {
    switch (in.Context().kind) {
        case EntityKind::Film:
            return TranslateFilm(in);
        case EntityKind::Camera:
            return TranslateCamera(in);
        case EntityKind::Filter:
            return TranslateFilter(in);
        case EntityKind::Sampler:
            return TranslateSampler(in);
        default:
            return TranslateIntegrator(in);
    }
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
        throw Error(d->camera.loc, fmt::format("the shutter is open for {:g} s, so that the image "
                                               "is black",
                                               seconds));
    d->film.parameters.Add({ParameterType::Float, "scale", d->film.loc, std::vector<float>{scale}});
}

}  // namespace lull
