// Recorders, which are told of a path's vertices. The loop over a path is compiled for each of
// them, so that where none is needed there is not even a branch.
#pragma once

#include "renderer/base/math.h"

namespace lull {

struct Path;
struct Hit;
struct SurfaceInteraction;
class Bsdf;

// The default for all callbacks: records nothing.
struct NoRecorder {
    // Whether a path at its greatest depth has to continue for the recorder.
    static constexpr bool Wanted() { return false; }
    // The path, of this throughput, has found light of light `index`: that of a sample of it, or
    // its emission.
    static void FindLight(const Path&, int, const Rgb&) {}
    // The path's ray, of unit direction, ends: it leaves the scene, is at a surface whose BSDF is
    // not yet known, or is scattered by a medium at p, at this distance. The path has found the
    // emission there.
    static void LeaveScene(const Path&) {}
    static void ReachSurface(const Path&, const Hit&, const SurfaceInteraction&) {}
    static void MeetMedium(const Path&, float, const Vec3f&) {}
    // It has come to a surface of this BSDF.
    static void MeetSurface(const Path&, const Hit&, const SurfaceInteraction&, const Bsdf&) {}
    // It is scattered; `isTransmission`: through the surface, or medium.
    static void Scatter(const Path&, bool) {}
    static void End(const Path&) {}
};

}  // namespace lull
