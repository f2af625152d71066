#include "renderer/scene/lights/light_table.h"

#include <fmt/format.h>

#include <numbers>

#include "renderer/base/math.h"
#include "renderer/scene/geometry/shape_table.h"
#include "renderer/scene/kinds.h"
#include "renderer/scene/lights/light_sample.h"
#include "stopping/base/input_file.h"

namespace lull {
namespace {

// More lights than these are chosen by a hierarchy. At 100 lamps both have the same variance, and
// tables, which sample every light 128 times for each voxel, take longer than many a render.
constexpr size_t kMostTableLights = 100;

float WorldRadius(const Bounds3f& bounds) {
    const Vec3f center = 0.5f * (bounds.lower + bounds.upper);
    return bounds.IsEmpty() ? 1 : std::max((bounds.upper - center).norm(), 1e-10f);
}

// Adapts makers to the table of kinds.
template <typename L>
Light Make(const LightReader& in) {
    return L::Make(in);
}

Light MakeDistant(const LightReader& in) {
    const DistantLight parallel = DistantLight::Make(in);
    const float angle = in.entity.parameters.GetFloat("angle", 0);
    const auto across = InRange(double(angle), 0, 180);
    if (!across)
        throw Error(in.entity.loc,
                    "the distant light's \"angle\" is {:g}; it has to be from 0 to 180 degrees",
                    angle);
    // Below, directions of float are all the same.
    if (*across < 1e-3) return parallel;
    return SunLight(parallel, *across * std::numbers::pi / 180);
}

constexpr Kind<Light(const LightReader&)> kLights[] = {
    {"point", Make<PointLight>},
    {"spot", Make<SpotLight>},
    {"spot-squared", Make<SpotLight>},
    {"spot-smooth", Make<SpotLight>},
    {"distant", MakeDistant},
    {"infinite", Make<InfiniteLight>},
    {"exinfinite", Make<InfiniteLight>},
    {"goniometric", Make<GoniometricLight>},
    {"projection", Make<ProjectionLight>},
};

std::optional<Light> MakeLight(const LightReader& in) {
    const LightEntity& entity = in.entity;
    entity.parameters.GetInt("samples", 1);  // pbrt-v3's path integrator takes one all the same
    entity.parameters.GetInt("nsamples", 1);
    LightGroupOf(entity);
    const auto* kind = FindKind(kLights, entity.name);
    if (!kind) {
        in.warnings.Substitute(entity.loc,
                               fmt::format("LightSource \"{}\" is not supported; {} are",
                                           Printable(entity.name), NamesOf(kLights)),
                               "it is left out");
        return {};
    }
    const Light light = kind->make(in);
    entity.parameters.ReportUnused("LightSource \"" + entity.name + "\"", in.warnings);
    return light;
}

void CheckReach(const Light& light, const LightEntity& entity, float reach) {
    std::visit(
        [&]<typename L>(const L& l) {
            if constexpr (L::kType == LightType::DeltaPosition)
                if (!(l.p.template cast<double>().norm() <= double(reach)))
                    throw Error(entity.loc,
                                "LightSource \"{}\" lies farther than {:.3g} from the origin, "
                                "where no ray is traced; scale the scene down",
                                entity.name, reach);
        },
        light);
}

// An area light that shines into a cone, as a spot light does, from the origin of its shape.
constexpr const char* kAreaSpot = "spot-squared";

// Returns false, with a warning, where another kind is to be left out; else throws Error.
bool IsKnownAreaLight(const Entity& entity, Warnings& warnings) {
    if (entity.name == "diffuse" || entity.name == "area" || entity.name == kAreaSpot) return true;
    warnings.Substitute(entity.loc,
                        fmt::format("AreaLightSource \"{}\" is not supported; only \"diffuse\" is",
                                    Printable(entity.name)),
                        "it gives no light");
    return false;
}

// Reads the cone of a spot, "spread", degrees across the cone about each normal that the light
// leaves into, or "clearcoat", the weight of a coat above. Returns null without either.
std::unique_ptr<const EmissionProfile> MakeProfile(const Entity& entity,
                                                   const Mat4d& worldFromShape) {
    if (entity.name == kAreaSpot)
        return std::make_unique<const EmissionProfile>(SpotCone::Make(entity, worldFromShape));
    const float given = entity.parameters.GetFloat("spread", 180);
    const auto degrees = InRange(double(given), 0, 180);
    if (!degrees || !(*degrees > 0))
        throw Error(
            entity.loc,
            "the area light's \"spread\" is {:g}; it has to be above 0 and at most 180 degrees",
            given);
    if (const float coat = entity.parameters.GetFloat("clearcoat", 0); coat > 0 && *degrees == 180)
        return std::make_unique<const EmissionProfile>(BelowCoat{std::min(coat, 1.f)});
    if (*degrees == 180) return {};
    return std::make_unique<const EmissionProfile>(Spread::Make(*degrees));
}

AreaLight MakeAreaLight(const Entity& entity, const Shape& shape, Warnings& warnings) {
    const Parameters& params = entity.parameters;
    AreaLight light;
    light.L = LightColor(entity, "L", warnings);
    light.twoSided = params.GetBool("twosided", false);
    params.GetInt("samples", 1);
    params.GetInt("nsamples", 1);
    params.GetFloat("power", -1);
    LightGroupOf(entity);
    params.ReportUnused("AreaLightSource \"" + entity.name + "\"", warnings);
    light.isHidden = shape.IsInvisible();
    return light;
}

size_t CountLights(const Description& description, const ShapeTable& shapes) {
    size_t count = description.lights.size();
    for (size_t i = 0; i < size_t(shapes.worldShapeCount); ++i)
        if (description.shapes[i].areaLight) count += shapes.shapes[i].PrimitiveCount();
    return count;
}

template <typename L>
std::optional<LightBounds> BoundsOf(const L& light) {
    if constexpr (requires { light.Bounds(); })
        return light.Bounds();
    else if constexpr (L::kType == LightType::DeltaPosition)
        return LightBounds{
            .box = {light.p, light.p}, .cosNormals = -1, .power = BoundedPower(light.Power())};
    return {};
}

std::unique_ptr<LightHierarchy> MakeHierarchy(std::span<const Light> lights) {
    std::vector<LightBounds> bounds;
    bounds.reserve(lights.size());
    std::vector<int> unbounded;
    for (const Light& light : lights) {
        const auto placed = std::visit([](const auto& l) { return BoundsOf(l); }, light);
        if (!placed) unbounded.push_back(int(&light - lights.data()));
        bounds.push_back(placed.value_or(LightBounds{}));
    }
    return std::make_unique<LightHierarchy>(bounds, std::move(unbounded));
}

std::string StrategyOf(const Entity& integrator, Warnings& warnings) {
    const std::string strategy = integrator.parameters.GetString("lightsamplestrategy", "spatial");
    for (const char* known : {"uniform", "power", "spatial", "bvh"})
        if (strategy == known) return strategy;
    warnings.Add(integrator.loc, "unknown lightsamplestrategy, \"spatial\" is used",
                 Printable(strategy));
    return "spatial";
}

std::vector<float> WeightsOf(const std::vector<Light>& lights, bool byPower) {
    std::vector<float> weights(lights.size(), 1.f);
    if (byPower)
        std::ranges::transform(lights, weights.begin(), [](const Light& light) {
            return Luminance(std::visit([](const auto& l) { return l.Power(); }, light));
        });
    return weights;
}

// Reads the textures of a mesh's emission: "emission", multiplying L, looked up with the second
// texture coordinates where "emissionuv" is 1, and the alpha textures of the mesh. Returns null
// where neither is. What an alpha cuts out shines in pbrt-v3; an alpha of 0 is a hidden light.
std::unique_ptr<const EmissionMap> MakeEmissionMap(const Entity& entity, const Shape& shape,
                                                   const TextureTable& textures, bool asPbrtV3) {
    const SpectrumTexture emission = textures.GetSpectrum(entity, "emission", Rgb::Ones());
    const bool secondUv = entity.parameters.GetInt("emissionuv", 0) == 1;
    const bool vertexColors = entity.parameters.GetBool("emissioncolors", false);
    const bool isPlain = !vertexColors && emission.IsConstant() && (emission.constant == 1).all();
    const bool cutsOut = !asPbrtV3 && shape.alpha && !shape.alpha->IsConstant();
    const bool isWhole = !cutsOut && (!shape.coverage || shape.coverage->IsWhole());
    if (!shape.IsMesh() || (isPlain && isWhole)) return {};
    return std::make_unique<const EmissionMap>(
        EmissionMap{&textures, &shape, emission, secondUv, vertexColors, cutsOut});
}

}  // namespace

void LightTable::ChooseByPlace(const Bounds3f& bounds) {
    distribution = std::make_unique<LightDistribution>(Count(), bounds);
    evenContributions.assign(lights.size(), -1);
    const LightProbes& probes = distribution->Probes();
    for (int i = 0; i < Count(); ++i)
        if (const LightType type = TypeOf(lights[i]);
            type == LightType::Infinite || type == LightType::DeltaDirection)
            evenContributions[i] = Contribution(lights[i], probes, probes.unit);
}

LightTable::LightTable(const Description& description, ShapeTable& shapes,
                       const TextureTable& textures, bool asPbrtV3, Warnings& warnings) {
    lights.reserve(CountLights(description, shapes));
    AddLights(description, shapes, asPbrtV3, warnings);
    for (int i = 0; i < shapes.worldShapeCount; ++i)
        if (const auto& entity = description.shapes[i].areaLight;
            entity && IsKnownAreaLight(*entity, warnings))
            AddAreaLights(description.shapes[i], textures, asPbrtV3, &shapes.shapes[i], warnings);
    if (lights.empty()) return;
    anyVisible = std::ranges::any_of(lights, IsVisible);
    const std::string strategy = StrategyOf(description.integrator, warnings);
    const bool isMany = !asPbrtV3 && lights.size() > kMostTableLights;
    if (strategy == "bvh" || (strategy == "spatial" && isMany))
        hierarchy = MakeHierarchy(lights);
    else if (strategy != "spatial" || lights.size() == 1 || shapes.bounds.IsEmpty())
        distribution = std::make_unique<LightDistribution>(WeightsOf(lights, strategy == "power"));
    else
        ChooseByPlace(shapes.bounds);
}

void LightTable::AddLights(const Description& description, const ShapeTable& shapes, bool asPbrtV3,
                           Warnings& warnings) {
    const float worldRadius = WorldRadius(shapes.bounds);
    for (const LightEntity& entity : description.lights) {
        std::optional<Light> light;
        warnings.Try([&] {
            light = MakeLight({description, entity, worldRadius, !asPbrtV3, warnings});
            if (light) CheckReach(*light, entity, shapes.reach);
        });
        if (!light) continue;
        entities.push_back(int(&entity - description.lights.data()));
        lights.push_back(std::move(*light));
        if (TypeOf(lights.back()) == LightType::Infinite) infinite.push_back(Count() - 1);
    }
}

void LightTable::AddAreaLights(const ShapeEntity& from, const TextureTable& textures, bool asPbrtV3,
                               Shape* shape, Warnings& warnings) {
    const Entity& entity = *from.areaLight;
    std::unique_ptr<const EmissionMap> map = MakeEmissionMap(entity, *shape, textures, asPbrtV3);
    std::unique_ptr<const EmissionProfile> profile = MakeProfile(entity, from.worldFromObject);
    AreaLight light = MakeAreaLight(entity, *shape, warnings);
    light.profile = profile.get();
    if (profile) profiles.push_back(std::move(profile));
    light.map = map.get();
    if (map) emissionMaps.push_back(std::move(map));
    if (shape->PrimitiveCount() == 0) {
        const bool isMade = shape->material >= 0;  // otherwise an error names its fault
        if (isMade) warnings.Add(from.loc, "area light without area", "it gives no light");
        return;
    }
    shape->firstLight = Count();
    // Of pbrt-v4, which gives it to each primitive; at a radiance of L.
    const float power = entity.parameters.GetFloat("power", -1);
    const Rgb L = light.L;
    for (uint32_t k = 0; k < shape->PrimitiveCount(); ++k) {
        light.surface = EmitterOf(shape->geometry, k);
        if (power > 0) light.L = L * (power / ((light.twoSided ? 2 : 1) * kPi * light.Area()));
        if (light.map) {
            light.triangle = k;
            light.meanFactor = light.map->Mean(k);
        }
        lights.push_back(light);
    }
}

std::optional<LightSample> LightTable::Sample(int i, const Vec3f& from, const Vec2f& u) const {
    return Visit(lights[i], [&](const auto& light) { return light.Sample(from, u); });
}

}  // namespace lull
