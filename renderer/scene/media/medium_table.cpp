#include "renderer/scene/media/medium_table.h"

#include <fmt/format.h>

#include "renderer/base/math.h"
#include "renderer/input/spectrum.h"
#include "renderer/scene/geometry/animated_transform.h"
#include "renderer/scene/geometry/shape.h"
#include "renderer/scene/materials/subsurface.h"
#include "stopping/base/input_file.h"

namespace lull {
namespace {

// Returns the ray with a unit direction, and the factor from its t to the other's.
std::pair<Ray, float> Normalised(const Ray& ray) {
    const float length = ray.d.norm();
    return {{ray.o, ray.d / length, ray.tMax * length}, 1 / length};
}

// Returns a coefficient of scattering or absorption; throws Error.
Rgb ReadCoefficient(const MediumEntity& entity, const char* name, const Rgb& otherwise,
                    float scale) {
    const Rgb value =
        (entity.parameters.GetSpectrum(name, otherwise) * scale).unaryExpr(&RaisedToZero);
    if (!(value >= 0).all() || !IsFinite(value))
        throw Error(entity.loc, fmt::format("\"{}\" of medium \"{}\" has to be finite and at least "
                                            "0",
                                            name, Printable(entity.mediumName)));
    return value;
}

// A ray is stopped to look at the density as often, on the mean, as its length times the greatest
// extinction says, be there anything in its way or not.
void CheckDepth(const MediumEntity& entity, const GridMedium& grid, const Mat4d& worldFromGrid) {
    constexpr double kDeepest = 1e7;
    const double longest = worldFromGrid.topLeftCorner<3, 3>().norm();
    const double deepest = double(grid.sigmaT * grid.maxDensity) * longest;
    if (!(deepest <= kDeepest))
        throw Error(entity.loc,
                    fmt::format("medium \"{}\" is too dense to be traced: its greatest extinction "
                                "times its length is {:.3g}, which has to be {:g} at most",
                                Printable(entity.mediumName), deepest, kDeepest));
}

void ReadDensity(const MediumEntity& entity, GridMedium* grid) {
    grid->size = {entity.parameters.GetInt("nx", 1), entity.parameters.GetInt("ny", 1),
                  entity.parameters.GetInt("nz", 1)};
    const auto values = entity.parameters.GetFloats(ParameterType::Float, "density");
    constexpr int kMaxSide = 1 << 16;
    if (grid->size.minCoeff() < 1 || grid->size.maxCoeff() > kMaxSide ||
        size_t(grid->size.x()) * grid->size.y() * grid->size.z() != values.size())
        throw Error(entity.loc, fmt::format("medium \"{}\" has {} values of \"density\" for a grid "
                                            "of {}x{}x{}",
                                            Printable(entity.mediumName), values.size(),
                                            grid->size.x(), grid->size.y(), grid->size.z()));
    grid->density.assign(values.begin(), values.end());
    for (float& d : grid->density) {
        d = RaisedToZero(d);
        if (!(d >= 0) || !std::isfinite(d))
            throw Error(entity.loc,
                        fmt::format("medium \"{}\": a density is not finite or negative",
                                    Printable(entity.mediumName)));
        grid->maxDensity = std::max(grid->maxDensity, d);
    }
}

GridMedium MakeGrid(const MediumEntity& entity, const Rgb& sigmaA, const Rgb& sigmaS, float g) {
    const Parameters& params = entity.parameters;
    GridMedium grid;
    const Rgb sigmaT = sigmaA + sigmaS;
    grid.sigmaT = sigmaT.x();
    if (sigmaT.maxCoeff() - sigmaT.minCoeff() > 1e-5f * sigmaT.maxCoeff()) {
        grid.sigmaT = sigmaT.maxCoeff();
        grid.tint = sigmaT / grid.sigmaT;
    }
    grid.albedo = grid.sigmaT > 0 ? Rgb(sigmaS / grid.sigmaT) : Rgb(Rgb::Zero());
    grid.g = g;
    ReadDensity(entity, &grid);
    const Vec3f p0 = params.GetPoint3("p0", Vec3f::Zero());
    const Vec3f p1 = params.GetPoint3("p1", Vec3f::Ones());
    Mat4d worldFromGrid = Mat4d::Identity();
    worldFromGrid.topLeftCorner<3, 3>() = (p1 - p0).cast<double>().asDiagonal();
    worldFromGrid.topRightCorner<3, 1>() = p0.cast<double>();
    worldFromGrid = Mat4d(entity.worldFromMedium * worldFromGrid);
    grid.gridFromWorld = worldFromGrid.inverse();
    if (!grid.gridFromWorld.allFinite())
        throw Error(entity.loc, fmt::format("medium \"{}\": \"p0\" and \"p1\" have to span a box",
                                            Printable(entity.mediumName)));
    CheckDepth(entity, grid, worldFromGrid);
    if (!(Farthest(TransformBox(worldFromGrid, {Vec3f::Zero(), Vec3f::Ones()})) <=
          double(kFarthest)))
        throw Error(entity.loc, fmt::format("medium \"{}\" reaches farther than {:g} from the "
                                            "origin, where no ray is traced; scale the scene down",
                                            Printable(entity.mediumName), kFarthest));
    return grid;
}

Medium MakeMedium(const MediumEntity& entity, Warnings& warnings) {
    const Parameters& params = entity.parameters;
    params.GetString("type", "");  // already in entity.name
    const MediumPreset preset =
        ReadMediumPreset(params.GetString("preset", ""), entity.loc, warnings);
    const float scale = params.GetFloat("scale", 1);
    float g = params.GetFloat("g", 0);
    const Rgb sigmaA = ReadCoefficient(entity, "sigma_a", preset.sigmaA, scale);
    const Rgb sigmaS = ReadCoefficient(entity, "sigma_s", preset.sigmaS, scale);
    constexpr float kMostForward = 0.99999f;  // with 1, light would go straight on
    if (!InRange(double(g), -1, 1))
        throw Error(entity.loc, fmt::format("\"g\" of medium \"{}\" has to lie between -1 and 1",
                                            Printable(entity.mediumName)));
    if (std::abs(g) > kMostForward) g = std::copysign(kMostForward, g);
    std::optional<Medium> made;
    if (entity.name == "homogeneous")
        made = HomogeneousMedium{sigmaS, sigmaA + sigmaS, g};
    else if (entity.name == "heterogeneous")
        made = MakeGrid(entity, sigmaA, sigmaS, g);
    else
        throw Error(entity.loc, fmt::format("medium \"{}\": kind \"{}\" is not supported; "
                                            "homogeneous and heterogeneous are",
                                            Printable(entity.mediumName), Printable(entity.name)));
    params.ReportUnused("medium \"" + Printable(entity.mediumName) + "\"", warnings);
    return *made;
}

}  // namespace

MediumTable::MediumTable(const Description& description, Warnings& warnings) {
    for (const MediumEntity& entity : description.media)
        media.push_back(MakeMedium(entity, warnings));
    if (media.empty()) return;
    ofCamera = MediumStack(description.cameraMedium);
    size_t volumes = 0;
    const auto add = [&](const ShapeEntity& shape) {
        ofShapes.push_back({shape.insideMedium, shape.outsideMedium});
        volumes += shape.outsideMedium == ShapeEntity::kSurrounding;
    };
    // In the order of ShapeTable::shapes.
    for (const ShapeEntity& shape : description.shapes) add(shape);
    for (const ObjectEntity& object : description.objects)
        for (const ShapeEntity& shape : object.shapes) add(shape);
    // Objects may have several instances.
    hasVolumes = volumes > 1 || (volumes == 1 && description.instances.size() > 1);
}

MediumSample MediumTable::Sample(int medium, const Ray& ray, Sampler& sampler) const {
    const auto normalised = Normalised(ray);
    const Ray& unit = normalised.first;
    MediumSample sample =
        Visit(media[medium], [&](const auto& m) { return m.Sample(unit, sampler); });
    if (sample.t) *sample.t *= normalised.second;
    return sample;
}

Rgb MediumTable::Transmittance(int medium, const Ray& ray, Sampler& sampler) const {
    const Ray unit = Normalised(ray).first;
    return Visit(media[medium], [&](const auto& m) { return m.Transmittance(unit, sampler); });
}

}  // namespace lull
