// Scenes that are tiny, huge or far from the origin: nothing may leak, and no surface may shade
// itself; and geometry that has no business to be there, but is.
#include <fmt/format.h>

#include "tests/hard_cases/known_scene.h"
#include "tests/renderer/bsdf/sphere_statistics.h"

namespace lull {

namespace {

std::string PointText(const Eigen::Vector3d& p) {
    return fmt::format("{:.9g} {:.9g} {:.9g}", p.x(), p.y(), p.z());
}

// A place for a scene that is one unit large: multiplied by `scale`, then moved by `offset`.
struct Placement {
    double scale, offset;

    std::string Text() const {
        return fmt::format("scale {:g}{}", scale,
                           offset > 0 ? fmt::format(", offset {:g}", offset) : "");
    }
    Eigen::Vector3d operator()(double x, double y, double z) const {
        return scale * Eigen::Vector3d(x, y, z) + offset * Eigen::Vector3d(1, -0.7, 0.4);
    }
    std::string Camera(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
        return PointText((*this)(from.x(), from.y(), from.z())) + "  " +
               PointText((*this)(to.x(), to.y(), to.z())) + "  0 1 0";
    }
};

// At an offset of 1e5, neighbouring floats are 0.008 apart.
constexpr Placement kPlacements[] = {{1e-4, 0}, {1e-2, 0}, {1, 0},   {1e3, 0},
                                     {1e6, 0},  {1, 1e2},  {1, 1e4}, {1e3, 1e5}};

std::unique_ptr<const Scene> Box(const Placement& place) {
    return MakeScene({.world = BoxText(place(-1, -1, -1), place(1, 1, 1))});
}

// Rays from anywhere inside a closed box, a quarter of them at its edges.
HardCaseResult WatertightBox(const HardCaseOptions& options) {
    Failures escapes;
    const int64_t rays = options.isLong ? 100'000'000 : 500'000;
    for (const Placement& place : kPlacements) {
        const auto scene = Box(place);
        test::Random random(options.seed + 1000 * (&place - kPlacements));
        const auto coordinate = [&] { return 2 * random.Float() - 1; };
        for (int64_t i = 0; i < rays; ++i) {
            const Vec3f o =
                place(0.9 * coordinate(), 0.9 * coordinate(), 0.9 * coordinate()).cast<float>();
            Vec3f d = random.Direction();
            if (i % 4 == 0) d = (place(1, coordinate(), -1).cast<float>() - o).normalized();
            Hit hit;
            escapes.Note(!scene->accelerator.Intersect({o, d, kInfinity}, &hit),
                         [&] { return fmt::format("{}, ray {}", place.Text(), i); });
        }
    }
    return escapes.Result("rays");
}

// Paths that are scattered inside a closed box, so that rays start where others have ended, also
// in its edges and corners.
HardCaseResult WatertightPaths(const HardCaseOptions& options) {
    Failures escapes;
    const int64_t rays = options.isLong ? 100'000'000 : 500'000;
    for (const Placement& place : kPlacements) {
        const auto scene = Box(place);
        test::Random random(options.seed + 1000 * (&place - kPlacements));
        const Ray start{place(0, 0, 0).cast<float>(), Vec3f(0.6f, 0.8f, 0.1f), kInfinity};
        Ray ray = start;
        for (int64_t i = 0; i < rays; ++i) {
            Hit hit;
            const bool escaped = !scene->accelerator.Intersect(ray, &hit);
            escapes.Note(escaped, [&] { return fmt::format("{}, ray {}", place.Text(), i); });
            if (escaped) {
                ray = start;
                continue;
            }
            SurfaceInteraction at;
            scene->shapes.Interact(ray, hit, kNeedsNothing, &at);
            // Any direction to the side that the ray came from; one exactly in the surface has
            // none.
            Vec3f d;
            do d = random.Direction();
            while (d.dot(at.n) == 0);
            ray = at.SpawnRay(FaceForward(d, FaceForward(at.n, at.wo)));
        }
    }
    return escapes.Result("rays");
}

// A dark room under a sky of 1e6, with a lamp and a point of light just outside: what is seen
// inside is black but for leaks.
HardCaseResult NoLeaks(const HardCaseOptions& options) {
    Failures leaks;
    for (const Placement& place : kPlacements) {
        const auto scene =
            MakeScene({.world = "LightSource \"infinite\" \"rgb L\" [1e6 1e6 1e6]\n"
                                "Material \"matte\" \"rgb Kd\" [1 1 1]\n" +
                                BoxText(place(-1, -1, -1), place(1, 1, 1)) +
                                "LightSource \"point\" \"rgb I\" [1e6 1e6 1e6] \"point from\" [" +
                                PointText(place(0.5, 1.2, 0)) +
                                "]\nAreaLightSource \"diffuse\" \"rgb L\" [1e6 1e6 1e6]\n" +
                                BoxText(place(1.1, -1, -1), place(1.2, 1, 1)),
                       .camera = place.Camera({-0.5, -0.4, -0.9}, {0.2, 0.3, 1}),
                       .fov = 100,
                       .integrator = "\"integer maxdepth\" [20]"});
        Sampler sampler(SamplerKind::Random, options.seed);
        for (int i = 0; i < (options.isLong ? 500'000 : 10'000); ++i) {
            const PathSample sample =
                RenderSample(*scene, Estimator::Combined, sampler, {i % 8, i / 8 % 8}, i / 64);
            leaks.Note(sample.rejected || !IsBlack(sample.radiance),
                       [&] { return fmt::format("{}, sample {}", place.Text(), i); });
        }
    }
    return leaks.Result("paths of 20 bounces");
}

// A matte ball of triangles under an even sky shows its albedo; shading itself makes it darker.
HardCaseResult NoAcne(const HardCaseOptions& options) {
    std::vector<HardCaseResult> results;
    for (const Placement& place : kPlacements) {
        // Subdivide an octahedron, which fills the image.
        std::string points;
        for (int axis = 0; axis < 3; ++axis)
            for (const double side : {-1.0, 1.0}) {
                Eigen::Vector3d corner = Eigen::Vector3d::Zero();
                corner[axis] = 2 * side;
                points += PointText(place(corner.x(), corner.y(), corner.z())) + ' ';
            }
        const auto scene =
            MakeScene({.world = std::string(kSky) +
                                "Material \"matte\" \"rgb Kd\" [.75 .75 .75]\n"
                                "Shape \"loopsubdiv\" \"integer levels\" [4] \"integer indices\" "
                                "[0 2 4 0 5 2 0 4 3 0 3 5 1 4 2 1 2 5 1 3 4 1 5 3] \"point P\" [" +
                                points + "]",
                       .camera = place.Camera({0.1, 0.2, -2.5}, {0, 0, 0}),
                       .fov = 20});
        results.push_back(CompareRadiance(*scene, 0.75, 1e-3, options.isLong ? 20000 : 300, options,
                                          "worst: " + place.Text()));
    }
    return Worst(results);
}

const std::string kHalf = "Material \"matte\" \"rgb Kd\" [.5 .5 .5]\n";
constexpr const char* kFromAbove = "0 0 -3  0 0 0  0 1 0";

// A floor cut in 2,000 slivers, each of them 1e5 times as long as wide, which fills the image.
HardCaseResult Slivers(const HardCaseOptions& options) {
    constexpr int kCount = 1000;
    constexpr double kWidth = 0.2, kHalfLength = 10;
    std::string points, indices;
    for (int i = 0; i <= kCount; ++i) {
        const double x = kWidth * (double(i) / kCount - 0.5);
        points += fmt::format("{0:.9g} {1} 0 {0:.9g} {2} 0 ", x, -kHalfLength, kHalfLength);
        if (i < kCount)
            indices +=
                fmt::format("{0} {1} {3} {0} {3} {2} ", 2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 3);
    }
    const auto scene = MakeScene(
        {.world = kSky + kHalf + MeshText(indices, points), .camera = kFromAbove, .fov = 2});
    return CompareRadiance(*scene, 0.5, 1e-3, options.isLong ? 100'000 : 2000, options);
}

// The same floor three times, with points and lines for triangles in between.
HardCaseResult Duplicates(const HardCaseOptions& options) {
    const auto scene =
        MakeScene({.world = kSky + kHalf + FloorText(5) + FloorText(5) + FloorText(5) +
                            MeshText("0 1 1  0 0 0  0 1 2  0 1 3", "-5 0 0  5 0 0  2 0 0  0 5 0"),
                   .camera = kFromAbove,
                   .fov = 20});
    return CompareRadiance(*scene, 0.5, 1e-3, options.isLong ? 100'000 : 2000, options);
}

// A lamp in the very plane of the floor shines on nothing of it: only the sky does.
HardCaseResult CoplanarLight(const HardCaseOptions& options) {
    const auto scene =
        MakeScene({.world = kSky + kHalf + FloorText(5) +
                            "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [1e6 1e6 1e6] "
                            "\"bool twosided\" \"true\"\n" +
                            MeshText("0 3 2 0 2 1", "2 2 0  3 2 0  3 3 0  2 3 0") + "AttributeEnd",
                   .camera = kFromAbove,
                   .fov = 20});
    return CompareRadiance(*scene, 0.5, 1e-3, options.isLong ? 100'000 : 2000, options);
}

// A camera in the floor that looks up sees the sky, whichever way it is turned.
HardCaseResult CameraOnSurface(const HardCaseOptions& options) {
    std::vector<HardCaseResult> results;
    for (const char* camera : {"0 0 0  0 0 -1  0 1 0", "1 1 0  0.5 0 -1  0 1 0"}) {
        const auto scene =
            MakeScene({.world = kSky + kHalf + FloorText(5), .camera = camera, .fov = 30});
        results.push_back(CompareRadiance(*scene, 1, 0, options.isLong ? 10'000 : 100, options));
    }
    return Worst(results);
}

// Radiance within glass is index^2 of that outside. From the centre all rays meet it upright.
HardCaseResult CameraInGlass(const HardCaseOptions& options) {
    const auto scene = MakeScene(
        {.world = kSky + std::string("Material \"glass\" \"float eta\" [1.5]\nShape \"sphere\""),
         .camera = "0 0 0  0.2 0.3 1  0 1 0",
         .fov = 60,
         .integrator = "\"integer maxdepth\" [100]"});
    return CompareRadiance(*scene, 2.25, 1e-5, options.isLong ? 10'000 : 200, options);
}

// A mesh of nothing but triangles without area, beside a floor.
HardCaseResult NothingButDegenerate(const HardCaseOptions& options) {
    const auto scene = MakeScene(
        {.world = kSky + kHalf + FloorText(5) + "AreaLightSource \"diffuse\" \"rgb L\" [9 9 9]\n" +
                  MeshText("0 1 1  0 0 0  0 1 2", "-5 0 -1  5 0 -1  2 0 -1"),
         .camera = kFromAbove,
         .fov = 20});
    return CompareRadiance(*scene, 0.5, 1e-3, options.isLong ? 100'000 : 2000, options);
}

}  // namespace

std::vector<HardCase> GeometryCases() {
    return {{"scale", "closed box, scales 1e-4 to 1e6, offsets to 1e5",
             "rays slip through between two triangles", WatertightBox},
            {"scale", "paths inside the same boxes",
             "rays that start in an edge leave through the other wall", WatertightPaths},
            {"scale", "closed room under a sky of 1e6", "light leaks along edges", NoLeaks},
            {"scale", "matte ball of triangles under an even sky",
             "acne: offsets that are right at one scale only", NoAcne},
            {"degenerate", "floor of slivers 1e5 times as long as wide",
             "normals and offsets of slivers are noise", Slivers},
            {"degenerate", "the same floor three times, points and lines as triangles",
             "surfaces at one place shade each other; NaN normals", Duplicates},
            {"degenerate", "lamp of 1e6 in the plane of the floor", "0/0 where the cosine is zero",
             CoplanarLight},
            {"degenerate", "lamp all of whose triangles have no area",
             "infinite densities; a light that cannot be sampled", NothingButDegenerate},
            {"degenerate", "camera exactly on a surface",
             "the first ray hits the surface it starts on", CameraOnSurface},
            {"degenerate", "camera in the centre of a glass ball",
             "which side is inside is guessed from the camera", CameraInGlass}};
}

}  // namespace lull
