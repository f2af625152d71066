// Provenance of an image, in checkpoints, headers and reports.
#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

#include "renderer/schedule/schedule.h"
#include "renderer/transport/integrator.h"

namespace lull {

struct Provenance {
    std::string version;
    std::string scene;  // the file, as given
    uint64_t seed = 0;
    SamplerKind sampler = SamplerKind::Sobol;
    Estimator estimator = Estimator::Combined;
    std::string criterion, checksum;  // the stopping rule; of its file, if any
    ScheduleOptions schedule;
    int maxDepth = 0;
    std::string integrator = {};  // empty: paths from the camera alone
    int threads = 0;              // 0: all
    bool substitute = false;
    Vec2i resolution = {0, 0};
    PixelRect crop;
    std::string grades = {};  // how pictures are graded when noise is judged; empty: not
    std::string clock = {};   // that ends the render, in words; empty: none
};

// Names a scene in thresholds files: the file without folder and extension, or the folder where the
// file is called scene.pbrt. Not empty, without characters that the format reserves.
std::string SceneName(const std::string& file);

// A part of the provenance, by its name in each of the places that tell it; null: not told there.
struct NamedProvenance {
    const char* identity;  // of checkpoints and ranks
    const char* exr;       // an attribute of the header, a text
    const char* json;      // a member of reports
    std::variant<bool, int, uint64_t, std::string, Vec2i, PixelRect> value;
};

// Returns all parts, in the order of reports: the only list of properties stated of an image
// besides its results. Without the hash of the scene.
std::vector<NamedProvenance> PartsOf(const Provenance&);

// Returns a value as text: "yes", "800x600", "x0,x1,y0,y1".
std::string TextOf(const NamedProvenance&);

// Settings that decide the pixels and the inputs of criteria, besides the samples: scene, seed,
// rule, ... A render continues only if all of it is the same.
using RenderIdentity = std::map<std::string, std::string>;

// Returns the parts that have a name there, and the hash of the scene (SceneHash()).
RenderIdentity IdentityOf(const Provenance&, const std::string& sceneHash);

// Returns the same as a text, a line each.
std::string TextOf(const RenderIdentity&);

}  // namespace lull
