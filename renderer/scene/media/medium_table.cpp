#include "renderer/scene/media/medium_table.h"

#include <fmt/format.h>

#include "renderer/base/math.h"
#include "renderer/input/spectrum.h"
#include "renderer/scene/geometry/animated_transform.h"
#include "renderer/scene/geometry/shape.h"
#include "renderer/scene/materials/subsurface.h"
#include "renderer/scene/media/nanovdb.h"
#include "stopping/base/input_file.h"

namespace lull {
namespace {

std::pair<Ray, float> Normalised(const Ray& ray) {
    const float length = ray.d.norm();
    return {{ray.o, ray.d / length, ray.tMax * length}, 1 / length};
}

Rgb ReadCoefficient(const MediumEntity& entity, const char* name, const Rgb& otherwise,
                    float scale) {
    const Rgb value =
        (entity.parameters.GetSpectrum(name, otherwise) * scale).unaryExpr(&RaisedToZero);
    if (!(value >= 0).all() || !IsFinite(value))
        throw Error(entity.loc, "\"{}\" of medium \"{}\" has to be finite and at least 0", name,
                    Printable(entity.mediumName));
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
                    "medium \"{}\" is too dense to be traced: its greatest extinction times its "
                    "length is {:.3g}, which has to be {:g} at most",
                    Printable(entity.mediumName), deepest, kDeepest);
}

[[noreturn]] void Fail(const MediumEntity& entity, const std::string& why) {
    throw Error(entity.loc, "medium \"{}\"{}", Printable(entity.mediumName), why);
}

float Greatest(float v) { return v; }
float Greatest(const Rgb& v) { return v.maxCoeff(); }

// Reads the values of a grid, times `scale`, or those that may be negative.
template <typename T>
Grid<T> ReadGrid(const MediumEntity& entity, const char* name, float scale = 1,
                 bool mayBeNegative = false) {
    constexpr bool isRgb = std::is_same_v<T, Rgb>;
    constexpr int kMaxSide = 1 << 16;
    Grid<T> grid;
    grid.size = {entity.parameters.GetInt("nx", 1), entity.parameters.GetInt("ny", 1),
                 entity.parameters.GetInt("nz", 1)};
    const auto numbers =
        entity.parameters.GetFloats(isRgb ? ParameterType::Spectrum : ParameterType::Float, name);
    const size_t count = numbers.size() / (isRgb ? 3 : 1);
    if (grid.size.minCoeff() < 1 || grid.size.maxCoeff() > kMaxSide ||
        size_t(grid.size.x()) * grid.size.y() * grid.size.z() != count)
        Fail(entity, fmt::format(" has {} values of \"{}\" for a grid of {}x{}x{}", count, name,
                                 grid.size.x(), grid.size.y(), grid.size.z()));
    const auto read = [&](float number) {
        // Colours outside of sRGB have parts below 0.
        if (isRgb) number = std::max(number, 0.f);
        const float v = mayBeNegative ? number : RaisedToZero(number) * scale;
        if ((!mayBeNegative && !(v >= 0)) || !std::isfinite(v))
            Fail(entity, fmt::format(": a {} is not finite or negative", name));
        return v;
    };
    grid.values.reserve(count);
    for (size_t i = 0; i < count; ++i) {
        if constexpr (isRgb)
            grid.values.emplace_back(read(numbers[3 * i]), read(numbers[3 * i + 1]),
                                     read(numbers[3 * i + 2]));
        else
            grid.values.push_back(read(numbers[i]));
    }
    return grid;
}

template <typename T>
float GreatestOf(const Grid<T>& grid) {
    float most = 0;
    for (const T& v : grid.values) most = std::max(most, Greatest(v));
    return most;
}

Mat4d MatrixOfBox(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1) {
    Mat4d m = Mat4d::Identity();
    m.topLeftCorner<3, 3>() = (p1 - p0).asDiagonal();
    m.topRightCorner<3, 1>() = p0;
    return m;
}

Mat4d MatrixOfBox(const MediumEntity& entity) {
    return MatrixOfBox(entity.parameters.GetPoint3("p0", Vec3f::Zero()).cast<double>(),
                       entity.parameters.GetPoint3("p1", Vec3f::Ones()).cast<double>());
}

void Place(const MediumEntity& entity, const Mat4d& mediumFromGrid, GridMedium* medium) {
    const Mat4d worldFromGrid = entity.worldFromMedium * mediumFromGrid;
    medium->gridFromWorld = worldFromGrid.inverse();
    if (!medium->gridFromWorld.allFinite()) Fail(entity, ": \"p0\" and \"p1\" have to span a box");
    CheckDepth(entity, *medium, worldFromGrid);
    if (!(Farthest(TransformBox(worldFromGrid, {Vec3f::Zero(), Vec3f::Ones()})) <=
          double(kFarthest)))
        Fail(entity, fmt::format(" reaches farther than {:g} from the origin, where no ray is "
                                 "traced; scale the scene down",
                                 kFarthest));
}

GridMedium MakeGrid(const Rgb& sigmaA, const Rgb& sigmaS, float g) {
    GridMedium grid;
    const Rgb sigmaT = sigmaA + sigmaS;
    grid.sigmaT = sigmaT.x();
    if (sigmaT.maxCoeff() - sigmaT.minCoeff() > 1e-5f * sigmaT.maxCoeff()) {
        grid.sigmaT = sigmaT.maxCoeff();
        grid.tint = sigmaT / grid.sigmaT;
    }
    grid.albedo = grid.sigmaT > 0 ? Rgb(sigmaS / grid.sigmaT) : Rgb(Rgb::Zero());
    if (grid.sigmaT > 0) grid.absorption = sigmaA / grid.sigmaT;
    grid.g = g;
    return grid;
}

// The emission of pbrt-v4 that is not of a light's colour: RGB stands for so many times D65, and a
// black body of peak 1 for its spectrum, both without normalisation by the integral of y.
constexpr float kIntegralOfY = 106.856895f;

// Returns nothing for temperatures without emission. `coldest` and `hottest` are of the grid.
template <typename Field>
std::optional<Temperatures> ReadTemperatures(const MediumEntity& entity, Field field, float coldest,
                                             float hottest) {
    constexpr int kColors = 2048;  // errors of 2e-3 at 1,000 K where the hottest has 10,000
    Temperatures t{std::move(field), entity.parameters.GetFloat("temperatureoffset", 0),
                   entity.parameters.GetFloat("temperaturescale", 1)};
    const auto kelvin = [&](float value) { return (value - t.offset) * t.scale; };
    const float most = std::max({kelvin(0), kelvin(coldest), kelvin(hottest)});
    if (!std::isfinite(most)) Fail(entity, ": a temperature is not finite");
    if (!(most > Temperatures::kColdest)) return {};
    t.step = (most - Temperatures::kColdest) / (kColors - 1);
    for (int i = 0; i < kColors; ++i) {
        const double color = double(Temperatures::kColdest) + i * double(t.step);
        t.colors.push_back(kIntegralOfY * RgbFromBlackbody(color, entity.loc).max(0.f));
    }
    return t;
}

GridMedium ReadUniformGrid(const MediumEntity& entity, GridMedium medium) {
    const Parameters& params = entity.parameters;
    auto density = ReadGrid<float>(entity, "density");
    medium.maxDensity = GreatestOf(density);
    medium.density = std::move(density);
    MediumEmission emission{params.GetSpectrum("emission", Rgb::Zero())};
    if (!params.GetFloats(ParameterType::Float, "temperature").empty()) {
        auto grid = ReadGrid<float>(entity, "temperature", 1, true);
        const auto [coldest, hottest] = std::ranges::minmax(grid.values);
        emission.temperatures = ReadTemperatures(entity, std::move(grid), coldest, hottest);
        if (emission.temperatures) emission.Le = Rgb::Ones();
    }
    // As in pbrt-v4, a scale of 1 is that of a grid of one cell: it falls towards the sides.
    const bool isScaled = !params.GetFloats(ParameterType::Float, "Lescale").empty();
    emission.scale = isScaled ? ReadGrid<float>(entity, "Lescale") : Grid<float>{.values = {1}};
    if (!IsBlack(emission.Le)) medium.emission = std::move(emission);
    Place(entity, MatrixOfBox(entity), &medium);
    return medium;
}

GridMedium ReadRgbGrid(const MediumEntity& entity, float scale, float g) {
    const Parameters& params = entity.parameters;
    const auto isGiven = [&](const char* name) {
        return !params.GetFloats(ParameterType::Spectrum, name).empty();
    };
    GridMedium medium = MakeGrid(Rgb::Zero(), Rgb::Ones(), g);
    RgbDensity density{.otherwise = scale};
    if (isGiven("sigma_a")) density.sigmaA = ReadGrid<Rgb>(entity, "sigma_a", scale);
    if (isGiven("sigma_s")) density.sigmaS = ReadGrid<Rgb>(entity, "sigma_s", scale);
    medium.maxDensity = (density.sigmaA ? GreatestOf(*density.sigmaA) : scale) +
                        (density.sigmaS ? GreatestOf(*density.sigmaS) : scale);
    medium.density = std::move(density);
    const float LeScale = params.GetFloat("Lescale", 1);
    if (isGiven("Le") && LeScale > 0)
        medium.emission = {.color = ReadGrid<Rgb>(entity, "Le", LeScale * kIntegralOfY)};
    Place(entity, MatrixOfBox(entity), &medium);
    return medium;
}

GridMedium ReadCloud(const MediumEntity& entity, GridMedium medium) {
    const Parameters& params = entity.parameters;
    const Mat4d box = MatrixOfBox(entity);
    const CloudDensity density{box.topRightCorner<3, 1>().cast<float>(),
                               box.diagonal().head<3>().cast<float>(),
                               params.GetFloat("density", 1), params.GetFloat("wispiness", 1),
                               params.GetFloat("frequency", 5)};
    for (const float v : {density.density, density.wispiness, density.frequency})
        if (!std::isfinite(v)) Fail(entity, " has a number that is not finite");
    medium.density = density;
    medium.maxDensity = 1;
    Place(entity, box, &medium);
    return medium;
}

void PlaceVoxels(const Mat4d& voxelFromUnit, SparseGrid* grid) {
    grid->scale = voxelFromUnit.topLeftCorner<3, 3>().cast<float>();
    grid->offset = voxelFromUnit.topRightCorner<3, 1>().cast<float>();
}

GridMedium ReadVdb(const Description& description, const MediumEntity& entity, GridMedium medium) {
    const Parameters& params = entity.parameters;
    const std::string path = ResolvePath(description, params.GetString("filename", ""));
    const auto read = [&](const char* parameter, const char* otherwise) {
        return ReadNanoVdb(path, params.GetString(parameter, otherwise), entity.loc);
    };
    auto density = read("gridname", "density");
    if (!density)
        Fail(entity, fmt::format(": '{}' has no grid \"{}\"", path,
                                 Printable(params.GetString("gridname", "density"))));
    const Mat4d voxelFromUnit =
        MatrixOfBox(density->low.cast<double>(), density->high.cast<double>());
    const Mat4d mediumFromUnit = density->voxelFromMedium.inverse() * voxelFromUnit;
    PlaceVoxels(voxelFromUnit, &density->grid);
    for (const SparseGrid::Brick& brick : density->grid.bricks)
        medium.maxDensity = std::max(medium.maxDensity, brick.most);
    medium.density = std::move(density->grid);

    const float LeScale = params.GetFloat("Lescale", 1);
    if (auto hot = read("temperaturename", "temperature"); hot && LeScale > 0) {
        PlaceVoxels(hot->voxelFromMedium * mediumFromUnit, &hot->grid);
        float coldest = 0, hottest = 0;
        for (const SparseGrid::Brick& brick : hot->grid.bricks)
            hottest = std::max(hottest, brick.most);
        for (const float value : hot->grid.values) coldest = std::min(coldest, value);
        if (auto t = ReadTemperatures(entity, std::move(hot->grid), coldest, hottest))
            medium.emission = {.Le = Rgb::Constant(LeScale), .temperatures = std::move(t)};
    }
    Place(entity, mediumFromUnit, &medium);
    return medium;
}

Medium MakeMedium(const Description& description, const MediumEntity& entity, Warnings& warnings) {
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
        throw Error(entity.loc, "\"g\" of medium \"{}\" has to lie between -1 and 1",
                    Printable(entity.mediumName));
    if (std::abs(g) > kMostForward) g = std::copysign(kMostForward, g);
    std::optional<Medium> made;
    if (entity.name == "homogeneous")
        made = HomogeneousMedium{sigmaS, sigmaA + sigmaS, g,
                                 sigmaA * ReadCoefficient(entity, "emission", Rgb::Zero(), 1)};
    else if (entity.name == "heterogeneous")
        made = ReadUniformGrid(entity, MakeGrid(sigmaA, sigmaS, g));
    else if (entity.name == "rgbgrid")
        made = ReadRgbGrid(entity, scale, g);
    else if (entity.name == "cloud")
        made = ReadCloud(entity, MakeGrid(sigmaA, sigmaS, g));
    else if (entity.name == "nanovdb")
        made = ReadVdb(description, entity, MakeGrid(sigmaA, sigmaS, g));
    else
        throw Error(
            entity.loc,
            "medium \"{}\": kind \"{}\" is not supported; homogeneous and heterogeneous are",
            Printable(entity.mediumName), Printable(entity.name));
    params.ReportUnused("medium \"" + Printable(entity.mediumName) + "\"", warnings);
    return *made;
}

}  // namespace

MediumTable::MediumTable(const Description& description, Warnings& warnings) {
    for (const MediumEntity& entity : description.media)
        media.push_back(MakeMedium(description, entity, warnings));
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

bool MediumTable::Emit() const {
    return std::ranges::any_of(media, [](const Medium& medium) {
        if (const auto* grid = std::get_if<GridMedium>(&medium)) return grid->emission.has_value();
        return !IsBlack(std::get<HomogeneousMedium>(medium).emission);
    });
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
