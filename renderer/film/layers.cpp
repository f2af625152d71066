#include "renderer/film/layers.h"

namespace lull {

void PutPlanes(const Film& film, const Layers& layers, const PixelRect& pixels,
               StateWriter* writer) {
    ForEachPlane(film, layers, pixels, [&](const char*, const auto& plane, const PixelRect& part) {
        plane.Put(part, writer);
    });
}

void GetPlanes(StateReader* reader, const PixelRect& pixels, Film* film, const Layers& layers) {
    ForEachPlane(*film, layers, pixels,
                 [&](const char*, auto& plane, const PixelRect& part) { plane.Get(part, reader); });
}

}  // namespace lull
