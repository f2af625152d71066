#include "renderer/scene/cameras/film_settings.h"

#include <fmt/format.h>

#include <functional>
#include <numeric>

#include "stopping/base/input_file.h"

namespace lull {
namespace {

void SetCrop(const Entity& entity, const FilmOverrides& overrides, FilmSettings* film) {
    std::array<float, 4> crop = {0, 1, 0, 1};
    if (const auto window = entity.parameters.GetFloats(ParameterType::Float, "cropwindow");
        !window.empty()) {
        if (window.size() != 4)
            throw Error(entity.loc, "\"cropwindow\" needs four values: x0 x1 y0 y1");
        std::copy(window.begin(), window.end(), crop.begin());
    }
    const auto bounds = entity.parameters.GetInts("pixelbounds");  // pbrt-v4's: x0 x1 y0 y1
    if (bounds.size() == 4 &&
        entity.parameters.GetFloats(ParameterType::Float, "cropwindow").empty())
        for (int k = 0; k < 4; ++k)
            crop[size_t(k)] = (float(bounds[size_t(k)]) - 1e-3f) / float(film->resolution[k / 2]);
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
    throw Error(isFromFile ? entity.loc : FileLoc(), "the crop window holds no pixel of {}x{}",
                film->resolution.x(), film->resolution.y());
}

// Evaluates the Mitchell-Netravali filter (1988) at x in [-1, 1], which is two units wide.
float Mitchell(float x, float b, float c) {
    x = std::abs(2 * x);
    if (x > 1)
        return ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x +
                (8 * b + 24 * c)) /
               6;
    return ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + (6 - 2 * b)) / 6;
}

float Sinc(float x) { return std::abs(x) < 1e-5f ? 1 : std::sin(kPi * x) / (kPi * x); }

using AxisFunction = std::function<float(float, float)>;

AxisFunction MakeAxisFunction(const Entity& entity) {
    const Parameters& params = entity.parameters;
    if (entity.name == "gaussian") {
        const float alpha = params.GetFloat("alpha", 2);
        return [=](float x, float r) {
            return std::max(0.f, std::exp(-alpha * x * x) - std::exp(-alpha * r * r));
        };
    }
    if (entity.name == "mitchell") {
        const float b = params.GetFloat("B", 1 / 3.f), c = params.GetFloat("C", 1 / 3.f);
        return [=](float x, float r) { return Mitchell(x / r, b, c); };
    }
    if (entity.name == "triangle")
        return [](float x, float r) { return std::max(0.f, r - std::abs(x)); };
    if (entity.name == "sinc") {
        // As in pbrt-v3 the window has its own width, tau: beyond it lobes come back.
        const float tau = params.GetFloat("tau", 3);
        if (!(tau > 0)) throw Error(entity.loc, "the sinc filter's \"tau\" has to be positive");
        return [=](float x, float) { return Sinc(x) * Sinc(x / tau); };
    }
    throw Error(
        entity.loc,
        "PixelFilter \"{}\" is not supported; box, gaussian, mitchell, sinc and triangle are",
        Printable(entity.name));
}

}  // namespace

