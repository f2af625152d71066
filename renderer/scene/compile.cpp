#include "renderer/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <numeric>

#include "renderer/base/clocks.h"
#include "renderer/scene/geometry/shapes/mesh.h"
#include "stopping/base/input_file.h"
#include "stopping/base/parallel.h"

namespace lull {
namespace {

template <typename Work>
double Timed(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return SecondsSince(start);
}

void ReadSampler(const Entity& entity, Scene* scene, Warnings& warnings) {
    const Parameters& params = entity.parameters;
    scene->samplesPerPixel = params.GetInt("pixelsamples", 16);
    scene->sampler = entity.name == "random" ? SamplerKind::Random : SamplerKind::Sobol;
    if (entity.name == "random" || entity.name == "sobol") {
        params.ReportUnused("Sampler \"" + entity.name + "\"", warnings);
    } else if (entity.name == "stratified") {
        scene->samplesPerPixel = params.GetInt("xsamples", 4) * params.GetInt("ysamples", 4);
    }
    if (entity.name != "random" && entity.name != "sobol" && entity.loc.file)
        warnings.Add(entity.loc, fmt::format("Sampler \"{}\" is rendered with \"sobol\"",
                                             Printable(entity.name)));
    if (scene->samplesPerPixel < 1)
        throw Error(entity.loc, "the number of samples a pixel has to be at least 1");
}

void ReadView(const Description& description, const CompileOptions& options, Scene* scene,
              Warnings& warnings) {
    scene->film = MakeFilmSettings(description, options.film, warnings);
    scene->filter = Filter(description, warnings);
    scene->camera = MakeCamera(description, scene->film, warnings, options.threads);
    ReadSampler(description.sampler, scene, warnings);
    scene->camera.sampleSpacing = 1 / std::sqrt(float(scene->samplesPerPixel));
    const Stereo stereo = ReadStereo(description.camera);
    if (stereo.IsPair()) scene->rightEye = CameraOfEye(scene->camera, stereo, Eye::Right);
    scene->camera = CameraOfEye(scene->camera, stereo, stereo.IsPair() ? Eye::Left : stereo.alone);
    scene->isRightAlone = stereo.alone == Eye::Right;
}

bool HasInterfaces(const Description& description) {
    return std::ranges::any_of(description.materials, [](const MaterialEntity& m) {
        return m.name.empty() || m.name == "none";
    });
}

void ReadMedia(const Description& description, Scene* scene, Warnings& warnings) {
    scene->media = MediumTable(description, warnings);
    scene->mediaEmit = scene->media.Emit();
    scene->isVolumetric = IntegratorSeesMedia(description.integrator.name) &&
                          (!scene->media.media.empty() || HasInterfaces(description));
}

const char* WhyNotBdpt(const Description& description, const CompileOptions& options,
                       const Scene& scene) {
    if (options.lightsAsPbrtV3) return "pbrt-v3's estimator is for paths from the camera";
    if (scene.rightEye || scene.isRightAlone) return "two eyes have paths from their cameras alone";
    if (scene.isVolumetric)
        return scene.media.media.empty() ? "the scene has surfaces without a material"
                                         : "the scene has participating media";
    for (const LightEntity& light : description.lights)
        if (light.parameters.GetBool("cutsout", false) &&
            light.parameters.Find(ParameterType::Point3, "portal"))
            return "the sky shines through a portal";
    for (size_t i = 0; i < description.materials.size(); ++i)
        if (scene.materials.Needs(int(i)) & kScattersBelow)
            return "the scene has subsurface scattering";
    return nullptr;
}

bool HasPanes(const Scene& scene) {
    return std::ranges::any_of(scene.shapes.shapes, [&](const Shape& s) {
        return s.material >= 0 && (scene.materials.Needs(s.material) & kLetsThrough);
    });
}

bool HidesShapes(const Scene& scene) {
    return std::ranges::any_of(scene.shapes.shapes,
                               [](const Shape& s) { return (s.hiddenFrom & kCameraRay) != 0; });
}

// Returns the picture's share in which the camera looks through single-sided shapes from behind.
double ShareOpenBehind(const Scene& scene) {
    const auto isSingleSided = [](const Shape& s) { return s.coverage && s.coverage->singleSided; };
    const std::vector<Shape>& shapes = scene.shapes.shapes;
    if (std::ranges::none_of(shapes, isSingleSided)) return 0;
    constexpr int kSide = 64;
    int count = 0;
    for (int i = 0; i < kSide * kSide; ++i) {
        const Vec2f at((float(i % kSide) + 0.5f) / kSide, (float(i / kSide) + 0.5f) / kSide);
        const Ray ray =
            scene.camera.GenerateRay({at.cwiseProduct(scene.film.resolution.cast<float>())});
        Hit first, seen;
        if (!scene.accelerator.Intersect(ray, &first) || !isSingleSided(shapes[first.shape]) ||
            (shapes[first.shape].hiddenFrom & kCameraRay))
            continue;
        count += !scene.accelerator.Intersect(ray, &seen, 0, kCameraRay) || seen.t != first.t;
    }
    return double(count) / (kSide * kSide);
}

// Returns the volumes about a point, the innermost first: a ray leaves them without entering.
MediumStack VolumesAbout(const Scene& scene, const Vec3f& point) {
    constexpr int kMostHits = 1000;
    std::vector<int> left;
    std::map<int, int> entered;                                            // shapes, how often
    Ray ray{point, Vec3f(0.302f, 0.534f, 0.79f).normalized(), kInfinity};  // along no edge
    Hit found;
    for (int i = 0; i < kMostHits && scene.accelerator.Intersect(ray, &found); ++i) {
        SurfaceInteraction hit;
        scene.shapes.Interact(ray, found, kNeedsNothing, &hit, 0);
        const MediumTable::Sides& sides = scene.media.ofShapes[size_t(found.shape)];
        if (sides.outside == ShapeEntity::kSurrounding) {
            if (int& count = entered[found.shape]; ray.d.dot(hit.n) < 0)
                ++count;
            else if (count > 0)
                --count;
            else
                left.push_back(sides.inside);
        }
        ray = hit.SpawnRay(ray.d);
    }
    MediumStack media;
    for (auto medium = left.rbegin(); medium != left.rend(); ++medium) media.Enter(*medium);
    return media;
}

// Refuses cameras whose rays Embree would not take.
void CheckCamera(const Scene& scene, const FileLoc& loc) {
    const double farthest = std::max(Farthest(scene.camera, scene.film),
                                     scene.rightEye ? Farthest(*scene.rightEye, scene.film) : 0.);
    if (!(farthest <= double(scene.shapes.reach)))
        throw Error(loc,
                    "rays of the camera begin, or are aimed, farther than {:.3g} from the origin, "
                    "where none is traced; scale the scene down",
                    scene.shapes.reach);
}

std::unique_ptr<const Scene> MakeScene(const Description& description,
                                       const CompileOptions& options, Warnings& warnings) {
    auto scene = std::make_unique<Scene>();
    const bool seesAll =
        warnings.Try([&] { ReadView(description, options, scene.get(), warnings); });
    warnings.Try([&] { ReadMedia(description, scene.get(), warnings); });

    scene->textureSeconds = Timed([&] {
        scene->textures = TextureTable(description, warnings);
        scene->materials = MaterialTable(description, scene->textures, warnings);
    });
    warnings.Try([&] {
        scene->integrator =
            MakeIntegrator(description.integrator, options.maxDepth, scene->isVolumetric,
                           WhyNotBdpt(description, options, *scene), warnings);
    });
    scene->shapeSeconds = Timed([&] {
        warnings.Try([&] {
            scene->shapes = ShapeTable(description, scene->textures, warnings);
            scene->hasPanes = HasPanes(*scene);
            scene->hidesShapes = HidesShapes(*scene);
            if (seesAll) CheckCamera(*scene, description.camera.loc);
            scene->lights = LightTable(description, scene->shapes, scene->textures,
                                       options.lightsAsPbrtV3, warnings);
            if (TracesFromLights(scene->integrator))
                scene->emission =
                    std::make_unique<const LightEmission>(scene->lights, scene->shapes.bounds);
        });
    });
    warnings.ThrowErrors();
    scene->acceleratorSeconds =
        Timed([&] { scene->accelerator = Accelerator(scene->shapes, scene->textures); });

    if (std::ranges::count(scene->media.ofShapes, ShapeEntity::kSurrounding,
                           &MediumTable::Sides::outside) > 0)
        scene->media.ofCamera = VolumesAbout(
            *scene, scene->camera.GenerateRay({scene->film.resolution.cast<float>() / 2}).o);
    if (const double share = ShareOpenBehind(*scene); share > 0) {
        scene->hidesShapes = true;
        warnings.Add({},
                     "single-sided surfaces are not shown from behind; set doubleSided for them",
                     fmt::format("in {:.1f} % of the image", 100 * share));
    }
    scene->isMoving = scene->camera.motion || !scene->shapes.motions.empty();

    // A black picture would be the first sign of it.
    if (scene->lights.Count() == 0 && !scene->mediaEmit)
        warnings.Add(description.integrator.loc,
                     "the scene has no lights: the image will be black");
    const Bounds3f& bounds = scene->shapes.bounds;
    if (bounds.IsEmpty()) warnings.Add({}, "the scene has no shapes");
    if (const float size = bounds.Diagonal().norm();
        scene->shapes.TriangleCount() > 0 && size < kSmallestScene)
        warnings.Add({}, "the scene is too small for its light to be right",
                     fmt::format("it is {:g} across, which should be {:g} or more; scale it up",
                                 size, kSmallestScene));
    return scene;
}

constexpr double kLeastRatio = 20;
// Of the volume that half the area and the thickness make: sides and bevels are area, too.
constexpr double kLeastFilled = 0.75;

using Vec3d = Eigen::Vector3d;
using Triangles = std::vector<std::array<uint32_t, 3>>;

Triangles Welded(const Mesh& mesh) {
    std::map<std::array<float, 3>, uint32_t> first;
    const auto weld = [&](uint32_t i) {
        const Vec3f& p = mesh.p[i];
        return first.try_emplace({p.x(), p.y(), p.z()}, i).first->second;
    };
    Triangles triangles;
    for (const auto& t : mesh.triangles) triangles.push_back({weld(t[0]), weld(t[1]), weld(t[2])});
    return triangles;
}

bool IsClosed(const Triangles& triangles) {
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    for (const auto& t : triangles)
        for (int k = 0; k < 3; ++k) {
            const uint32_t a = t[k], b = t[(k + 1) % 3];
            ++edges[std::minmax(a, b)];
        }
    return std::ranges::all_of(edges, [](const auto& e) { return e.second == 2; });
}

bool IsSlab(const Mesh& mesh, const Triangles& part) {
    if (!IsClosed(part)) return false;
    const Vec3d origin = mesh.p[part[0][0]].cast<double>();
    const auto at = [&](uint32_t i) { return Vec3d(mesh.p[i].cast<double>() - origin); };
    Vec3d n = Vec3d::Zero(), along = Vec3d::Zero();
    double area = 0, volume = 0;
    for (const auto& t : part) {
        const Vec3d a = at(t[0]), b = at(t[1]), c = at(t[2]);
        const Vec3d cross = (b - a).cross(c - a);
        if (cross.squaredNorm() > n.squaredNorm()) n = cross;
        area += cross.norm() / 2;
        volume += a.dot(b.cross(c)) / 6;
    }
    if (!(n.norm() > 0)) return false;
    n.normalize();
    // Across the normal, along the longest edge: rectangles are measured along their sides.
    for (const auto& t : part)
        for (int k = 0; k < 3; ++k) {
            Vec3d edge = at(t[(k + 1) % 3]) - at(t[k]);
            edge -= edge.dot(n) * n;
            if (edge.squaredNorm() > along.squaredNorm()) along = edge;
        }
    along.normalize();
    const auto extent = [&](const Vec3d& axis) {
        double least = kInfinity, most = -least;
        for (const auto& t : part)
            for (const uint32_t i : t) {
                least = std::min(least, axis.dot(at(i)));
                most = std::max(most, axis.dot(at(i)));
            }
        return most - least;
    };
    const double thickness = extent(n), across = std::min(extent(along), extent(n.cross(along)));
    return thickness > 0 && across >= kLeastRatio * thickness &&
           std::abs(volume) >= kLeastFilled * thickness * area / 2;
}

}  // namespace

std::unique_ptr<const Scene> Compile(const Description& description, const CompileOptions& options,
                                     Warnings& warnings) {
    std::unique_ptr<const Scene> scene;
    RunWithThreads(options.threads, [&] { scene = MakeScene(description, options, warnings); });
    return scene;
}

int CountSlabs(const Mesh& mesh) {
    const Triangles all = Welded(mesh);
    // Vertices of the same part have the same root.
    std::vector<uint32_t> parents(mesh.p.size());
    std::iota(parents.begin(), parents.end(), 0u);
    const auto rootOf = [&](uint32_t i) {
        while (parents[i] != i) i = parents[i] = parents[parents[i]];
        return i;
    };
    for (const auto& t : all)
        for (int k = 1; k < 3; ++k) parents[rootOf(t[k - 1])] = rootOf(t[k]);
    std::map<uint32_t, Triangles> parts;
    for (const auto& t : all) parts[rootOf(t[0])].push_back(t);
    return int(
        std::ranges::count_if(parts, [&](const auto& part) { return IsSlab(mesh, part.second); }));
}

}  // namespace lull
