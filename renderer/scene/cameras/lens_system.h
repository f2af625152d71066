// Traces rays from the film through the lenses of a camera (Kolb, Mitchell and Hanrahan 1995), as
// pbrt-v3's realistic camera does (3rd ed., 6.4).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/base/math.h"

namespace lull {

// Lies where the axis meets it; lengths in metres.
struct LensInterface {
    double radius;          // of curvature, positive if convex as seen from the scene; 0: a stop
    double thickness;       // to the next interface towards the film; of the last one: to the film
    double eta;             // index of refraction on the film's side
    double apertureRadius;  // no light passes farther from the axis
};

// Stands on the z axis of camera space, with the film at z = 0 and the scene at positive z.
class LensSystem {
  public:
    struct Settings {
        std::vector<LensInterface> interfaces;  // from the scene to the film; at least one
        Vec2f filmExtent;                       // width and height of the film, metres
        float focusDistance;                    // from the film, metres; positive
        bool simpleWeighting;                   // see Generate
        float exposureTime;                     // seconds, at least 0
        FileLoc loc;                            // for messages, as is the next
        std::string file = {};                  // that the interfaces were read from
    };

    // Moves the lenses to focus at the distance, by the thick-lens approximation, and bounds the
    // exit pupil for each distance from the centre of the film, with `threads` threads (0: all).
    // Throws Error if no light passes along the axis, or they cannot focus this near.
    LensSystem(const Settings&, int threads);

    // Generates the ray, in camera space, of the point (s, t) of the film, in [0, 1] from the left
    // and from the top of the image, through the point of the exit pupil's bounds that u chooses;
    // the direction is unit. If no light passes, the weight of its radiance is 0 and there is no
    // ray. Otherwise the weight is cos^4 of the angle at the film times the area of those bounds;
    // with simple weighting it is divided by that area for the centre of the film, else by the
    // squared distance from film to lens, and multiplied by the exposure time.
    Ray Generate(const Vec2f& st, const Vec2f& u, float* weight) const;

  private:
    struct Line {
        Eigen::Vector3d o, d;
    };
    struct Area {
        Eigen::Vector2d lower, upper;
    };

    double RearZ() const { return interfaces.back().thickness; }
    double FrontZ() const;
    // Follow a ray to the other side; false if it does not get there.
    bool TraceFromFilm(Line*) const;
    bool TraceFromScene(Line*) const;
    double FocusedRearZ(const Settings&) const;
    Area BoundExitPupil(double r0, double r1, const std::vector<Vec2f>& points) const;

    std::vector<LensInterface> interfaces;
    std::vector<Area> pupils;  // by distance from the film's centre, in the lens's plane
    Vec2f filmExtent;
    double filmRadius;  // half its diagonal
    double scale;       // of weights
};

// Traces many rays through the lenses of a camera at once, as wide as the processor's vectors are.

// Each ray has its number in every array.
struct LensBundle {
    static constexpr size_t kMost = 64;
    using Values = std::array<double, kMost>;

    size_t count = 0;
    Values ox, oy, oz, dx, dy, dz;            // origins, directions
    std::array<Eigen::Vector2d, kMost> rear;  // where they were to meet the rear lens

    bool IsFull() const { return count == kMost; }
    // Adds a ray from a point of the film to one at the rear lens. There must be room.
    void Add(const Eigen::Vector3d& film, const Eigen::Vector3d& lens);
    // Follows all from the film to the scene and keeps those that get there, in their order.
    void TraceFromFilm(std::span<const LensInterface>);
};

// Reads the lens file of pbrt-v3: for each interface, from the scene to the film, radius of
// curvature (0: the stop), thickness, index of refraction and diameter, lengths in millimetres.
// Throws Error, beginning with the file, if a row is cut short, there are none or too many, or a
// number is out of range. `loc` is the place that names the file.
std::vector<LensInterface> LoadLens(const std::string& path, const FileLoc& loc);

}  // namespace lull
