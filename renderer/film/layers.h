// What a render sums up in addition to the colours of the film: a closed set of kinds. Each has
//
//   static bool IsWanted(const LayerOptions&)
//   static int Channels(const LayerOptions&)
//       the floats a pixel that its channels take until they are written, where it is wanted
//   Kind(const PixelRect& region, const LayerOptions&)
//   static bool NeedsFirstHits(const LayerOptions&)
//       whether Add() reads PathSample::hit
//   void Add(const Vec2i&, const PathSample&)
//       called in the order of the samples, by several threads for different pixels
//   static void ForEachPlane(self, visit)
//       calls visit(name, plane) for each PixelPlane that it consists of, whose name no other kind
//       has: what checkpoints save, ranks send and clocks undo
//   static std::string Identity(const LayerOptions&)
//       in words, what else decides the sums: a render continues only where it is the same
//   void AddSplats(const Vec2i&, const PixelSplats&)
//       if light paths add to it
//
// Its channels in an EXR are made by ChannelsOf() (results/layer_channels.h). The loops over kinds
// are resolved at compile time; those that are not wanted cost a comparison a sample.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "renderer/film/first_hit_layer.h"

namespace lull {

// Sums up the light of groups of lights.

class LightGroupLayer {
  public:
    static bool IsWanted(const LayerOptions& o) { return o.groups.Count() > 0; }
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
    // Returns a pixel of a group, with the film's sample count. Without noise, `halfSum` is 0.
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

class Layers {
  public:
    Layers() = default;
    Layers(const PixelRect& region, const LayerOptions& wanted) : options(wanted) {
        const auto make = [&]<typename Kind>(std::optional<Kind>& kind) {
            if (Kind::IsWanted(options)) kind.emplace(region, options);
        };
        std::apply([&](auto&... kind) { (..., make(kind)); }, kinds);
    }
    // Return the memory that a pixel takes, and what its channels take in the end.
    static int64_t Bytes(const LayerOptions& wanted) {
        int64_t bytes = 0;
        Layers(PixelRect(), wanted).ForEach([&]<typename Kind>(const Kind& kind) {
            Kind::ForEachPlane(kind, [&](const char*, const auto& plane) {
                bytes += plane.Bytes({{0, 0}, {1, 1}});
            });
        });
        return bytes;
    }
    static int64_t ChannelBytes(const LayerOptions& wanted) {
        int64_t bytes = 0;
        Layers(PixelRect(), wanted).ForEach([&]<typename Kind>(const Kind&) {
            bytes += Kind::Channels(wanted) * int64_t(sizeof(float));
        });
        return bytes;
    }

    const LayerOptions& Options() const { return options; }
    // Return a kind; null: it is not there.
    template <typename Kind>
    const Kind* Find() const {
        const auto& kind = std::get<std::optional<Kind>>(kinds);
        return kind ? &*kind : nullptr;
    }
    template <typename Kind>
    Kind* Find() {
        return const_cast<Kind*>(std::as_const(*this).Find<Kind>());
    }
    // Call visit(kind) for each kind that is there.
    template <typename Visit>
    void ForEach(const Visit& visit) const {
        std::apply([&](auto&... kind) { (..., (kind ? visit(*kind) : void())); }, kinds);
    }
    template <typename Visit>
    void ForEach(const Visit& visit) {
        std::apply([&](auto&... kind) { (..., (kind ? visit(*kind) : void())); }, kinds);
    }

    bool IsEmpty() const {
        return std::apply([](const auto&... kind) { return (... && !kind); }, kinds);
    }
    bool NeedFirstHits() const {
        bool needed = false;
        ForEach([&]<typename Kind>(const Kind&) { needed |= Kind::NeedsFirstHits(options); });
        return needed;
    }
    void Add(const Vec2i& p, const PathSample& sample) {
        ForEach([&](auto& kind) { kind.Add(p, sample); });
    }
    // Free what the denoiser alone reads: of the rows [y0, y1), most of it; and all.
    void ForgetFeatures(int y0, int y1) {
        if (auto* hits = Find<FirstHitLayer>()) hits->ForgetFeatures(options, y0, y1);
    }
    void ForgetFeatures() {
        if (auto* hits = Find<FirstHitLayer>()) hits->ForgetFeatures(options);
        std::get<std::optional<EmissionLayer>>(kinds).reset();
        if (!options.aovs.noise) std::get<std::optional<SquareLayer>>(kinds).reset();
    }

  private:
    LayerOptions options;
    std::tuple<std::optional<FirstHitLayer>, std::optional<SquareLayer>,
               std::optional<EmissionLayer>, std::optional<MatteLayer>,
               std::optional<LightGroupLayer>>
        kinds;
};

}  // namespace lull
