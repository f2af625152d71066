#include "renderer/scene/cameras/film_settings.h"
#include "stopping/base/input_file.h"

#include <fmt/format.h>

namespace lull {
namespace {

// Sets the pixels to be rendered.
void SetCrop(const Entity& entity, const FilmOverrides& overrides, FilmSettings* film) {
    std::array<float, 4> crop = {0, 1, 0, 1};
    if (const auto window = entity.parameters.GetFloats(ParameterType::Float, "cropwindow");
        !window.empty()) {
        if (window.size() != 4)
            throw Error(entity.loc, "\"cropwindow\" needs four values: x0 x1 y0 y1");
        std::copy(window.begin(), window.end(), crop.begin());
    }
    if (overrides.crop) crop = *overrides.crop;
    for (int i = 0; i < 2; ++i) {
        // pbrt-v3 swaps limits in the wrong order and clamps them to the image.
        const float lower = std::clamp(std::min(crop[2 * i], crop[2 * i + 1]), 0.f, 1.f);
        const float upper = std::clamp(std::max(crop[2 * i], crop[2 * i + 1]), 0.f, 1.f);
        film->cropMin[i] = int(std::ceil(film->resolution[i] * lower));
        film->cropMax[i] = int(std::ceil(film->resolution[i] * upper));
        if (overrides.cropInPixels) {
            film->cropMin[i] = std::min((*overrides.cropInPixels)[2 * i], film->resolution[i]);
            film->cropMax[i] = std::min((*overrides.cropInPixels)[2 * i + 1], film->resolution[i]);
        }
    }
    if (film->Size().minCoeff() >= 1) return;
    const bool isFromFile = !overrides.crop && !overrides.cropInPixels;
    throw Error(isFromFile ? entity.loc : FileLoc(),
                fmt::format("the crop window holds no pixel of {}x{}", film->resolution.x(),
                            film->resolution.y()));
}

}  // namespace

FilmSettings MakeFilmSettings(const Description& description, const FilmOverrides& overrides,
                              Warnings& warnings) {
    const Entity& entity = description.film;
    if (entity.name != "image")
        throw Error(entity.loc, fmt::format("Film \"{}\" is not supported; only \"image\" is",
                                            Printable(entity.name)));
    const Parameters& params = entity.parameters;
    FilmSettings film;
    film.resolution = {params.GetInt("xresolution", 1280), params.GetInt("yresolution", 720)};
    if (overrides.resolution) film.resolution = *overrides.resolution;
    constexpr int64_t kMaxPixels = int64_t(1) << 28;
    if (film.resolution.minCoeff() < 1 ||
        int64_t(film.resolution.x()) * film.resolution.y() > kMaxPixels)
        throw Error(entity.loc, fmt::format("the resolution is {}x{}; each side has to be at least "
                                            "1 and the image at most {} pixels",
                                            film.resolution.x(), film.resolution.y(), kMaxPixels));

    SetCrop(entity, overrides, &film);
    film.filename = params.GetString("filename", film.filename);
    film.exposure = params.GetFloat("exposure", 0);
    film.scale = params.GetFloat("scale", 1) * std::exp2(film.exposure);
    film.maxSampleLuminance = params.GetFloat("maxsampleluminance", kInfinity);
    if (!(film.scale > 0) || !std::isfinite(film.scale) || !(film.maxSampleLuminance > 0))
        throw Error(entity.loc, "\"scale\" and \"maxsampleluminance\" have to be positive");
    film.diagonal = params.GetFloat("diagonal", 35) * 0.001f;  // millimetres
    if (!(film.diagonal > 0) || !std::isfinite(film.diagonal))
        throw Error(entity.loc, "\"diagonal\" has to be positive");
    params.ReportUnused("Film \"image\"", warnings);
    return film;
}

}  // namespace lull
