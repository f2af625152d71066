// Describes a scene as its file does: plain entities with parameters, each with the place it came
// from. Loaders fill a Description; compile (renderer/scene/scene.h) makes a Scene of it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/base/math.h"
#include "renderer/base/variant.h"

namespace lull {

// A triangle mesh as a file or a subdivision gives it.

// Normals need not have unit length: as in pbrt-v3 their lengths weigh in interpolation, and a
// zero normal stands for the triangle's own.
struct MeshData {
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;                      // none or one per position
    std::vector<Vec2f> uvs;                          // none or one per position
    std::vector<std::array<uint32_t, 3>> triangles;  // into positions
    std::vector<int> faceIndices;                    // none or one per triangle
};

// Refers to a texture by its index in Description::textures, as its name was bound when the
// parameter was read (pbrt-v3 keeps float and spectrum textures in separate name spaces).
struct TextureRef {
    std::string name;
    int floatIndex = -1, spectrumIndex = -1;
};

enum class ParameterType {
    Integer,
    Float,
    Bool,
    String,
    Point2,
    Vector2,
    Point3,
    Vector3,
    Normal,
    Spectrum,
    Texture,
    // Of pbrt-v4, until their use is known: names and files, pairs of wavelength and value, kelvin.
    SpectrumName,
    SpectrumSamples,
    Blackbody
};
// As in scenes; spectra have more kinds.
template <>
struct EnumNames<ParameterType> {
    static constexpr std::pair<ParameterType, const char*> all[] = {
        {ParameterType::Integer, "integer"},
        {ParameterType::Float, "float"},
        {ParameterType::Bool, "bool"},
        {ParameterType::String, "string"},
        {ParameterType::Point2, "point2"},
        {ParameterType::Vector2, "vector2"},
        {ParameterType::Point3, "point"},
        {ParameterType::Vector3, "vector"},
        {ParameterType::Normal, "normal"},
        {ParameterType::Spectrum, "rgb"},
        {ParameterType::Texture, "texture"},
        {ParameterType::SpectrumName, "spectrum"},
        {ParameterType::SpectrumSamples, "spectrum"},
        {ParameterType::Blackbody, "blackbody"}};
};

// One "type name" [values]. Points, vectors, normals and spectra lie flat in a vector of
// float; spectra of every kind (rgb, xyz, blackbody, spectrum) are linear RGB already.
struct Parameter {
    ParameterType type;
    std::string name;
    FileLoc loc;
    std::variant<std::vector<float>, std::vector<int>, std::vector<std::string>,
                 std::vector<TextureRef>>
        values;
    mutable bool lookedUp = false;
    mutable std::optional<ParameterType> wanted = {};  // the type that was looked up in vain
};

// The parameters of one directive. As in pbrt-v3, a look-up finds a parameter by name *and*
// type, and a single-value look-up finds it only if it has exactly one value. Every look-up marks
// the parameter as used; ReportUnused warns of the rest.
class Parameters {
  public:
    void Add(Parameter parameter);  // a repeated name of the same type replaces the earlier one

    float GetFloat(const std::string& name, float otherwise) const;
    int GetInt(const std::string& name, int otherwise) const;
    bool GetBool(const std::string& name, bool otherwise) const;
    std::string GetString(const std::string& name, const std::string& otherwise) const;
    Vec3f GetPoint3(const std::string& name, const Vec3f& otherwise) const;
    Vec3f GetVector3(const std::string& name, const Vec3f& otherwise) const;
    Rgb GetSpectrum(const std::string& name, const Rgb& otherwise) const;

    // Return the parameter with all its values, or null.
    const Parameter* Find(ParameterType type, const std::string& name) const;
    // Removes the parameter and returns it, if it is there.
    std::optional<Parameter> Take(ParameterType type, const std::string& name);
    // Return the values, empty where absent.
    std::span<const float> GetFloats(ParameterType type, const std::string& name) const;
    std::span<const int> GetInts(const std::string& name) const;
    // Returns the texture that a "texture" parameter names, null where there is no such parameter.
    const TextureRef* GetTexture(const std::string& name) const;

    // Returns "; it is given as "TYPE" and has to be "TYPE"" for a parameter of that name that was
    // looked up as another type only; else "".
    std::string Mistyped(const std::string& name) const;

    // Warns of every parameter that nothing has looked up; `owner` names whose it is.
    void ReportUnused(const std::string& owner, Warnings& warnings) const;

    const std::vector<Parameter>& All() const { return parameters; }

  private:
    std::vector<Parameter> parameters;
};

// Adds parameters to an entity, all of which have the same place in a file.
class ParameterWriter {
  public:
    ParameterWriter(Parameters* parameters, FileLoc loc)
        : parameters(parameters), loc(std::move(loc)) {}

    void Floats(ParameterType type, const std::string& name, std::vector<float> values) const {
        parameters->Add({type, name, loc, std::move(values)});
    }
    void Ints(const std::string& name, std::vector<int> values) const {
        parameters->Add({ParameterType::Integer, name, loc, std::move(values)});
    }
    void Float(const std::string& name, double value) const {
        Floats(ParameterType::Float, name, {float(value)});
    }
    void Spectrum(const std::string& name, const Rgb& c) const {
        Floats(ParameterType::Spectrum, name, {c.x(), c.y(), c.z()});
    }
    void Point(const std::string& name, const Vec3f& p) const {
        Floats(ParameterType::Point3, name, {p.x(), p.y(), p.z()});
    }
    void Int(const std::string& name, int value) const { Ints(name, {value}); }
    void Bool(const std::string& name, bool value) const {
        parameters->Add({ParameterType::Bool, name, loc, std::vector<int>{value}});
    }
    void String(const std::string& name, const std::string& value) const {
        parameters->Add({ParameterType::String, name, loc, std::vector<std::string>{value}});
    }
    void Texture(const std::string& name, const TextureRef& texture) const {
        parameters->Add({ParameterType::Texture, name, loc, std::vector<TextureRef>{texture}});
    }

