// Reads the parameter lists of directives.

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <utility>

#include "renderer/input/pbrt/pbrt_state.h"
#include "renderer/input/spectrum.h"
#include "stopping/base/input_file.h"

namespace lull {
namespace {

// Bounds the parameters of a directive, each compared with all others; real ones have dozens.
constexpr size_t kMostParameters = 1000;

enum class Encoding { Plain, Rgb, Xyz, Blackbody, Sampled };

struct TypeName {
    std::string_view name;
    ParameterType type;
    int multiple;  // the count of numbers must be one of these
    Encoding encoding = Encoding::Plain;
};

struct NewerName {
    std::string_view old, name;
};

// Types that pbrt-v4 no longer has, and what it has instead.
constexpr NewerName kGoneTypes[] = {{"color", "rgb"},
                                    {"normal3", "normal"},
                                    {"point", "point3"},
                                    {"vector", "vector3"},
                                    {"xyz", "rgb"}};

constexpr std::array<TypeName, 17> kTypes = {{
    {"integer", ParameterType::Integer, 1},
    {"float", ParameterType::Float, 1},
    {"bool", ParameterType::Bool, 1},
    {"string", ParameterType::String, 1},
    {"texture", ParameterType::Texture, 1},
    {"point2", ParameterType::Point2, 2},
    {"vector2", ParameterType::Vector2, 2},
    {"point", ParameterType::Point3, 3},
    {"point3", ParameterType::Point3, 3},
    {"vector", ParameterType::Vector3, 3},
    {"vector3", ParameterType::Vector3, 3},
    {"normal", ParameterType::Normal, 3},
    {"rgb", ParameterType::Spectrum, 3, Encoding::Rgb},
    {"color", ParameterType::Spectrum, 3, Encoding::Rgb},
    {"xyz", ParameterType::Spectrum, 3, Encoding::Xyz},
    {"blackbody", ParameterType::Spectrum, 2, Encoding::Blackbody},
    {"spectrum", ParameterType::Spectrum, 2, Encoding::Sampled},
}};

struct Declaration {
    const TypeName* type;
    std::string name;
};

Declaration ReadDeclaration(const Token& token, PbrtVersion version) {
    std::string_view rest = token.text;
    const auto takeWord = [&rest] {
        rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
        const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
        rest.remove_prefix(word.size());
        return word;
    };
    const std::string_view type = takeWord(), name = takeWord();
    if (name.empty() || !takeWord().empty())
        throw Error(token.loc, Describe(token) + " declares no parameter; write \"type name\"");
    if (const auto* gone = std::ranges::find(kGoneTypes, type, &NewerName::old);
        version == PbrtVersion::V4 && gone != std::end(kGoneTypes))
        throw Error(token.loc, "parameter type \"" + std::string(type) +
                                   "\" is pbrt-v3's, in a scene for pbrt-v4; write \"" +
                                   std::string(gone->name) + "\"");
    const auto* known = std::ranges::find(kTypes, type, &TypeName::name);
    if (known == kTypes.end())
        throw Error(token.loc,
                    "unknown parameter type '" + Printable(type) + "' in " + Describe(token));
    return {known, std::string(name)};
}

template <typename T, typename Take>
void ReadValues(PbrtLexer& lexer, const Token& owner, const char* what, std::vector<T>* values,
                const Take& take) {
    const auto fail = [&](const Token& found) {
        throw Error(found.loc, "parameter " + Describe(owner) + " expects " + what +
                                   ", but there is " + Describe(found));
    };
    T value;
    if (take(&value)) {
        values->push_back(std::move(value));
        return;
    }
    const Token open = lexer.Take();
    if (open.kind != TokenKind::Open) fail(open);
    while (take(&value)) values->push_back(std::move(value));
    const Token close = lexer.Take();
    if (close.kind != TokenKind::Close) fail(close);
}

std::vector<float> ReadFloats(PbrtLexer& lexer, const Token& owner) {
    std::vector<float> values;
    ReadValues(lexer, owner, "numbers", &values, [&](float* v) { return lexer.TakeNumber(v); });
    return values;
}

std::vector<int> ReadInts(PbrtLexer& lexer, const Token& owner, PbrtVersion version,
                          Warnings& warnings) {
    std::vector<int> values;
    bool cut = false;
    ReadValues(lexer, owner, "integers", &values,
               [&](int* v) { return lexer.TakeNumber(v, &cut); });
    if (cut && version == PbrtVersion::V4)
        throw Error(owner.loc, "parameter " + Describe(owner) + " has a number with a fraction");
    if (cut) warnings.Add(owner.loc, "integer with a fraction, which is cut off", Describe(owner));
    return values;
}

std::vector<std::string> ReadStrings(PbrtLexer& lexer, const Token& owner) {
    std::vector<std::string> values;
    ReadValues(lexer, owner, "quoted strings", &values, [&](std::string* v) {
        if (lexer.Peek().kind != TokenKind::String) return false;
        *v = lexer.Take().text;
        return true;
    });
    return values;
}

std::vector<int> ReadBools(PbrtLexer& lexer, const Token& owner, PbrtVersion version,
                           Warnings& warnings) {
    std::vector<int> values;
    ReadValues(lexer, owner, "true or false", &values, [&](int* v) {
        const Token& next = lexer.Peek();
        const bool isText = next.kind == TokenKind::String || next.kind == TokenKind::Word;
        if (!isText || (next.text != "true" && next.text != "false")) return false;
        if (version == PbrtVersion::V4 && next.kind == TokenKind::String)
            warnings.Add(next.loc, "true and false stand without quotes in pbrt-v4",
                         Describe(owner));
        *v = lexer.Take().text == "true";
        return true;
    });
    return values;
}

std::vector<TextureRef> ReadTexture(PbrtLexer& lexer, const Token& owner,
                                    const ParameterContext& context) {
    const std::vector<std::string> names = ReadStrings(lexer, owner);
    if (names.size() != 1)
        throw Error(owner.loc, "parameter " + Describe(owner) + " must name one texture");
    return {
        {names[0], context.floatTextures.Find(names[0]), context.spectrumTextures.Find(names[0])}};
}

// Returns whether a texture parameter is to be left out, since no texture has that name. Otherwise
// that is found out where the parameter is looked up, if it is.
bool IsSubstituted(const Parameter& parameter, const Token& owner, Warnings& warnings) {
    const TextureRef& texture = std::get<std::vector<TextureRef>>(parameter.values)[0];
    if (!warnings.Substitutes() || texture.floatIndex >= 0 || texture.spectrumIndex >= 0)
        return false;
    warnings.Substitute(owner.loc,
                        "parameter " + Describe(owner) + ": there is no texture \"" +
                            Printable(texture.name) + "\"",
                        "it is left out");
    return true;
}

void Append(const Rgb& rgb, std::vector<float>* values) {
    values->insert(values->end(), {rgb.x(), rgb.y(), rgb.z()});
}

Rgb SpectrumOfFile(const std::string& path, const FileLoc& loc, Warnings& warnings) {
    if (ReasonNotToRead(path).empty()) return LoadSpectrum(path, loc, &warnings);
    try {
        return LoadSpectrum(path, loc, &warnings);
    } catch (const Error& error) {
        warnings.Substitute(error, "black stands in");
        return Rgb::Zero();
    }
}

std::vector<float> ReadSpectrumFiles(PbrtLexer& lexer, const Token& owner,
                                     ParameterContext& context, Warnings& warnings) {
    std::vector<float> values;
    for (const std::string& name : ReadStrings(lexer, owner)) {
        const std::string path = (std::filesystem::path(context.directory) / name).string();
        auto known = context.spectra.find(path);
        if (known == context.spectra.end())
            known = context.spectra.emplace(path, SpectrumOfFile(path, owner.loc, warnings)).first;
        Append(known->second, &values);
    }
    return values;
}

std::vector<float> ConvertSpectrum(std::vector<float> given, Encoding encoding, const Token& owner,
                                   Warnings& warnings) {
    std::vector<float> values;
    switch (encoding) {
        case Encoding::Xyz:
            for (size_t i = 0; i < given.size(); i += 3)
                Append(RgbFromXyz(given[i], given[i + 1], given[i + 2]), &values);
            break;
        case Encoding::Blackbody:
            for (size_t i = 0; i < given.size(); i += 2)
                Append(RgbFromBlackbody(given[i], owner.loc) * given[i + 1], &values);
            break;
        case Encoding::Sampled:
            Append(RgbFromSamples(given, owner.loc, &warnings), &values);
            break;
        default:
            values = std::move(given);
    }
    if (!std::ranges::all_of(values, [](float v) { return std::isfinite(v); }))
        throw Error(owner.loc, "the values of " + Describe(owner) + " are too large");
    return values;
}

std::vector<float> ConvertRgb(std::vector<float> values, const Mat3f& rgbFromColorSpace,
                              const Token& owner) {
    for (size_t i = 0; i + 2 < values.size(); i += 3) {
        const Vec3f given(values[i], values[i + 1], values[i + 2]);
        if (!(given.minCoeff() >= 0))
            throw Error(owner.loc, "the colour of " + Describe(owner) + " has a part below 0");
        const Vec3f rgb = rgbFromColorSpace * given;
        std::copy_n(rgb.data(), 3, &values[i]);
    }
    return values;
}

std::vector<float> ReadFloatsOf(const TypeName& type, PbrtLexer& lexer, const Token& owner) {
    std::vector<float> values = ReadFloats(lexer, owner);
    if (values.size() % type.multiple != 0)
        throw Error(owner.loc, "parameter {} has {} numbers, no multiple of {}", Describe(owner),
                    values.size(), type.multiple);
    return values;
}

void ReadSpectrumV4(const TypeName& type, PbrtLexer& lexer, const Token& owner,
                    const Mat3f& rgbFromColorSpace, Parameter* parameter) {
    switch (type.encoding) {
        case Encoding::Sampled:
            parameter->type =
                lexer.NextIsText() ? ParameterType::SpectrumName : ParameterType::SpectrumSamples;
            if (parameter->type == ParameterType::SpectrumName)
                parameter->values = ReadStrings(lexer, owner);
            else
                parameter->values = ReadFloatsOf(type, lexer, owner);
            break;
        case Encoding::Blackbody:
            parameter->type = ParameterType::Blackbody;
            parameter->values = ReadFloats(lexer, owner);
            break;
        default:
            parameter->values =
                ConvertRgb(ReadFloatsOf(type, lexer, owner), rgbFromColorSpace, owner);
    }
}

}  // namespace

Parameters ReadParameters(PbrtLexer& lexer, ParameterContext& context,
                          const Mat3f& rgbFromColorSpace, Warnings& warnings) {
    Parameters parameters;
    while (lexer.Peek().kind == TokenKind::String) {
        const Token owner = lexer.Take();
        Declaration declaration = ReadDeclaration(owner, context.version);
        const TypeName& type = *declaration.type;
        Parameter parameter{type.type, std::move(declaration.name), owner.loc, {}};
        switch (type.type) {
            case ParameterType::Integer:
                parameter.values = ReadInts(lexer, owner, context.version, warnings);
                break;
            case ParameterType::Bool:
                parameter.values = ReadBools(lexer, owner, context.version, warnings);
                break;
            case ParameterType::String:
                parameter.values = ReadStrings(lexer, owner);
                break;
            case ParameterType::Texture:
                parameter.values = ReadTexture(lexer, owner, context);
                if (IsSubstituted(parameter, owner, warnings)) continue;
                break;
            case ParameterType::Spectrum:
                if (context.version == PbrtVersion::V4)
                    ReadSpectrumV4(type, lexer, owner, rgbFromColorSpace, &parameter);
                else if (type.encoding == Encoding::Sampled && lexer.NextIsText())
                    parameter.values = ReadSpectrumFiles(lexer, owner, context, warnings);
                else
                    parameter.values = ConvertSpectrum(ReadFloatsOf(type, lexer, owner),
                                                       type.encoding, owner, warnings);
                break;
            default:
                parameter.values = ReadFloatsOf(type, lexer, owner);
        }
        if (parameters.All().size() == kMostParameters)
            throw Error(owner.loc, "a directive has more than {} parameters", kMostParameters);
        const bool isAgain = std::ranges::any_of(parameters.All(), [&](const Parameter& p) {
            return p.type == parameter.type && p.name == parameter.name;
        });
        if (isAgain)
            warnings.Add(owner.loc, "parameter given again; the later one counts", Describe(owner));
        parameters.Add(std::move(parameter));
    }
    return parameters;
}

}  // namespace lull
