// Keeps the state that a scene file changes: transforms, and names with scopes.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "renderer/input/description.h"
#include "renderer/input/pbrt/pbrt_lexer.h"
#include "renderer/input/pbrt_parser.h"

namespace lull {

// Maps names to indices. A definition made after a Mark lasts until Restore(mark).
class ScopedNames {
  public:
    // Returns the index, -1 where there is no such name.
    int Find(const std::string& name) const {
        const auto it = indices.find(name);
        return it == indices.end() ? -1 : it->second;
    }
    void Define(const std::string& name, int index) {
        undo.emplace_back(name, Find(name));
        indices[name] = index;
    }
    size_t Mark() const { return undo.size(); }
    void Restore(size_t mark) {
        for (; undo.size() > mark; undo.pop_back()) indices[undo.back().first] = undo.back().second;
    }

  private:
    std::unordered_map<std::string, int> indices;  // -1: no longer defined
    std::vector<std::pair<std::string, int>> undo;
};

// Which transforms of a pair the directives change.
enum ActiveTransforms { kStartTime = 1, kEndTime = 2, kAllTimes = 3 };

enum class EntityKind {
    Camera,
    Film,
    Filter,
    Integrator,
    Sampler,
    AreaLight,
    Shape,
    Light,
    Material,
    Medium,
    FloatTexture,
    SpectrumTexture
};

// State that AttributeBegin saves and AttributeEnd restores.
struct GraphicsState {
    TransformPair ctm;
    int active = kAllTimes;
    int material = -1;  // into Description::materials; -1 is the default
    bool reverseOrientation = false;
    std::shared_ptr<const Entity> areaLight;
    std::string insideMedium, outsideMedium;      // by name; empty: vacuum
    std::map<EntityKind, Parameters> attributes;  // of pbrt-v4's Attribute
    Mat3f rgbFromColorSpace = Mat3f::Identity();  // of pbrt-v4's ColorSpace
    size_t floatTextureMark = 0, spectrumTextureMark = 0, materialMark = 0;
};

// Reads the parameter lists of directives.

// Context of a parameter: the textures named so far, spectrum files.
struct ParameterContext {
    PbrtVersion version = PbrtVersion::V3;
    ScopedNames floatTextures, spectrumTextures;
    std::string directory;               // where the names of spectrum files start
    std::map<std::string, Rgb> spectra;  // already read, by path
};

// Reads `"type name" value` and `"type name" [values]` until something else comes. Throws Error at
// the place of whatever is wrong; warns about integers with a fraction, which pbrt-v3 drops and
// pbrt-v4 refuses. `rgbFromColorSpace` is pbrt-v4's.
Parameters ReadParameters(PbrtLexer& lexer, ParameterContext& context,
                          const Mat3f& rgbFromColorSpace, Warnings& warnings);

// Make the matrices of the directives, in pbrt-v3's conventions; angles in degrees. LookAt maps
// world to camera space (left-handed, looking along +z). Throw Error at `loc` if there is none.
Mat4d TranslateMatrix(double x, double y, double z);
Mat4d ScaleMatrix(double x, double y, double z, const FileLoc& loc);
Mat4d RotateMatrix(double degrees, const Eigen::Vector3d& axis, const FileLoc& loc);
Mat4d LookAtMatrix(const Eigen::Vector3d& eye, const Eigen::Vector3d& at, const Eigen::Vector3d& up,
                   const FileLoc& loc);
// Takes the 16 numbers of Transform and ConcatTransform, columns first.
Mat4d ColumnsMatrix(std::span<const double, 16> m, const FileLoc& loc);

// Throws Error at `loc` unless m and its inverse are within float's range.
void CheckInvertible(const Mat4d& m, const FileLoc& loc);

// Parameters of materials that shapes set for themselves.

// Returns the material of a shape that has parameters of materials itself: they replace those of
// `material`, as in pbrt-v3. Nothing is returned where the shape has none.
std::optional<MaterialEntity> MaterialOfShape(const MaterialEntity& material,
                                              const ShapeEntity& shape);

}  // namespace lull