  private:
    Parameters* parameters;
    FileLoc loc;
};

// One directive: its kind's name ("perspective", "plymesh"), parameters and place.
struct Entity {
    std::string name;
    Parameters parameters;
    FileLoc loc;
};

struct TextureEntity : Entity {
    std::string textureName;
    bool isSpectrum = false;  // else float
    Mat4d worldFromTexture = Mat4d::Identity();
};

struct MaterialEntity : Entity {
    std::string materialName;  // of MakeNamedMaterial; empty for Material
    // Of "mix": the two named materials, as the names were bound; -1 for unknown names.
    std::array<int, 2> operands = {-1, -1};
};

struct LightEntity : Entity {
    Mat4d worldFromLight = Mat4d::Identity();
    std::string label;  // its name in the file; glTF: the node, else the light
};

struct MediumEntity : Entity {
    std::string mediumName;
    Mat4d worldFromMedium = Mat4d::Identity();
};

struct ShapeEntity : Entity {
    Mat4d worldFromObject = Mat4d::Identity();  // inside an object definition: objectFromShape
    bool reverseOrientation = false;
    int material = -1;                // into Description::materials
    std::optional<Entity> areaLight;  // of AreaLightSource, in force at the shape
    // Of MediumInterface, into Description::media; -1: vacuum. kSurrounding outside: whatever the
    // shape lies in, as volumes of glTF do.
    static constexpr int kSurrounding = -2;
    int insideMedium = -1, outsideMedium = -1;
    // Of a curve: further directives that differ only in points, widths and the like. Hair comes
    // with one directive per strand, and becomes one shape.
    std::vector<Entity> strands;
    std::string label;  // its name in the file, for people; glTF: the node, else the mesh
};

// The shapes between ObjectBegin and ObjectEnd. As in pbrt-v3 their transforms include the
// one in force at ObjectBegin, and an instance's transform is applied on top.
struct ObjectEntity {
    std::string name;
    FileLoc loc;
    std::vector<ShapeEntity> shapes;
};

struct InstanceEntity {
    int object = -1;                              // into Description::objects
    Mat4d worldFromInstance = Mat4d::Identity();  // of one that moves: at the start
    FileLoc loc;
    int motion = -1;         // into Description::motions; -1: it stands still
    std::string label = {};  // as of shapes; empty: its object's name
};

// A transform at both of Description::transformTimes, start and end.
struct TransformPair {
    std::array<Mat4d, 2> at = {Mat4d::Identity(), Mat4d::Identity()};

    // Differences within rounding are no motion.
    bool IsAnimated() const { return at[0].cast<float>() != at[1].cast<float>(); }
};

// The transforms of a moving instance, outermost first: a moving shape within a placed object
// has one of the object and one in the object.
using Motion = std::vector<TransformPair>;

// An image embedded in the scene's file, still encoded in its own format.
struct EmbeddedImage {
    std::string name;  // for messages, unique in the scene
    std::string type;  // the extension that a file of this format would have, without the dot
    std::vector<std::byte> bytes;
};

struct Description {
    Entity camera{"perspective", {}, {}}, film{"image", {}, {}}, filter{"box", {}, {}},
        sampler{"halton", {}, {}}, integrator{"path", {}, {}};
    Mat4d cameraFromWorld = Mat4d::Identity();
    std::optional<TransformPair> movingCameraFromWorld;  // where the camera moves
    std::array<double, 2> transformTimes = {0, 1};       // in units of the camera's shutter times
    std::optional<int> upAxis;  // of the world's x, y, z, where the file's format says so

    std::vector<MediumEntity> media;  // none where the integrator does not see them
    int cameraMedium = -1;            // around the camera; -1: vacuum
    std::vector<TextureEntity> textures;
    std::vector<MaterialEntity> materials;
    std::vector<LightEntity> lights;
    std::vector<ShapeEntity> shapes;
    std::vector<ObjectEntity> objects;
    std::vector<InstanceEntity> instances;
    std::vector<Motion> motions;
    std::vector<EmbeddedImage> images;
    // The names by which the file lets people choose materials, in its order. No part of the scene.
    std::vector<std::string> variants;

    std::string directory;             // of the scene's file; relative file names start there
    std::vector<std::string> sources;  // the files that this was read from
};

// Returns whether the integrator of that name shows participating media: pbrt-v3's path does not.
bool IntegratorSeesMedia(const std::string& name);

// Returns the files that the scene consists of: those that the description was read from, and those
// that its parameters name, as far as there are such.
std::vector<std::string> FilesOf(const Description& description);

// Returns `file` as named in a parameter, made relative to the description's directory.
// Backslashes, and what came of them as escapes, separate folders where there is such a file alone.
std::string ResolvePath(const Description& description, const std::string& file);

// Returns "crc32:" and eight hexadecimal digits, computed from everything in a description and from
// the contents of all files that its parameters name (meshes, images, spectra). Names of folders do
// not count, so a scene that was moved stays the same. Missing files count as empty.
std::string SceneHash(const Description&);

}  // namespace lull
