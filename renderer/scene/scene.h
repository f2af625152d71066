// Everything that a ray can hit, ready to be rendered; immutable once compiled.
#pragma once

#include <memory>

#include "renderer/base/sampler.h"
#include "renderer/scene/cameras/camera.h"
#include "renderer/scene/cameras/film_settings.h"
#include "renderer/scene/geometry/accelerator.h"
#include "renderer/scene/geometry/shape_table.h"
#include "renderer/scene/integrator.h"
#include "renderer/scene/lights/light_emission.h"
#include "renderer/scene/lights/light_table.h"
#include "renderer/scene/materials/material.h"
#include "renderer/scene/media/medium_table.h"
#include "renderer/scene/textures/texture.h"

namespace lull {

struct Scene {
    FilmSettings film;
    Filter filter;
    Camera camera;                   // of a pair, the left eye's
    std::optional<Camera> rightEye;  // of a pair
    // Whether the camera is the right eye's, alone: its samples are those that it has in the pair.
    bool isRightAlone = false;

    const Camera& CameraOf(const CameraSample& sample) const {
        return sample.isRight ? *rightEye : camera;
    }

    // As the scene's directives ask; the command line can override them.
    SamplerKind sampler = SamplerKind::Sobol;
    int samplesPerPixel = 16;
    Integrator integrator;
    bool isMoving = false;      // shapes, instances or the camera, while the shutter is open
    bool isVolumetric = false;  // has visible media, or interfaces that shadow rays pass
    bool hasPanes = false;      // has surfaces with kLetsThrough
    bool hidesShapes = false;   // from the camera
    bool mediaEmit = false;     // light

    TextureTable textures;
    MaterialTable materials;
    ShapeTable shapes;
    MediumTable media;
    LightTable lights;
    std::unique_ptr<const LightEmission> emission;  // of a BdptIntegrator; null: none
    Accelerator accelerator;

    // Seconds that the parts of compilation took, for reports.
    double textureSeconds = 0, shapeSeconds = 0, acceleratorSeconds = 0;
};

struct CompileOptions {
    FilmOverrides film;
    int maxDepth = -1;  // -1: as the scene says
    // Choose and sample lights as pbrt-v3 does, for its estimator: by tables, however many there
    // are, and environment maps by their whole brightness.
    bool lightsAsPbrtV3 = false;
    int threads = 0;  // for all that is made in parallel; 0: one per core
};

// Compiles a description. Throws Error, with file and line, for anything wrong or unsupported, and
// the errors that parsing left in `warnings`: for all of it, as Warnings::ThrowErrors() has it.
std::unique_ptr<const Scene> Compile(const Description&, const CompileOptions&, Warnings&);

// Returns the number of closed parts of a mesh, such as window panes, that are flat, and at least
// 20 times as wide, in both directions, as they are thick. Vertices at the same place are the same.
int CountSlabs(const Mesh&);

}  // namespace lull
