// Makes parameters for tests, as a parser would.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "renderer/input/description.h"

namespace lull {

inline FileLoc LocAt(int line) { return {std::make_shared<const std::string>("scene.pbrt"), line}; }

inline Parameter Floats(const std::string& name, std::vector<float> values) {
    return {ParameterType::Float, name, LocAt(7), std::move(values)};
}
inline Parameter Float(const std::string& name, float value) { return Floats(name, {value}); }
inline Parameter Int(const std::string& name, int value) {
    return {ParameterType::Integer, name, LocAt(7), std::vector<int>{value}};
}
inline Parameter Bool(const std::string& name, bool value) {
    return {ParameterType::Bool, name, LocAt(7), std::vector<int>{value}};
}
inline Parameter String(const std::string& name, const std::string& value) {
    return {ParameterType::String, name, LocAt(7), std::vector<std::string>{value}};
}
inline Parameter Color(const std::string& name, const Rgb& c) {
    return {ParameterType::Spectrum, name, LocAt(7), std::vector<float>{c.x(), c.y(), c.z()}};
}
inline Parameter Grey(const std::string& name, float value) {
    return Color(name, Rgb::Constant(value));
}
inline Parameter PointParameter(const std::string& name, std::vector<float> values) {
    return {ParameterType::Point3, name, LocAt(7), std::move(values)};
}
inline Parameter VectorParameter(const std::string& name, float x, float y, float z) {
    return {ParameterType::Vector3, name, LocAt(7), std::vector<float>{x, y, z}};
}

}  // namespace lull
