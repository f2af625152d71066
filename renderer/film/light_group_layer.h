// Sums up the light of groups of lights.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <vector>

#include "renderer/base/color.h"
#include "renderer/film/layer.h"
#include "renderer/film/pixel_plane.h"

namespace lull {

class LightGroupLayer {
  public:
    static bool IsWanted(const LayerOptions& o) { return o.groups.Count() > 0; }
    static int64_t Bytes(const LayerOptions& o) {
        return o.groups.Count() * int64_t(sizeof(Sum) * (o.groupBackground ? 2 : 1) +
                                          (o.groupNoise ? sizeof(Noise) : 0));
    }
    static int Channels(const LayerOptions& o) { return 2 * 3 * o.groups.Count(); }
    LightGroupLayer(const PixelRect& region, const LayerOptions& o) {
        for (int i = 0; i < o.groups.Count(); ++i) planes.emplace_back(region, i, o);
    }

    static bool NeedsFirstHits(const LayerOptions& o) { return o.groupBackground; }
    void Add(const Vec2i& p, const PathSample& sample) {
        const std::span<const Rgb> light = sample.groups->All();
        for (size_t i = 0; i < planes.size(); ++i)
            planes[i].Add(p, InHalf(sample.index), light[i], sample.hit.found);
    }
    void AddSplats(const Vec2i& p, const PixelSplats& splats) {
        for (size_t i = 0; i < planes.size(); ++i) planes[i].AddSplats(p, splats.groups[i]);
    }
    static std::string Identity(const LayerOptions& o) { return TextOf(o.groups); }
    template <typename Self, typename Visit>
    static void ForEachPlane(Self& self, const Visit& visit) {
        for (auto& plane : self.planes) {
            visit(plane.name.c_str(), plane.sums);
            if (plane.noise) visit((plane.name + " noise").c_str(), *plane.noise);
            if (plane.backgrounds) visit((plane.name + " background").c_str(), *plane.backgrounds);
        }
    }

    int Count() const { return int(planes.size()); }
    // Returns a pixel of a group: its sums, and the sample count that the film has. Without noise,
    // `halfSum` is 0.
    FilmPixel At(int group, const Vec2i& p, uint32_t count) const {
        const Planes& plane = planes[size_t(group)];
        FilmPixel pixel{.sum = plane.sums.At(p), .count = count};
        if (plane.noise) pixel.halfSum = plane.noise->At(p).halfSum;
        return pixel;
    }
    // Returns the sum of the squares of the samples' luminance; they are kept.
    double SquaresAt(int group, const Vec2i& p) const {
        return planes[size_t(group)].noise->At(p).squares;
    }
    // Returns whether the group has the film's first look, where a pixel has no samples: the last.
    bool HasFirstLook(int group) const { return group + 1 == Count(); }
    // Returns the sum of the light of samples that hit nothing; it is kept.
    const std::array<double, 3>& BackgroundAt(int group, const Vec2i& p) const {
        return planes[size_t(group)].backgrounds->At(p);
    }

  private:
    using Sum = std::array<double, 3>;
    struct Noise {
        Sum halfSum = {};
        double squares = 0;  // of the samples' luminance
    };
    struct Planes {
        std::string name;
        PixelPlane<Sum> sums;
        std::optional<PixelPlane<Noise>> noise;
        std::optional<PixelPlane<Sum>> backgrounds;

        Planes(const PixelRect& region, int index, const LayerOptions& o)
            : name(fmt::format("light group {:02}", index)), sums(region) {
            if (o.groupNoise) noise.emplace(region);
            if (o.groupBackground) backgrounds.emplace(region);
        }
        void Add(const Vec2i& p, bool inHalf, const Rgb& radiance, bool hitsSomething) {
            AddTo(radiance, &sums.At(p));
            if (backgrounds && !hitsSomething) AddTo(radiance, &backgrounds->At(p));
            if (!noise) return;
            Noise& pixel = noise->At(p);
            if (inHalf) AddTo(radiance, &pixel.halfSum);
            pixel.squares += Sqr(double(Luminance(radiance)));
        }
        void AddSplats(const Vec2i& p, const SplatLight& light) {
            for (size_t c = 0; c < 3; ++c) sums.At(p)[c] += light.sum[c];
            if (!noise) return;
            Noise& pixel = noise->At(p);
            for (size_t c = 0; c < 3; ++c) pixel.halfSum[c] += light.halfSum[c];
            pixel.squares += light.Squares();
        }
    };
    static void AddTo(const Rgb& radiance, Sum* sum) {
        for (size_t c = 0; c < 3; ++c) (*sum)[c] += double(radiance[Eigen::Index(c)]);
    }

    std::vector<Planes> planes;  // of each group
};

}  // namespace lull
