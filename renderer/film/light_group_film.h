// Sums up the light of groups of lights.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <vector>

#include "renderer/film/film.h"
#include "renderer/transport/first_hit.h"
#include "renderer/transport/group_radiance.h"

namespace lull {

struct LightGroupOptions {
    bool forDenoiser = false;     // keeps what tells its noise
    bool withBackground = false;  // keeps the light of samples that hit nothing, too
};

// The pixels of the region of a Film, which has their sample counts.
class LightGroupFilm {
  public:
    LightGroupFilm(const PixelRect& region, LightGroups groups, const LightGroupOptions& options)
        : groups(std::move(groups)) {
        for (int i = 0; i < Count(); ++i) planes.emplace_back(region, i, options);
    }
    // Returns the memory that a pixel takes in each group.
    static int64_t BytesOfPixel(const LightGroupOptions& options) {
        return int64_t(sizeof(Sum) * (options.withBackground ? 2 : 1) +
                       (options.forDenoiser ? sizeof(Noise) : 0));
    }

    const LightGroups& Groups() const { return groups; }
    int Count() const { return groups.Count(); }
    const PixelRect& Region() const { return planes.front().sums.Region(); }

    // Adds a sample, which is `inHalf` (InHalf()) or not.
    void Add(const Vec2i& p, bool inHalf, const GroupRadiance& radiance, const FirstHit& hit) {
        for (size_t i = 0; i < planes.size(); ++i)
            planes[i].Add(p, inHalf, radiance.All()[i], hit.found);
    }

    // Returns a pixel of a group: its sums, and the sample count that the film has. Without those
    // for a denoiser, `halfSum` is 0.
    FilmPixel At(int group, const Vec2i& p, uint32_t count) const {
        const Planes& plane = planes[size_t(group)];
        FilmPixel pixel{.sum = plane.sums.At(p), .count = count};
        if (plane.noise) pixel.halfSum = plane.noise->At(p).halfSum;
        return pixel;
    }
    // Returns the sum of the squares of the samples' luminance; they are kept for a denoiser.
    double SquaresAt(int group, const Vec2i& p) const {
        return planes[size_t(group)].noise->At(p).squares;
    }
    // Returns the sum of the light of samples that hit nothing; it is kept.
    const std::array<double, 3>& BackgroundAt(int group, const Vec2i& p) const {
        return planes[size_t(group)].backgrounds->At(p);
    }

    // Calls visit(name, plane) for each plane that the film consists of.
    template <typename Visit>
    void ForEachPlane(const Visit& visit) {
        for (Planes& plane : planes) {
            visit(plane.name.c_str(), plane.sums);
            if (plane.noise) visit((plane.name + "_noise").c_str(), *plane.noise);
            if (plane.backgrounds) visit((plane.name + "_background").c_str(), *plane.backgrounds);
        }
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

        Planes(const PixelRect& region, int index, const LightGroupOptions& options)
            : name(fmt::format("light_{:02}", index)), sums(region) {
            if (options.forDenoiser) noise.emplace(region);
            if (options.withBackground) backgrounds.emplace(region);
        }
        void Add(const Vec2i& p, bool inHalf, const Rgb& radiance, bool hitsSomething) {
            AddTo(radiance, &sums.At(p));
            if (backgrounds && !hitsSomething) AddTo(radiance, &backgrounds->At(p));
            if (!noise) return;
            Noise& pixel = noise->At(p);
            if (inHalf) AddTo(radiance, &pixel.halfSum);
            pixel.squares += Sqr(double(Luminance(radiance)));
        }
    };
    static void AddTo(const Rgb& radiance, Sum* sum) {
        for (size_t c = 0; c < 3; ++c) (*sum)[c] += double(radiance[Eigen::Index(c)]);
    }

    LightGroups groups;
    std::vector<Planes> planes;  // of each group
};

}  // namespace lull
