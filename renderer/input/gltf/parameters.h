// Makes parameters of a Description.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "renderer/input/description.h"

namespace lull {

// Adds parameters to an entity, all of which have the same place in a file.
class ParameterWriter {
  public:
    ParameterWriter(Parameters* parameters, FileLoc loc)
        : parameters(parameters), loc(std::move(loc)) {}

    void Floats(ParameterType type, const std::string& name, std::vector<float> values) const {
        parameters->Add({type, name, loc, std::move(values)});
    }
    void Ints(const std::string& name, std::vector<int> values) const {
        parameters->Add({ParameterType::Integer, name, loc, std::move(values)});
    }
    void Float(const std::string& name, double value) const {
        Floats(ParameterType::Float, name, {float(value)});
    }
    void Spectrum(const std::string& name, const Rgb& c) const {
        Floats(ParameterType::Spectrum, name, {c.x(), c.y(), c.z()});
    }
    void Point(const std::string& name, const Vec3f& p) const {
        Floats(ParameterType::Point3, name, {p.x(), p.y(), p.z()});
    }
    void Int(const std::string& name, int value) const { Ints(name, {value}); }
    void Bool(const std::string& name, bool value) const {
        parameters->Add({ParameterType::Bool, name, loc, std::vector<int>{value}});
    }
    void String(const std::string& name, const std::string& value) const {
        parameters->Add({ParameterType::String, name, loc, std::vector<std::string>{value}});
    }
    void Texture(const std::string& name, const TextureRef& texture) const {
        parameters->Add({ParameterType::Texture, name, loc, std::vector<TextureRef>{texture}});
    }

  private:
    Parameters* parameters;
    FileLoc loc;
};

}  // namespace lull
