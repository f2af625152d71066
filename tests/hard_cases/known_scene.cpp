#include "tests/hard_cases/known_scene.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "tests/renderer/scene_of.h"
#include "tests/renderer/transport/pixel_statistics.h"

namespace lull {

std::unique_ptr<const Scene> MakeScene(const KnownScene& known) {
    std::optional<TemporaryDirectory> own;
    const TemporaryDirectory& directory = known.directory ? *known.directory : own.emplace();
    const std::string text = fmt::format(
        "LookAt {}\nCamera \"perspective\" \"float fov\" [{}]\n"
        "Film \"image\" \"integer xresolution\" [{}] \"integer yresolution\" [{}]\n"
        "Integrator \"path\" {}\nWorldBegin\n{}\nWorldEnd\n",
        known.camera, known.fov, known.size, known.size, known.integrator, known.world);
    CompileOptions options;
    options.threads = 1;
    return SceneIn(directory.Write("case.pbrt", text), options);
}

HardCaseResult CompareRadiance(const Scene& scene, double answer, double relative, int samples,
                               const HardCaseOptions& options, const std::string& note) {
    std::vector<HardCaseResult> results;
    for (const Estimator estimator : {Estimator::Combined, Estimator::PbrtV3}) {
        const PixelStatistics pixels =
            MeasurePixels(scene, estimator, SamplerKind::Random, samples, options.seed);
        double mean = 0, variance = 0;
        for (size_t i = 0; i < pixels.mean.size(); ++i) {
            mean += pixels.mean[i].y();
            variance += pixels.variance[i].y() / samples;
        }
        const double n = double(pixels.mean.size());
        HardCaseResult result{answer, mean / n, relative * answer + 4.5 * std::sqrt(variance) / n,
                              note};
        if (pixels.rejected > 0) {
            result.ours = std::nan("");
            result.note += fmt::format(" ({} samples rejected)", pixels.rejected);
        }
        results.push_back(result);
    }
    return Worst(results);
}

std::string MeshText(const std::string& indices, const std::string& points) {
    return "Shape \"trianglemesh\" \"integer indices\" [" + indices + "] \"point P\" [" + points +
           "]\n";
}

std::string BoxText(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) {
    std::string points;
    for (int corner = 0; corner < 8; ++corner)
        for (int axis = 0; axis < 3; ++axis)
            points += fmt::format("{:.9g} ", corner >> axis & 1 ? upper[axis] : lower[axis]);
    return MeshText("0 2 3 0 3 1  4 5 7 4 7 6  0 1 5 0 5 4  2 6 7 2 7 3  0 4 6 0 6 2  1 3 7 1 7 5",
                    points);
}

std::string FloorText(double half, double z) {
    return MeshText("0 3 2 0 2 1", fmt::format("{0} {0} {2}  {1} {0} {2}  {1} {1} {2}  {0} {1} {2}",
                                               -half, half, z));
}

}  // namespace lull
