#include "renderer/input/pbrt/pbrt_builder.h"

#include <fmt/format.h>
#include <Eigen/LU>
#include <filesystem>
#include <utility>

#include "renderer/input/pbrt/pbrt_state.h"
#include "renderer/input/pbrt/v4.h"
#include "stopping/base/input_file.h"

namespace lull {
namespace {

// Bounds the values of an area light, since every shape it lights gets a copy.
constexpr size_t kMostAreaLightValues = 1000;

size_t CountValues(const Parameters& parameters) {
    size_t count = 0;
    for (const Parameter& parameter : parameters.All())
        count += parameter.name.size() +
                 std::visit([](const auto& values) { return values.size(); }, parameter.values);
    return count;
}

const char* ScopeName(int kind) {
    constexpr const char* kNames[] = {"Attribute", "Transform", "Object"};
    return kNames[kind];
}

}  // namespace

PbrtBuilder::PbrtBuilder(const std::string& file, std::optional<PbrtVersion> version,
                         Warnings& warnings)
    : lexer(file), warnings(warnings) {
    description.directory = std::filesystem::path(file).parent_path().string();
    context.directory = description.directory;
    context.version =
        version ? *version : DetectPbrtVersion(description.directory, &lexer, warnings);
    if (IsV4()) SetV4Defaults(&description);
}

Description PbrtBuilder::Finish() {
    if (stage == Stage::Options)
        throw Error(loc, "the file ends without WorldBegin: it describes no scene");
    if (stage == Stage::World && IsV4()) EndWorld();
    if (stage == Stage::World)
        throw Error(loc, "the file ends without WorldEnd for the WorldBegin of line " +
                             std::to_string(worldBegin.line));
    description.sources = lexer.Files();
    return std::move(description);
}

void PbrtBuilder::SubstituteName(const std::string& problem, const std::string& substitute) {
    if (!hasFailed) warnings.Substitute(loc, problem, substitute);
}

void PbrtBuilder::Include() { IncludeFile(false); }
void PbrtBuilder::Import() { IncludeFile(true); }

void PbrtBuilder::IncludeFile(bool isImport) {
    const std::string path = ResolvePath(description, ReadString("the name of a file"));
    if (ReasonNotToRead(path).empty()) {
        lexer.Include(path, loc);
        if (isImport) imports.push_back({lexer.Depth(), scopes.size(), state});
        return;
    }
    try {
        ReadFile(path, loc);
    } catch (const Error& error) {
        warnings.Substitute(error, "it is left out");
        hasFailed |= !warnings.Substitutes();
    }
}

void PbrtBuilder::CloseImports() {
    for (; !imports.empty() && lexer.Depth() < imports.back().depth; imports.pop_back()) {
        if (scopes.size() != imports.back().scopes)
            throw Error(loc, "the imported file ends within another scope than it begins in");
        state = std::move(imports.back().saved);
    }
}

void PbrtBuilder::NameAgain(const char* what, const std::string& name) {
    if (IsV4())
        throw Error(loc, "{} \"{}\" is there already; pbrt-v4 takes each name once", what,
                    Printable(name));
    warnings.Add(loc, fmt::format("{} redefined", what), "\"" + Printable(name) + "\"");
}

// Scopes.

void PbrtBuilder::Begin(ScopeKind kind) {
    state.floatTextureMark = context.floatTextures.Mark();
    state.spectrumTextureMark = context.spectrumTextures.Mark();
    state.materialMark = materials.Mark();
    scopes.push_back({kind, loc, state});
}

void PbrtBuilder::End(ScopeKind kind) {
    const std::string name = ScopeName(int(kind));
    if (scopes.empty()) throw Error(loc, name + "End without " + name + "Begin");
    Scope& scope = scopes.back();
    // In pbrt-v3 attributes and objects share a stack, and their ends may cross; in pbrt-v4 those
    // of attributes and transforms are the same.
    const bool isFree = IsV4() && kind != ScopeKind::Object && scope.kind != ScopeKind::Object;
    if (!isFree && (scope.kind == ScopeKind::Transform) != (kind == ScopeKind::Transform))
        throw Error(loc, name + "End where the " + ScopeName(int(scope.kind)) + "Begin of line " +
                             std::to_string(scope.loc.line) + " is still open");
    if (kind == ScopeKind::Transform && !IsV4()) {
        state.ctm = scope.saved.ctm;
        state.active = scope.saved.active;
    } else {
        state = std::move(scope.saved);
        if (!IsV4()) {
            context.floatTextures.Restore(state.floatTextureMark);
            context.spectrumTextures.Restore(state.spectrumTextureMark);
            materials.Restore(state.materialMark);
        }
    }
    scopes.pop_back();
}

void PbrtBuilder::AttributeBegin() { Begin(ScopeKind::Attribute); }
void PbrtBuilder::AttributeEnd() { End(ScopeKind::Attribute); }
void PbrtBuilder::TransformBegin() { Begin(ScopeKind::Transform); }
void PbrtBuilder::TransformEnd() { End(ScopeKind::Transform); }

void PbrtBuilder::WorldBegin() {
    stage = Stage::World;
    worldBegin = loc;
    state.ctm = {};
    state.active = kAllTimes;
    coordinateSystems["world"] = state.ctm;
    if (IsV4()) SetExposureOfV4(&description);
    if (earlyMedium) {
        loc = earlyMedium->second;
        if (!SeesMedium(earlyMedium->first)) {
            description.media.clear();
            media.clear();
            state.insideMedium = state.outsideMedium = mediumOfCamera = "";
        }
    }
}

void PbrtBuilder::CheckScopes(const std::string& end) {
    if (!scopes.empty())
        throw Error(loc, "{} where the {}Begin of line {} is still open", end,
                    ScopeName(int(scopes.back().kind)), scopes.back().loc.line);
    if (currentObject >= 0)
        throw Error(loc, "{} where the ObjectBegin of line {} is still open", end,
                    description.objects[currentObject].loc.line);
}

void PbrtBuilder::EndWorld() {
    CloseImports();
    if (!scopes.empty() && currentObject < 0)
        warnings.Add(loc, "the file ends where a scope is open",
                     std::string(ScopeName(int(scopes.back().kind))) + "Begin of line " +
                         std::to_string(scopes.back().loc.line));
    else
        CheckScopes("the file ends");
    description.cameraMedium = MediumNamed(mediumOfCamera);
    stage = Stage::Done;
}

void PbrtBuilder::WorldEnd() {
    if (IsV4()) {
        warnings.Add(loc, "WorldEnd has no effect in pbrt-v4");
        return;
    }
    CheckScopes("WorldEnd");
    // pbrt-v3 makes its camera only here, in the medium that is then in force.
    description.cameraMedium = MediumNamed(state.outsideMedium);
    stage = Stage::Done;
}

void PbrtBuilder::ObjectBegin() {
    const std::string name = ReadString("the name of an object");
    if (currentObject >= 0)
        throw Error(loc, "ObjectBegin inside the object of line " +
                             std::to_string(description.objects[currentObject].loc.line));
    Begin(ScopeKind::Object);
    currentObject = int(description.objects.size());
    description.objects.push_back({name, loc, {}});
    if (!objects.insert_or_assign(name, currentObject).second) NameAgain("object", name);
}

void PbrtBuilder::ObjectEnd() {
    if (currentObject < 0) throw Error(loc, "ObjectEnd without ObjectBegin");
    End(ScopeKind::Object);
    currentObject = -1;
}

void PbrtBuilder::ObjectInstance() {
    const std::string name = ReadString("the name of an object");
    if (currentObject >= 0)
        throw Error(loc, "ObjectInstance inside an object definition; objects do not nest");
    const auto it = objects.find(name);
    if (it == objects.end())
        return SubstituteName(
            "ObjectInstance of \"" + Printable(name) + "\", which no ObjectBegin before it defines",
            "it is left out");
    AddInstance(it->second, {state.ctm});
    const auto [first, last] = movingParts.equal_range(it->second);
    for (auto part = first; part != last; ++part)
        AddInstance(part->second.first, {state.ctm, part->second.second});
}

void PbrtBuilder::AddInstance(int object, const Motion& motion) {
    Mat4d atStart = motion[0].at[0];
    bool isAnimated = motion[0].IsAnimated();
    for (size_t i = 1; i < motion.size(); ++i) {
        atStart *= motion[i].at[0];
        isAnimated |= motion[i].IsAnimated();
    }
    InstanceEntity instance{object, atStart, loc};
    if (isAnimated) {
        instance.motion = int(description.motions.size());
        description.motions.push_back(motion);
    }
    description.instances.push_back(std::move(instance));
}

// Makes a shape that moves the instance of an object that holds nothing else.
void PbrtBuilder::AddMovingShape(ShapeEntity shape) {
    if (state.areaLight)
        warnings.Add(loc, "area light ignored at a moving shape",
                     "shapes that move cannot emit light, in pbrt-v3 neither");
    shape.worldFromObject = Mat4d::Identity();
    const int object = int(description.objects.size());
    description.objects.push_back({"", loc, {}});
    description.objects.back().shapes.push_back(std::move(shape));
    if (currentObject < 0)
        AddInstance(object, {state.ctm});
    else
        movingParts.insert({currentObject, {object, state.ctm}});
}

// The scene.

void PbrtBuilder::AreaLightSource() {
    Entity entity = Translated(EntityKind::AreaLight, ReadEntity());
    if (CountValues(entity.parameters) > kMostAreaLightValues)
        throw Error(loc, "AreaLightSource has more than " + std::to_string(kMostAreaLightValues) +
                             " values; its parameters are single numbers and spectra");
    // An empty name switches area lights off again.
    state.areaLight = entity.name.empty() ? nullptr : std::make_shared<Entity>(std::move(entity));
}

void PbrtBuilder::LightSource() {
    auto light = ReadAs<LightEntity>(EntityKind::Light);
    light.worldFromLight = StaticTransform("LightSource");
    description.lights.push_back(std::move(light));
}

void PbrtBuilder::ReverseOrientation() { state.reverseOrientation = !state.reverseOrientation; }

namespace {

bool IsStrandOf(const ShapeEntity& last, const ShapeEntity& next) {
    const auto same = [&](const auto& read) {
        return read(last.parameters) == read(next.parameters);
    };
    return last.name == "curve" && next.name == "curve" && !last.areaLight && !next.areaLight &&
           last.material == next.material && last.reverseOrientation == next.reverseOrientation &&
           last.insideMedium == next.insideMedium && last.outsideMedium == next.outsideMedium &&
           last.worldFromObject == next.worldFromObject &&
           same([](const Parameters& p) { return p.GetString("type", "flat"); }) &&
           same([](const Parameters& p) {
               return std::pair(p.GetInt("splitdepth", -1), p.GetFloat("splitdepth", 3));
           });
}

void AddShape(ShapeEntity shape, std::vector<ShapeEntity>* shapes) {
    if (!shapes->empty() && IsStrandOf(shapes->back(), shape))
        shapes->back().strands.push_back(std::move(static_cast<Entity&>(shape)));
    else
        shapes->push_back(std::move(shape));
}

}  // namespace

void PbrtBuilder::Shape() {
    auto shape = ReadAs<ShapeEntity>(EntityKind::Shape);
    shape.worldFromObject = state.ctm.at[0];
    shape.reverseOrientation = state.reverseOrientation;
    shape.material = CurrentMaterial();
    if (IsV4()) {
        // Its materials belong to no shape.
    } else if (auto own = MaterialOfShape(description.materials[size_t(shape.material)], shape)) {
        shape.material = int(description.materials.size());
        description.materials.push_back(std::move(*own));
    }
    shape.insideMedium = MediumNamed(state.insideMedium);
    shape.outsideMedium = MediumNamed(state.outsideMedium);
    if (state.ctm.IsAnimated()) {
        AddMovingShape(std::move(shape));
        return;
    }
    if (currentObject < 0) {
        if (state.areaLight) shape.areaLight = *state.areaLight;
        AddShape(std::move(shape), &description.shapes);
        return;
    }
    if (state.areaLight)
        warnings.Add(loc, "area light ignored in an object definition",
                     "shapes of instanced objects cannot emit light");
    AddShape(std::move(shape), &description.objects[currentObject].shapes);
}

void PbrtBuilder::Texture() {
    const std::string name = ReadString("the name of a texture");
    const std::string kind = ReadString("\"float\" or \"spectrum\"");
    TextureEntity texture;
    static_cast<Entity&>(texture) = ReadEntity();
    texture.textureName = name;
    texture.isSpectrum = kind == "spectrum" || (kind == "color" && !IsV4());
    if (!texture.isSpectrum && kind != "float")
        throw Error(loc, "texture kind \"" + Printable(kind) +
                             "\" is unknown; write \"float\" or \"spectrum\"");
    static_cast<Entity&>(texture) = Translated(
        texture.isSpectrum ? EntityKind::SpectrumTexture : EntityKind::FloatTexture, texture);
    texture.worldFromTexture = StaticTransform("Texture");
    ScopedNames& names = texture.isSpectrum ? context.spectrumTextures : context.floatTextures;
    if (names.Find(name) >= 0) NameAgain("texture", name);
    names.Define(name, int(description.textures.size()));
    description.textures.push_back(std::move(texture));
}

// Materials.

int PbrtBuilder::AddMaterial(MaterialEntity material) {
    if (material.name == "mix")
        for (int i : {0, 1})
            material.operands[i] = materials.Find(
                material.parameters.GetString(i == 0 ? "namedmaterial1" : "namedmaterial2", ""));
    description.materials.push_back(std::move(material));
    return int(description.materials.size()) - 1;
}

int PbrtBuilder::CurrentMaterial() {
    if (state.material >= 0) return state.material;
    if (defaultMaterial < 0) {
        MaterialEntity matte;
        matte.name = "matte";
        matte.loc = loc;
        defaultMaterial = AddMaterial(std::move(matte));
    }
    return defaultMaterial;
}

void PbrtBuilder::Material() {
    MaterialEntity material;
    static_cast<Entity&>(material) = ReadEntity();
    try {
        static_cast<Entity&>(material) = Translated(EntityKind::Material, material);
    } catch (const Error& error) {
        if (materials.Find(material.name) < 0) throw;
        throw Error(loc, "\"" + Printable(material.name) +
                             "\" is the name of a material; write NamedMaterial");
    }
    state.material = AddMaterial(std::move(material));
}

void PbrtBuilder::MakeNamedMaterial() {
    MaterialEntity material;
    static_cast<Entity&>(material) = ReadEntity();
    material.materialName = std::exchange(material.name, {});
    const Parameter* type = material.parameters.Find(ParameterType::String, "type");
    if (!type)
        throw Error(loc, "MakeNamedMaterial \"" + Printable(material.materialName) +
                             "\" has no \"string type\"; add one, such as \"matte\"");
    material.name = material.parameters.GetString("type", "");
    static_cast<Entity&>(material) = Translated(EntityKind::Material, material);
    const std::string name = material.materialName;
    if (materials.Find(name) >= 0) NameAgain("named material", name);
    materials.Define(name, AddMaterial(std::move(material)));
}

void PbrtBuilder::NamedMaterial() {
    const std::string name = ReadString("the name of a material");
    const int material = materials.Find(name);
    if (material < 0)
        return SubstituteName(
            "NamedMaterial \"" + Printable(name) + "\": no MakeNamedMaterial in force defines it",
            "the material before it stays in force");
    state.material = material;
}

// Media.

void PbrtBuilder::MakeNamedMedium() {
    MediumEntity medium;
    static_cast<Entity&>(medium) = ReadEntity();
    if (!SeesMedium("MakeNamedMedium")) return;
    medium.mediumName = std::exchange(medium.name, {});
    const std::string name = medium.mediumName;
    if (!medium.parameters.Find(ParameterType::String, "type"))
        throw Error(loc, "MakeNamedMedium \"" + Printable(name) +
                             "\" has no \"string type\"; add one, such as \"homogeneous\"");
    medium.name = medium.parameters.GetString("type", "");
    static_cast<Entity&>(medium) = Translated(EntityKind::Medium, medium);
    medium.worldFromMedium = StaticTransform("MakeNamedMedium");
    if (!media.insert_or_assign(name, int(description.media.size())).second)
        NameAgain("named medium", name);
    description.media.push_back(std::move(medium));
}

void PbrtBuilder::MediumInterface() {
    std::string inside = ReadString("the name of a medium");
    const bool hasOutside = lexer.Peek().kind == TokenKind::String;
    std::string outside = hasOutside ? lexer.Take().text : inside;
    // Vacuum on both sides is the default, if nothing else was set before.
    const bool isVacuum = inside.empty() && outside.empty();
    if (!isVacuum && !SeesMedium("MediumInterface")) return;
    state.insideMedium = std::move(inside);
    state.outsideMedium = std::move(outside);
}

// Finds a medium by its name when it is used, since it may be made after MediumInterface.
int PbrtBuilder::MediumNamed(const std::string& name) {
    if (name.empty()) return -1;
    const auto it = media.find(name);
    if (it != media.end()) return it->second;
    SubstituteName("medium \"" + Printable(name) +
                       "\" of MediumInterface: no MakeNamedMedium before defines it",
                   "vacuum stands in");
    return -1;
}

// Returns whether media count, or warns that they do not: pbrt-v3 leaves them out with all but
// three integrators. Which one it is, is known from WorldBegin on; until then they count.
bool PbrtBuilder::SeesMedium(const std::string& directive) {
    if (stage == Stage::Options) {
        if (!earlyMedium) earlyMedium = {directive, loc};
        return true;
    }
    const std::string& integrator = description.integrator.name;
    if (IntegratorSeesMedia(integrator)) return true;
    warnings.Add(loc, "participating medium ignored",
                 directive + " has no effect with Integrator \"" + Printable(integrator) +
                     "\", in pbrt as well");
    return false;
}

}  // namespace lull
