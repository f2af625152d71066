// Builds a Description from the directives of a pbrt-v3 file: one function per directive.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/input/description.h"
#include "renderer/input/pbrt/pbrt_lexer.h"
#include "renderer/input/pbrt/pbrt_parameters.h"
#include "renderer/input/pbrt/pbrt_state.h"

namespace lull {

class PbrtBuilder {
  public:
    enum class Stage { Options, World, Done };

    PbrtBuilder(const std::string& file, Warnings& warnings);

    // Each reads the arguments of its directive and applies it; `loc` is the place of its name.
    void Accelerator();
    void ActiveTransform();
    void AreaLightSource();
    void AttributeBegin();
    void AttributeEnd();
    void Camera();
    void ConcatTransform();
    void CoordSysTransform();
    void CoordinateSystem();
    void Film();
    void Identity();
    void Include();
    void Integrator();
    void LightSource();
    void LookAt();
    void MakeNamedMaterial();
    void MakeNamedMedium();
    void Material();
    void MediumInterface();
    void NamedMaterial();
    void ObjectBegin();
    void ObjectEnd();
    void ObjectInstance();
    void PixelFilter();
    void ReverseOrientation();
    void Rotate();
    void Sampler();
    void Scale();
    void Shape();
    void Texture();
    void Transform();
    void TransformBegin();
    void TransformEnd();
    void TransformTimes();
    void Translate();
    void WorldBegin();
    void WorldEnd();

    Stage CurrentStage() const { return stage; }
    // Returns the description; throws Error at `loc`, the end, if the world was not closed.
    Description Finish();

    PbrtLexer lexer;
    FileLoc loc;  // of the directive being read
    // Whether a directive could not be carried out, so that names may be missing for that reason.
    bool hasFailed = false;

  private:
    enum class ScopeKind { Attribute, Transform, Object };
    struct Scope {
        ScopeKind kind;
        FileLoc loc;
        GraphicsState saved;
    };

    void SubstituteName(const std::string& problem, const std::string& substitute);
    std::string ReadString(const char* what);
    double ReadNumber();
    template <size_t N>
    std::array<double, N> ReadNumbers();
    Mat4d ReadMatrix();
    Entity ReadEntity();
    template <typename T>
    T ReadAs() {
        T entity;
        static_cast<Entity&>(entity) = ReadEntity();
        return entity;
    }
    void ReadOption(Entity* entity, const char* directive);

    void Apply(const Mat4d& m);
    void Check();
    const Mat4d& StaticTransform(const char* owner);
    void AddInstance(int object, const Motion& motion);
    void AddMovingShape(ShapeEntity shape);
    void Begin(ScopeKind kind);
    void End(ScopeKind kind);
    bool SeesMedium(const std::string& directive);
    int MediumNamed(const std::string& name);
    int AddMaterial(MaterialEntity material);
    int CurrentMaterial();

    Warnings& warnings;
    Description description;
    Stage stage = Stage::Options;
    FileLoc worldBegin;
    GraphicsState state;
    std::vector<Scope> scopes;
    ParameterContext context;
    ScopedNames materials;
    int defaultMaterial = -1;
    std::unordered_map<std::string, int> objects;
    int currentObject = -1;  // the one being defined, into Description::objects
    // The shapes that move within an object, each an object of its own: by the object they are in.
    std::multimap<int, std::pair<int, TransformPair>> movingParts;
    std::map<std::string, TransformPair> coordinateSystems;
    std::map<std::string, FileLoc> optionsSeen;
    std::map<std::string, int> media;                            // into Description::media
    std::optional<std::pair<std::string, FileLoc>> earlyMedium;  // the first before WorldBegin
};

}  // namespace lull
