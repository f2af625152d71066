// Reads the parameters of a pbrt-v4 entity, and writes those of another.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/input/pbrt/v4.h"

namespace lull {

class V4Reader {
  public:
    V4Reader(const V4Context& context, const Entity& from) : context(context), from(from) {}

    // Read a parameter; it then counts as known.
    float Float(const char* name, float otherwise) const {
        return from.parameters.GetFloat(name, otherwise);
    }
    int Int(const char* name, int otherwise) const {
        return from.parameters.GetInt(name, otherwise);
    }
    bool Bool(const char* name, bool otherwise) const {
        return from.parameters.GetBool(name, otherwise);
    }
    std::string String(const char* name, const std::string& otherwise = "") const {
        return from.parameters.GetString(name, otherwise);
    }
    const TextureRef* Texture(const char* name) const { return from.parameters.GetTexture(name); }
    bool Has(ParameterType type, const char* name) const {
        return from.parameters.Find(type, name) != nullptr;
    }
    // Returns a spectrum parameter that is no texture, nothing where there is none.
    std::optional<V4Spectrum> Spectrum(const char* name) const;
    // Return it, or the given value, as a colour. Reflectances given as RGB above 1 are an error.
    Rgb Light(const char* name, const Rgb& otherwise) const;
    Rgb Surface(const char* name, const Rgb& otherwise) const;
    Rgb Reflectance(const char* name, const Rgb& otherwise) const;

    // Mark parameters as known that have no effect on the image.
    void Ignore(std::initializer_list<const char*> names) const;
    // Warns of a flag that is set and has no effect.
    void Warn(const std::string& what) const { context.warnings.Add(from.loc, what); }
    [[noreturn]] void Fail(const std::string& why) const { throw Error(from.loc, why); }
    // Copy a parameter of the type, or a texture, if there is one, under another name if one is
    // given.
    void Copy(ParameterType type, const char* name, const char* to = nullptr);
    void CopyFloat(const char* name, const char* to = nullptr);
    // Copies a texture, or writes the reflectance or, with `otherwise`, that.
    void CopyReflectance(const char* name, const char* to, float otherwise);

    void Set(const char* name, float value) {
        Add(ParameterType::Float, name, std::vector<float>{value});
    }
    void Set(const char* name, const Rgb& c) {
        Add(ParameterType::Spectrum, name, std::vector<float>{c.x(), c.y(), c.z()});
    }
    void SetInt(const char* name, int value) {
        Add(ParameterType::Integer, name, std::vector<int>{value});
    }
    void SetBool(const char* name, bool value) {
        Add(ParameterType::Bool, name, std::vector<int>{value});
    }
    void SetString(const char* name, const std::string& value) {
        Add(ParameterType::String, name, std::vector<std::string>{value});
    }
    void SetTexture(const char* name, const TextureRef& ref) {
        Add(ParameterType::Texture, name, std::vector<TextureRef>{ref});
    }
    template <typename Values>
    void Add(ParameterType type, const char* name, Values values) {
        written.Add({type, name, from.loc, std::move(values)});
    }
    // Adds a spectrum texture of an image to the description.
    TextureRef AddImage(const std::string& file, bool isData) const;

    const FileLoc& Loc() const { return from.loc; }
    const std::string& Name() const { return from.name; }
    const Parameters& All() const { return from.parameters; }
    const V4Context& Context() const { return context; }

    // Returns the entity written. Throws Error if a parameter of the other is unknown.
    Entity Finish(const std::string& name, const std::string& owner) const;

  private:
    const V4Context& context;
    const Entity& from;
    Parameters written;
};

// The functions of each kind of directive, in v4_*.cpp.
Entity TranslateMaterial(V4Reader);
Entity TranslateLight(V4Reader);
Entity TranslateAreaLight(V4Reader);
Entity TranslateTexture(V4Reader, bool isSpectrum);
Entity TranslateShape(V4Reader);
Entity TranslateMedium(V4Reader);
Entity TranslateOption(V4Reader);

}  // namespace lull
