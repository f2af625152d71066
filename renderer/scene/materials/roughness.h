// Reads roughness parameters and turns them into a microfacet distribution.
#pragma once

#include "renderer/scene/materials/material_inputs.h"

namespace lull {

// The roughness along one tangent; a constant is turned into alpha once.
class RoughnessAxis {
  public:
    RoughnessAxis(const FloatTexture& texture, bool remap) : texture(texture), remap(remap) {
        if (!texture.IsConstant()) return;
        constantIsZero = texture.constant == 0;
        this->texture.constant = ToAlpha(texture.constant);
    }

    // Returns alpha; `isZero` tells whether the roughness itself was 0.
    float Alpha(const MaterialInputs& in, bool* isZero) const {
        if (texture.IsConstant()) {
            *isZero = constantIsZero;
            return texture.constant;
        }
        const float roughness = in(texture);
        *isZero = roughness == 0;
        return ToAlpha(roughness);
    }
    const FloatTexture& Texture() const { return texture; }

  private:
    float ToAlpha(float roughness) const { return remap ? RoughnessToAlpha(roughness) : roughness; }

    FloatTexture texture;  // a constant holds alpha
    bool remap, constantIsZero = false;
};

// The roughness of a surface along both tangents. "remaproughness" (true) says whether the
// parameters are pbrt's perceptual roughness or alpha itself.
class Roughness {
  public:
    Roughness(const MaterialReader& in, const FloatTexture& u, const FloatTexture& v)
        : Roughness(u, v, in.entity.parameters.GetBool("remaproughness", true)) {}
    Roughness(const FloatTexture& u, const FloatTexture& v, bool remap) : u(u, remap), v(v, remap) {
        isIsotropic = u.index == v.index && (!u.IsConstant() || u.constant == v.constant);
    }

    // `isSmooth`, if given, receives whether both were 0, which some materials take as specular.
    TrowbridgeReitz Evaluate(const MaterialInputs& in, bool* isSmooth = nullptr) const {
        bool uIsZero, vIsZero;
        const float alphaU = u.Alpha(in, &uIsZero);
        if (isIsotropic) {
            if (isSmooth) *isSmooth = uIsZero;
            return {alphaU, alphaU};
        }
        const float alphaV = v.Alpha(in, &vIsZero);
        if (isSmooth) *isSmooth = uIsZero && vIsZero;
        return {alphaU, alphaV};
    }

    // Returns whether both tangents always have the same roughness, so that any frame will do.
    bool IsIsotropic() const { return isIsotropic; }

    template <typename F>
    void VisitTextures(F&& f) const {
        f(u.Texture());
        f(v.Texture());
    }

  private:
    RoughnessAxis u, v;
    bool isIsotropic;
};

}  // namespace lull
