// Evaluates textures: functions from a point of a surface to a float or an RGB.
#pragma once

#include <memory>
#include <vector>

#include "renderer/base/math.h"
#include "renderer/input/description.h"

namespace lull {

// Holds what a texture may depend on. There are no ray differentials: images are filtered
// bilinearly on the finest level, procedural textures are evaluated at full detail.
struct TextureContext {
    Vec3f p;  // world
    Vec2f uv;
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
    // Makes every texture of the description; warns of parameters without effect. Throws Error
    // naming file and line for a kind that is not modelled or an unreadable image. With
    // `substitute` these are counted warnings, and the former becomes constant 1, the latter
    // pbrt-v3's grey.
    TextureTable(const Description&, bool substitute, Warnings&);
    TextureTable();  // empty
    ~TextureTable();
    TextureTable(TextureTable&&) noexcept;
    TextureTable& operator=(TextureTable&&) noexcept;

    // Read parameter `name`: a texture, a constant of the same type, or `otherwise`. Textures
    // that are constant all through come back as constants. Throw Error for unknown textures.
    FloatTexture GetFloat(const Entity&, const std::string& name, float otherwise) const;
    SpectrumTexture GetSpectrum(const Entity&, const std::string& name, const Rgb& otherwise) const;
    // Returns nothing where the parameter is absent.
    std::optional<FloatTexture> GetFloatOrNone(const Entity&, const std::string& name) const;

    float Evaluate(const FloatTexture& t, const TextureContext& c) const {
        return t.IsConstant() ? t.constant : EvaluateFloat(t.index, c);
    }
    Rgb Evaluate(const SpectrumTexture& t, const TextureContext& c) const {
        return t.IsConstant() ? t.constant : EvaluateSpectrum(t.index, c);
    }

    // Says whether a texture reads uv (else only p, or nothing); materials ask for uv only then.
    bool ReadsUv(const FloatTexture&) const;
    bool ReadsUv(const SpectrumTexture&) const;

    // Returns the memory taken by images, in bytes.
    size_t Bytes() const { return imageBytes; }

  private:
    float EvaluateFloat(int index, const TextureContext&) const;
    Rgb EvaluateSpectrum(int index, const TextureContext&) const;

    std::vector<FloatTextureNode> floats;
    std::vector<SpectrumTextureNode> spectra;
    // What each texture of the description became, by its place there.
    std::vector<FloatTexture> madeFloats;
    std::vector<SpectrumTexture> madeSpectra;
    size_t imageBytes = 0;
};

}  // namespace lull
