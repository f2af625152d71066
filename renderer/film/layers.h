// What a render sums up in addition to the colours of the film: a closed set of kinds. Each has
//
//   static bool IsWanted(const LayerOptions&)
//   static int64_t Bytes(const LayerOptions&)
//       the memory that a pixel takes, where it is wanted
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

#include "renderer/base/variant.h"
#include "renderer/film/first_hit_layer.h"
#include "renderer/film/light_group_layer.h"
#include "renderer/film/matte_layer.h"

namespace lull {

class Layers {
  public:
    // No layers.
    Layers() = default;
    Layers(const PixelRect& region, const LayerOptions& wanted) : options(wanted) {
        ForEachOptional(kinds, [&]<typename Kind>(std::optional<Kind>& kind) {
            if (Kind::IsWanted(options)) kind.emplace(region, options);
        });
    }
    // Return the memory that a pixel takes, and what its channels take in the end.
    static int64_t Bytes(const LayerOptions& wanted) {
        return Sum(wanted, []<typename Kind>(const LayerOptions& o) { return Kind::Bytes(o); });
    }
    static int64_t ChannelBytes(const LayerOptions& wanted) {
        return Sum(wanted, []<typename Kind>(const LayerOptions& o) {
            return Kind::Channels(o) * int64_t(sizeof(float));
        });
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
        ForEachPresent(kinds, visit);
    }
    template <typename Visit>
    void ForEach(const Visit& visit) {
        ForEachPresent(kinds, visit);
    }

    bool IsEmpty() const { return AreAllMissing(kinds); }
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
    using Kinds =
        OptionalKinds<FirstHitLayer, SquareLayer, EmissionLayer, MatteLayer, LightGroupLayer>;

    template <typename Count>
    static int64_t Sum(const LayerOptions& wanted, const Count& count) {
        int64_t sum = 0;
        Kinds kinds;
        ForEachOptional(kinds, [&]<typename Kind>(const std::optional<Kind>&) {
            if (Kind::IsWanted(wanted)) sum += count.template operator()<Kind>(wanted);
        });
        return sum;
    }

    LayerOptions options;
    Kinds kinds;
};

}  // namespace lull
