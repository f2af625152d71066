// Interpolates between two transforms as pbrt-v3 does; all motion uses this.
#pragma once

#include <span>

#include "renderer/input/description.h"

namespace lull {

// When the shutter opens and closes, in the scene's units of time; open <= close.
struct Shutter {
    double open = 0, close = 1;
};

// Reads "shutteropen" and "shutterclose" of the camera, and swaps them if they are the wrong way
// round. Throws Error if they are not finite.
Shutter ReadShutter(const Entity& camera);

// Represents a transform that goes from one matrix to another in a span of time and is constant
// before and after. Both are decomposed into translation, rotation and the rest by polar
// decomposition (Shoemake and Duff 1992); rotations are interpolated on the shorter arc, the others
// linearly. Time runs from 0, when the shutter opens, to 1, when it closes.
class AnimatedTransform {
  public:
    // `startTime` and `endTime` are in the scene's units, like the shutter's. If the shutter is
    // open for no time at all, the transform is that of this moment.
    AnimatedTransform(const Mat4d& start, const Mat4d& end, double startTime, double endTime,
                      const Shutter& shutter);

    // Returns the transform at `time` in [0, 1].
    Mat4d At(double time) const;

    // Returns whether it is the same while the shutter is open.
    bool IsConstant() const { return isConstant; }

    // Returns whether every point moves along a straight line at constant speed.
    bool IsLinear() const { return cosHalfAngle >= 1 && startTime <= 0 && endTime >= 1; }

    // Bounds the distance of a point of the box from the straight line between its positions at two
    // times `step` apart: step^2 / 8 times the greatest acceleration.
    double Sagitta(const Bounds3f& box, double step) const;

  private:
    struct Parts {
        Eigen::Vector3d translation;
        Eigen::Quaterniond rotation;
        Eigen::Matrix3d scale;  // and shear, and mirror
    };
    static Parts Decompose(const Mat4d& m);

    Mat4d start, end;
    double startTime, endTime;
    std::array<Parts, 2> parts;
    double cosHalfAngle = 1;  // of the rotation between both
    bool isConstant = true;
};

// Returns the product of the transforms, outermost first, at `time` in [0, 1].
Mat4d ProductAt(std::span<const AnimatedTransform> transforms, double time);

// Returns a box that holds the transformed one.
Bounds3f TransformBox(const Mat4d& m, const Bounds3f& box);

// Returns bounds of `box` as it moves, for n + 1 times 0, 1/n ... 1, such that at every time in
// between the linearly interpolated box bounds it too.
std::vector<Bounds3f> BoundMotion(std::span<const AnimatedTransform> transforms, Bounds3f box);

}  // namespace lull