FilmSettings MakeFilmSettings(const Description& description, const FilmOverrides& overrides,
                              Warnings& warnings) {
    const Entity& entity = description.film;
    if (entity.name != "image")
        throw Error(entity.loc, "Film \"{}\" is not supported; only \"image\" is",
                    Printable(entity.name));
    const Parameters& params = entity.parameters;
    FilmSettings film;
    film.resolution = {params.GetInt("xresolution", 1280), params.GetInt("yresolution", 720)};
    if (overrides.resolution) film.resolution = *overrides.resolution;
    constexpr int64_t kMaxPixels = int64_t(1) << 28;
    if (film.resolution.minCoeff() < 1 ||
        int64_t(film.resolution.x()) * film.resolution.y() > kMaxPixels)
        throw Error(entity.loc,
                    "the resolution is {}x{}; each side has to be at least 1 and the image at most "
                    "{} pixels",
                    film.resolution.x(), film.resolution.y(), kMaxPixels);

    SetCrop(entity, overrides, &film);
    film.filename = params.GetString("filename", film.filename);
    film.exposure = params.GetFloat("exposure", 0);
    film.scale = params.GetFloat("scale", 1) * std::exp2(film.exposure);
    film.maxSampleLuminance = params.GetFloat("maxsampleluminance", kInfinity);
    film.maxComponent = params.GetFloat("maxcomponentvalue", kInfinity);
    if (const auto m = params.GetFloats(ParameterType::Float, "colormatrix"); m.size() == 9)
        film.colorMatrix = Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(m.data());
    if (!(film.scale > 0) || !std::isfinite(film.scale) || !(film.maxSampleLuminance > 0) ||
        !(film.maxComponent > 0))
        throw Error(entity.loc,
                    "\"scale\", \"maxsampleluminance\" and \"maxcomponentvalue\" have to be "
                    "positive");
    film.diagonal = params.GetFloat("diagonal", 35) * 0.001f;  // millimetres
    if (!(film.diagonal > 0) || !std::isfinite(film.diagonal))
        throw Error(entity.loc, "\"diagonal\" has to be positive");
    params.ReportUnused("Film \"image\"", warnings);
    film.isPair = ReadStereo(description.camera).IsPair();
    return film;
}

Filter::Filter(const Description& description, Warnings& warnings) {
    const Entity& entity = description.filter;
    const Parameters& params = entity.parameters;
    const bool isBox = entity.name == "box", isSinc = entity.name == "sinc";
    const float width = isBox ? 0.5f : isSinc ? 4.f : 2.f;
    radius = {params.GetFloat("xwidth", width), params.GetFloat("ywidth", width)};
    constexpr float kWidest = 1e6f;  // rays so far beside the image are finite
    if (!(radius.minCoeff() > 0 && radius.maxCoeff() <= kWidest))
        throw Error(
            entity.loc,
            "the filter's \"xwidth\" and \"ywidth\" have to be positive and at most {:g} pixels",
            kWidest);

    const AxisFunction evaluate = isBox ? AxisFunction() : MakeAxisFunction(entity);
    params.ReportUnused("PixelFilter \"" + entity.name + "\"", warnings);
    if (isBox) return;

    tabulated = true;
    constexpr int kBins = 1024;
    for (int i = 0; i < 2; ++i) {
        Axis& axis = axes[i];
        std::vector<float> magnitudes(kBins);
        axis.values.resize(kBins);
        for (int k = 0; k < kBins; ++k) {
            axis.values[k] = evaluate((2 * (k + 0.5f) / kBins - 1) * radius[i], radius[i]);
            magnitudes[k] = std::abs(axis.values[k]);
        }
        const double sum = std::accumulate(axis.values.begin(), axis.values.end(), 0.0);
        if (!(sum > 0)) throw Error(entity.loc, "the filter's integral is not positive");
        axis.density = Distribution1D(magnitudes);
        axis.weightScale = float(std::accumulate(magnitudes.begin(), magnitudes.end(), 0.0) / sum);
    }
}

float Filter::Evaluate(const Vec2f& offset) const {
    float product = 1;
    for (int i = 0; i < 2; ++i) {
        const float x = 0.5f * (offset[i] / radius[i] + 1);
        if (!(x >= 0 && x < 1)) return 0;
        product /= 2 * radius[i];
        if (!tabulated) continue;
        const Axis& axis = axes[i];
        const int bin = std::min(int(x * float(axis.values.size())), int(axis.values.size()) - 1);
        product *= std::copysign(axis.weightScale, axis.values[bin]) * axis.density.Pdf(x);
    }
    return product;
}

FilterSample Filter::SampleTable(const Vec2f& u) const {
    FilterSample sample{Vec2f::Zero(), 1};
    for (int i = 0; i < 2; ++i) {
        float pdf;
        int bin;
        const float x = axes[i].density.SampleContinuous(u[i], &pdf, &bin);
        sample.offset[i] = (2 * x - 1) * radius[i];
        // The density is proportional to |f| bin by bin, so only the sign of f is left.
        sample.weight *= std::copysign(axes[i].weightScale, axes[i].values[bin]);
    }
    return sample;
}

}  // namespace lull
