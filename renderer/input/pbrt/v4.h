// Translates the entities of pbrt-v4 into those of a Description, nearly all of them pbrt-v3's.
// Their parameters are all known, so that a misspelled one is an error.
#pragma once

#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "renderer/input/description.h"
#include "renderer/input/pbrt/pbrt_state.h"

namespace lull {

struct V4Context {
    EntityKind kind;
    Description& description;  // textures may be added
    const GraphicsState& state;
    Warnings& warnings;
};

// Returns the entity in the Description's terms. Throws Error, with the place, for unknown kinds
// and parameters, with what pbrt-v4 has for those of pbrt-v3, and for what is not supported.
Entity TranslateV4(const V4Context& context, Entity entity);

// Throws Error for a kind of film, camera, sampler or material that pbrt-v3 alone has.
void RefuseKindOfV3(std::string_view directive, std::string_view kind, const FileLoc& loc);

// Sets what pbrt-v4 renders where a directive is absent.
void SetV4Defaults(Description* description);

// Takes the exposure time, which the camera has, into the film's scale.
void SetExposureOfV4(Description* description);

// Adds the parameters of Attribute that an entity does not have itself; it need not use them.
void AddPresets(const Parameters& presets, Parameters* parameters);

// Spectra become linear sRGB: by what they are spectra of, as rendering by wavelengths would show
// them in the light of D65.

// Values at rising wavelengths in nm, linear between them and 0 outside.
struct SampledSpectrum {
    std::vector<Vec2f> samples;

    double At(double wavelength) const;
};
struct NamedSpectrum {
    std::string name;
};
struct BlackbodySpectrum {
    float kelvin;
};

using V4Spectrum = std::variant<Rgb, SampledSpectrum, NamedSpectrum, BlackbodySpectrum>;

// Reads pairs of wavelength and value. Throws Error at `loc` unless the wavelengths rise.
SampledSpectrum SampledSpectrumOf(std::span<const float> pairs, const FileLoc& loc);

// Returns whether pbrt-v4 has a spectrum of that name built in.
bool IsNamedSpectrum(const std::string& name);

// Each throws Error at `loc` where the spectrum is of another thing by its name.

// Returns the colour of emitted light, of luminance 1 but for RGB. Parts below 0 are black.
Rgb RgbOfLight(const V4Spectrum&, const FileLoc& loc);
// Returns that of a reflectance, or of a coefficient of absorption or scattering.
Rgb RgbOfSurface(const V4Spectrum&, const FileLoc& loc);
// Returns the index of refraction at 587.6 nm, of RGB the mean.
float IndexOf(const V4Spectrum&, const FileLoc& loc);
// Returns eta and k with which the reflectance at normal incidence is that of the spectra.
std::pair<Rgb, Rgb> RgbOfConductor(const V4Spectrum& eta, const V4Spectrum& k, const FileLoc& loc);

// Returns the matrix from a colour space of pbrt-v4 to linear sRGB, by way of XYZ and without
// adaptation. Throws Error at `loc` for other names.
Mat3f RgbFromColorSpace(const std::string& name, const FileLoc& loc);

// Returns the matrix of linear sRGB that turns the white of daylight of so many kelvin into that of
// D65 (Bradford's adaptation); below 4,000 K the white is a black body's.
Mat3f WhiteBalance(float kelvin);

// Reads the parameters of a pbrt-v4 entity, and writes those of another.
class V4Reader {
  public:
    V4Reader(const V4Context& context, Entity& from)
        : given(from.parameters), write(&written, from.loc), context(context), from(from) {}
    V4Reader(const V4Reader&) = delete;
    V4Reader& operator=(const V4Reader&) = delete;

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
    // Copy a parameter of the type, or a texture, if there is one, under the other name if given.
    void Copy(ParameterType type, const char* name, const char* to);
    void Copy(ParameterType type, std::initializer_list<const char*> names);
    void CopyFloat(const char* name, const char* to = nullptr);
    // Moves parameters that may be large; no look-up finds them afterwards.
    void Move(ParameterType type, std::initializer_list<const char*> names);
    // Copies a texture, or writes the reflectance or, with `otherwise`, that.
    void CopyReflectance(const char* name, const char* to, float otherwise);
    // Copies a texture, or writes the spectrum of a surface, if there is one.
    void CopySurface(const char* name, const char* to);

    TextureRef AddImage(const std::string& file, bool isData) const;

    const FileLoc& Loc() const { return from.loc; }
    const std::string& Name() const { return from.name; }
    const V4Context& Context() const { return context; }

    // Returns the entity written, once. Throws Error if a parameter of the other is unknown.
    Entity Finish(const std::string& name, const std::string& owner);

    const Parameters& given;      // those that were looked up count as known
    const ParameterWriter write;  // of the other entity

  private:
    const V4Context& context;
    Entity& from;
    Parameters written;
};

// The functions of each kind of directive, in v4_*.cpp.
Entity TranslateAreaLight(V4Reader& in);
Entity TranslateCamera(V4Reader& in);
Entity TranslateFilm(V4Reader& in);
Entity TranslateFilter(V4Reader& in);
Entity TranslateIntegrator(V4Reader& in);
Entity TranslateLight(V4Reader& in);
Entity TranslateMaterial(V4Reader& in);
Entity TranslateMedium(V4Reader& in);
Entity TranslateSampler(V4Reader& in);
Entity TranslateShape(V4Reader& in);
Entity TranslateTexture(V4Reader& in);

}  // namespace lull
