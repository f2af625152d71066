// Sums up the squares of the samples' luminance, which tell the noise of pixels.
#pragma once

#include <variant>

#include "renderer/base/color.h"
#include "renderer/film/layer.h"

namespace lull {

class SquareLayer {
  public:
    static bool IsWanted(const LayerOptions& o) { return o.features || o.aovs.noise; }
    static int64_t Bytes(const LayerOptions& o) {
        return int64_t(o.features ? sizeof(float) : sizeof(double));
    }
    static int Channels(const LayerOptions& o) { return o.aovs.noise ? 2 : 0; }
    // The denoiser, which has little use for the rest of a double, halves the memory.
    SquareLayer(const PixelRect& region, const LayerOptions& o)
        : plane(o.features ? Plane(PixelPlane<float>(region)) : Plane(PixelPlane<double>(region))) {
    }

    static bool NeedsFirstHits(const LayerOptions&) { return false; }
    void Add(const Vec2i& p, const PathSample& sample) {
        if (auto* floats = std::get_if<PixelPlane<float>>(&plane))
            floats->At(p) += Sqr(Luminance(sample.radiance));
        else
            std::get<PixelPlane<double>>(plane).At(p) += Sqr(double(Luminance(sample.radiance)));
    }
    void AddSplats(const Vec2i& p, const PixelSplats& splats) {
        std::visit(
            [&](auto& sums) {
                auto& sum = sums.At(p);
                sum += std::remove_reference_t<decltype(sum)>(splats.all.Squares());
            },
            plane);
    }
    static std::string Identity(const LayerOptions&) { return ""; }
    template <typename Self, typename Visit>
    static void ForEachPlane(Self& self, const Visit& visit) {
        const char* name = self.plane.index() == 0 ? "noise for the denoiser" : "noise";
        std::visit([&](auto& sums) { visit(name, sums); }, self.plane);
    }

    double At(const Vec2i& p) const {
        return std::visit([&](const auto& sums) { return double(sums.At(p)); }, plane);
    }

  private:
    using Plane = std::variant<PixelPlane<float>, PixelPlane<double>>;
    Plane plane;
};

}  // namespace lull
