#include "renderer/scene/light_table.h"

#include <fmt/format.h>

#include "renderer/scene/lights/light_color.h"

namespace lull {
namespace {

// More lights than these are chosen by a hierarchy. At 100 lamps both have the same variance, and
// tables, which sample every light 128 times for each voxel, take longer than many a render.
constexpr size_t kMostTableLights = 100;

struct WorldSphere {
    Vec3f center;
    float radius;
};

WorldSphere BoundingSphere(const Bounds3f& bounds) {
    if (bounds.IsEmpty()) return {Vec3f::Zero(), 1};
    const Vec3f center = 0.5f * (bounds.lower + bounds.upper);
    return {center, std::max((bounds.upper - center).norm(), 1e-10f)};
}

// Makes the light of one LightSource directive: the table of kinds.
Light MakeLight(const Description& description, const LightEntity& entity, float worldRadius,
                bool asPbrtV3, Warnings& warnings) {
    entity.parameters.GetInt("samples", 1);  // pbrt-v3's path integrator takes one all the same
    entity.parameters.GetInt("nsamples", 1);
    if (entity.name == "point") return PointLight::Make(entity, warnings);
    if (entity.name == "spot" || entity.name == "spot-squared")
        return SpotLight::Make(entity, warnings);
    if (entity.name == "distant") return DistantLight::Make(entity, worldRadius, warnings);
    if (entity.name == "infinite" || entity.name == "exinfinite")
        return InfiniteLight::Make(description, entity, worldRadius, !asPbrtV3, warnings);
    if (entity.name == "goniometric") return GoniometricLight::Make(description, entity, warnings);
    if (entity.name == "projection") return ProjectionLight::Make(description, entity, warnings);
    throw Error(entity.loc, fmt::format("LightSource \"{}\" is not modelled; point, spot, distant, "
                                        "infinite, goniometric and projection are",
                                        entity.name));
}

// Refuses lights to whose place no ray is traced.
void CheckReach(const Light& light, const LightEntity& entity, float reach) {
    std::visit(
        [&]<typename L>(const L& l) {
            if constexpr (requires { l.p; })
                if (!(l.p.template cast<double>().norm() <= double(reach)))
                    throw Error(entity.loc, fmt::format("LightSource \"{}\" lies farther than "
                                                        "{:.3g} from the origin, where no ray is "
                                                        "traced; scale the scene down",
                                                        entity.name, reach));
        },
        light);
}

AreaLight MakeAreaLight(const Entity& entity, const Shape& shape, Warnings& warnings) {
    if (entity.name != "diffuse" && entity.name != "area")
        throw Error(entity.loc, fmt::format("AreaLightSource \"{}\" is not modelled; only "
                                            "\"diffuse\" is",
                                            entity.name));
    const Parameters& params = entity.parameters;
    AreaLight light;
    light.L = LightColor(entity, "L", warnings);
    light.twoSided = params.GetBool("twosided", false);
    params.GetInt("samples", 1);
    params.GetInt("nsamples", 1);
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

std::unique_ptr<LightHierarchy> MakeHierarchy(std::span<const Light> lights) {
    std::vector<LightBounds> bounds;
    bounds.reserve(lights.size());
    std::vector<int> unbounded;
    for (const Light& light : lights)
        bounds.push_back(std::visit(
            [&]<typename L>(const L& l) -> LightBounds {
                if constexpr (requires { l.Bounds(); }) return l.Bounds();
                unbounded.push_back(int(&light - lights.data()));
                return {};
            },
            light));
    return std::make_unique<LightHierarchy>(bounds, std::move(unbounded));
}

// Reads what a mesh's emission varies by: "emission", multiplying L, looked up with the second
// texture coordinates where "emissionuv" is 1, and what cuts holes into the mesh. Returns null
// where neither is.
std::unique_ptr<const EmissionMap> MakeEmissionMap(const Entity& entity, const Shape& shape,
                                                   const TextureTable& textures) {
    const SpectrumTexture emission = textures.GetSpectrum(entity, "emission", Rgb::Ones());
    const bool secondUv = entity.parameters.GetInt("emissionuv", 0) == 1;
    const bool isPlain = emission.IsConstant() && (emission.constant == 1).all();
    if (!std::holds_alternative<Mesh>(shape.geometry) || (isPlain && !shape.coverage)) return {};
    return std::make_unique<const EmissionMap>(EmissionMap{&textures, &shape, emission, secondUv});
}

}  // namespace

LightTable::LightTable(const Description& description, ShapeTable& shapes,
                       const TextureTable& textures, bool asPbrtV3, Warnings& warnings) {
    const WorldSphere world = BoundingSphere(shapes.bounds);
    lights.reserve(CountLights(description, shapes));
    for (const LightEntity& entity : description.lights) {
        lights.push_back(MakeLight(description, entity, world.radius, asPbrtV3, warnings));
        CheckReach(lights.back(), entity, shapes.reach);
        entity.parameters.ReportUnused("LightSource \"" + entity.name + "\"", warnings);
        if (std::holds_alternative<InfiniteLight>(lights.back())) infinite.push_back(Count() - 1);
    }
    for (int i = 0; i < shapes.worldShapeCount; ++i) {
        const auto& entity = description.shapes[i].areaLight;
        if (!entity) continue;
        Shape& shape = shapes.shapes[i];
        std::unique_ptr<const EmissionMap> map = MakeEmissionMap(*entity, shape, textures);
        AreaLight light = MakeAreaLight(*entity, shape, warnings);
        light.map = map.get();
        if (map) emissionMaps.push_back(std::move(map));
        if (shape.PrimitiveCount() == 0) {
            warnings.Add(description.shapes[i].loc, "area light without area", "it gives no light");
            continue;
        }
        shape.firstLight = Count();
        for (uint32_t k = 0; k < shape.PrimitiveCount(); ++k) {
            if (const Mesh* mesh = std::get_if<Mesh>(&shape.geometry))
                light.surface = mesh->Sampler(k);
            else if (const Sphere* sphere = std::get_if<Sphere>(&shape.geometry))
                light.surface = sphere;
            else if (const Disk* disk = std::get_if<Disk>(&shape.geometry))
                light.surface = disk;
            else
                light.surface = &std::get<Revolved>(shape.geometry);
            if (light.map) {
                light.triangle = k;
                light.meanFactor = light.map->Mean(k);
            }
            lights.push_back(light);
        }
    }
    if (lights.empty()) return;
    anyVisible = std::any_of(lights.begin(), lights.end(), [](const Light& light) {
        const AreaLight* area = std::get_if<AreaLight>(&light);
        return area ? !area->isHidden : std::holds_alternative<InfiniteLight>(light);
    });

    const Entity& integrator = description.integrator;
    std::string strategy = integrator.parameters.GetString("lightsamplestrategy", "spatial");
    if (strategy != "uniform" && strategy != "power" && strategy != "spatial" &&
        strategy != "bvh") {
        warnings.Add(integrator.loc, "unknown lightsamplestrategy, \"spatial\" is used", strategy);
        strategy = "spatial";
    }
    const bool isMany = !asPbrtV3 && lights.size() > kMostTableLights;
    if (strategy == "bvh" || (strategy == "spatial" && isMany)) {
        hierarchy = MakeHierarchy(lights);
        return;
    }
    std::vector<float> weights(lights.size(), 1.f);
    if (strategy == "power")
        for (int i = 0; i < Count(); ++i)
            weights[i] =
                Luminance(std::visit([](const auto& light) { return light.Power(); }, lights[i]));
    if (strategy != "spatial" || lights.size() == 1 || shapes.bounds.IsEmpty())
        distribution = std::make_unique<LightDistribution>(weights);
    else
        distribution = std::make_unique<LightDistribution>(Count(), shapes.bounds);
}

std::optional<LightSample> LightTable::Sample(int i, const Vec3f& from, const Vec2f& u) const {
    const Light& light = lights[i];
    if (const AreaLight* area = std::get_if<AreaLight>(&light)) return area->Sample(from, u);
    if (const InfiniteLight* environment = std::get_if<InfiniteLight>(&light))
        return environment->Sample(u);
    if (const PointLight* point = std::get_if<PointLight>(&light)) return point->Sample(from);
    if (const SpotLight* spot = std::get_if<SpotLight>(&light)) return spot->Sample(from);
    if (const DistantLight* distant = std::get_if<DistantLight>(&light)) return distant->Sample();
    if (const auto* goniometric = std::get_if<GoniometricLight>(&light))
        return goniometric->Sample(from);
    return std::get<ProjectionLight>(light).Sample(from);
}

}  // namespace lull
