// Builds a Description from the directives of a scene file: one function per directive.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/input/description.h"
#include "renderer/input/pbrt/pbrt_lexer.h"
#include "renderer/input/pbrt/pbrt_state.h"

namespace lull {

class PbrtBuilder {
  public:
    enum class Stage { Options, World, Done };

    PbrtBuilder(const std::string& file, std::optional<PbrtVersion> version, Warnings& warnings);

    // Each reads the arguments of its directive and applies it; `loc` is the place of its name.
    void Accelerator();
    void ActiveTransform();
    void AreaLightSource();
    void Attribute();
    void AttributeBegin();
    void AttributeEnd();
    void Camera();
    void ColorSpace();
    void ConcatTransform();
    void CoordSysTransform();
    void CoordinateSystem();
    void Film();
    void Identity();
    void Import();
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
    void Option();
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

    // Takes back what imported files that have been read have set.
    void CloseImports();

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
    // A file that Import reads: up to where so many files are open.
    struct ImportedFile {
        size_t depth, scopes;
        GraphicsState saved;
    };

    void SubstituteName(const std::string& problem, const std::string& substitute);
    std::string ReadString(const char* what);
    double ReadNumber();
    template <size_t N>
    std::array<double, N> ReadNumbers();
    Mat4d ReadMatrix();
    Entity ReadEntity();  // as it stands
    Entity Translated(EntityKind kind, Entity entity);
    template <typename T>
    T ReadAs(EntityKind kind) {
        T entity;
        static_cast<Entity&>(entity) = Translated(kind, ReadEntity());
        return entity;
    }
    void ReadOption(EntityKind kind, Entity* entity, const char* directive);
    void NameAgain(const char* what, const std::string& name);
    void IncludeFile(bool isImport);
    void CheckScopes(const std::string& end);
    void EndWorld();
    bool IsV4() const { return context.version == PbrtVersion::V4; }

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
    std::vector<ImportedFile> imports;
    ParameterContext context;
    ScopedNames materials;
    int defaultMaterial = -1;
    std::unordered_map<std::string, int> objects;
    int currentObject = -1;  // the one being defined, into Description::objects
    // The shapes that move within an object, each an object of its own: by the object they are in.
    std::multimap<int, std::pair<int, TransformPair>> movingParts;
    std::map<std::string, TransformPair> coordinateSystems;
    std::map<std::string, FileLoc> optionsSeen;
    std::map<std::string, int> media;  // into Description::media
    std::string mediumOfCamera;        // outside of pbrt-v4's camera, by name
    std::optional<std::pair<std::string, FileLoc>> earlyMedium;  // the first before WorldBegin
};

}  // namespace lull
