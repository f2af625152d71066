// Evaluates textures: functions from a point of a surface to a float or an RGB.
#pragma once

#include <vector>

#include "renderer/base/math.h"
#include "renderer/input/description.h"
#include "renderer/scene/interaction.h"

namespace lull {

// Inputs of a texture. As in pbrt-v3, noise leaves out octaves finer than the
// distance between samples, which is 0, for full detail, if it is not known.
struct TextureContext {
    Vec3f p;  // world
    Vec2f uv;
    // Of p, from one sample to the next across and down the image.
    Vec3f dpdx = Vec3f::Zero(), dpdy = Vec3f::Zero();
    const Vec3f* n = nullptr;  // the surface's normal, where it is known
};

// Refers to a texture of a TextureTable, or is a constant, which is evaluated without a look-up.
template <typename T>
struct TextureHandle {
    T constant;
    int index = -1;  // into the table; -1: constant

    bool IsConstant() const { return index < 0; }
};
using FloatTexture = TextureHandle<float>;
using SpectrumTexture = TextureHandle<Rgb>;

struct FloatTextureNode;  // a variant of all kinds each, in texture.cpp
struct SpectrumTextureNode;

// Owns the textures and images of a scene. Immutable once made; evaluation is thread-safe.
class TextureTable {
  public:
    // Makes every texture of the description; warns of parameters without effect. Constant 1
    // substitutes an unsupported kind, pbrt-v3's grey an unreadable image.
    TextureTable(const Description&, Warnings&);
    TextureTable();  // empty
    ~TextureTable();
    TextureTable(TextureTable&&) noexcept;
    TextureTable& operator=(TextureTable&&) noexcept;

    // Read parameter `name`: a texture, a constant of the same type, or `otherwise`. Textures that
    // are constant throughout are returned as constants. Throw Error for unknown textures.
    FloatTexture GetFloat(const Entity&, const std::string& name, float otherwise) const;
    SpectrumTexture GetSpectrum(const Entity&, const std::string& name, const Rgb& otherwise) const;
    // Returns nothing if the parameter is absent.
    std::optional<FloatTexture> GetFloatOrNone(const Entity&, const std::string& name) const;

    float Evaluate(const FloatTexture& t, const TextureContext& c) const {
        return t.IsConstant() ? t.constant : EvaluateFloat(t.index, c);
    }
    Rgb Evaluate(const SpectrumTexture& t, const TextureContext& c) const {
        return t.IsConstant() ? t.constant : EvaluateSpectrum(t.index, c);
    }

    // Return the inputs of a texture beyond p, in terms of kNeedsUv and kNeedsFootprint.
    SurfaceNeeds Needs(const FloatTexture&) const;
    SurfaceNeeds Needs(const SpectrumTexture&) const;

    size_t Bytes() const { return imageBytes; }

  private:
    float EvaluateFloat(int index, const TextureContext&) const;
    Rgb EvaluateSpectrum(int index, const TextureContext&) const;

    std::vector<FloatTextureNode> floats;
    std::vector<SpectrumTextureNode> spectra;
    // The texture of each index in the description.
    std::vector<FloatTexture> madeFloats;
    std::vector<SpectrumTexture> madeSpectra;
    size_t imageBytes = 0;
};

}  // namespace lull
