// Replaces the accelerator's queries in a program that measures Embree: they do the same, and
// record the rays that a thread traces. A program that links this does not link the library's.
#pragma once

#include <span>
#include <vector>

#include "renderer/scene/geometry/accelerator_internal.h"
#include "renderer/scene/scene.h"

namespace lull {

struct RecordedRay {
    Ray ray;
    int bounce;
};

struct RayLog {
    std::vector<RecordedRay> nearest, occlusion;
    int bounce = -1;  // the caller sets it back at the start of each path
};

// Where this thread's rays go; null: nowhere.
extern thread_local RayLog* rayLog;

// Lets the callbacks of the scene's shapes see packets, by calling them ray by ray; rays that are
// traced one at a time find the same as before. Returns the scene in Embree's form.
RTCScene AdmitPackets(const Scene& scene);

// Traces the rays in packets of 8 or 16, gathering each packet first; `areCoherent` tells Embree
// that the rays of a packet have similar directions. Returns how many hit.
template <int width>
size_t TracePackets(RTCScene world, std::span<const RecordedRay> rays, bool isOcclusion,
                    bool areCoherent);

}  // namespace lull
