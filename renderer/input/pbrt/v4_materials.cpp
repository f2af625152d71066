// Materials and lights of pbrt-v4.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "renderer/input/pbrt/v4.h"
#include "stopping/base/input_file.h"

namespace lull {
namespace {

void CopyRoughness(V4Reader* in, const std::string& prefix = "") {
    const std::string both = prefix + "roughness";
    for (const char* axis : {"u", "v"}) {
        const std::string to = prefix + axis + "roughness";
        if (in->given.Find(ParameterType::Float, to) || in->given.GetTexture(to))
            in->CopyFloat(to.c_str());
        else if (in->given.Find(ParameterType::Float, both) || in->given.GetTexture(both))
            in->CopyFloat(both.c_str(), to.c_str());
        else
            in->write.Float(to, 0.f);
    }
}

void CopyAllRoughness(V4Reader* in) {
    CopyRoughness(in);
    in->write.String("remapping", in->given.GetBool("remaproughness", true) ? "sqrt" : "none");
}

void CopyIndex(V4Reader* in, const char* name, float otherwise) {
    if (in->given.GetTexture(name))
        in->Fail(fmt::format("\"{}\" by a texture is not supported", name));
    float index = in->given.GetFloat(name, otherwise);
    if (const auto spectrum = in->Spectrum(name)) {
        index = IndexOf(*spectrum, in->Loc());
        if (!std::holds_alternative<Rgb>(*spectrum))
            in->Context().warnings.Add(in->Loc(), "dispersion is not rendered",
                                       "an index of refraction is that of yellow light");
    }
    in->write.Float(name, index);
}

void CopyConductor(V4Reader* in, const std::string& prefix, const char* reflectance) {
    if (const TextureRef* texture = in->given.GetTexture(reflectance)) {
        in->write.Texture("reflectance", *texture);
    } else if (in->Spectrum(reflectance)) {
        in->write.Spectrum("reflectance", in->Reflectance(reflectance, Rgb::Zero()));
    } else {
        const std::string eta = prefix + "eta", k = prefix + "k";
        const auto [n, absorption] = RgbOfConductor(
            in->Spectrum(eta.c_str()).value_or(NamedSpectrum{"metal-Cu-eta"}),
            in->Spectrum(k.c_str()).value_or(NamedSpectrum{"metal-Cu-k"}), in->Loc());
        if (const TextureRef* texture = in->given.GetTexture(eta))
            in->write.Texture("eta", *texture);
        else
            in->write.Spectrum("eta", n);
        if (const TextureRef* texture = in->given.GetTexture(k))
            in->write.Texture("k", *texture);
        else
            in->write.Spectrum("k", absorption);
    }
}

void CopyLayer(V4Reader* in) {
    in->write.Float("thickness", in->given.GetFloat("thickness", 0.01f));
    in->Ignore({"g", "maxdepth", "nsamples"});
    if (in->given.GetTexture("albedo") || (in->Surface("albedo", Rgb::Zero()) > 0).any())
        in->Fail("a coat whose layer scatters (\"albedo\" above 0) is not supported");
}

void CopyMix(V4Reader* in) {
    const Parameter* names = in->given.Find(ParameterType::String, "materials");
    const auto* two = names ? std::get_if<std::vector<std::string>>(&names->values) : nullptr;
    if (!two || two->size() != 2) in->Fail("Material \"mix\" needs two names as \"materials\"");
    // The amount is the share of the second.
    in->write.String("namedmaterial1", (*two)[1]);
    in->write.String("namedmaterial2", (*two)[0]);
    if (in->given.Find(ParameterType::Float, "amount") || in->given.GetTexture("amount"))
        in->CopyFloat("amount", "share");
    else
        in->write.Float("share", 0.5f);
}

void CopySubsurface(V4Reader* in, std::string* name) {
    CopyAllRoughness(in);
    CopyIndex(in, "eta", 1.33f);
    in->Copy(ParameterType::Float, {"g", "scale"});
    if (in->Spectrum("reflectance") || in->given.GetTexture("reflectance")) {
        *name = "kdsubsurface";
        in->CopyReflectance("reflectance", "Kd", 0.5f);
        in->CopySurface("mfp", "mfp");
        return;
    }
    in->Copy(ParameterType::String, {"name"});
    in->CopySurface("sigma_a", "sigma_a");
    in->CopySurface("sigma_s", "sigma_s");
}

void CopyHair(V4Reader* in) {
    for (const char* name : {"eumelanin", "pheomelanin", "eta", "beta_m", "beta_n", "alpha"})
        in->CopyFloat(name);
    const char* color =
        in->given.GetTexture("color") || in->Spectrum("color") ? "color" : "reflectance";
    if (in->given.GetTexture(color) || in->Spectrum(color)) in->CopyReflectance(color, "color", 0);
    in->CopySurface("sigma_a", "sigma_a");
}

void CopyTilt(V4Reader* in) {
    const std::string map = in->given.GetString("normalmap", "");
    // Where both are given the normal map counts.
    if (!map.empty())
        in->write.Texture("normals", in->AddImage(map, true));
    else
        in->Copy(ParameterType::Texture, "displacement", "bumpmap");
    in->Ignore({"displacement"});
}

std::string CopyKind(V4Reader* in) {
    const std::string& kind = in->Name();
    if (kind == "diffuse") {
        in->CopyReflectance("reflectance", "Kd", 0.5f);
        return "matte";
    }
    if (kind == "dielectric") {
        CopyIndex(in, "eta", 1.5f);
        CopyAllRoughness(in);
        return "glass";
    }
    if (kind == "thindielectric") {
        CopyIndex(in, "eta", 1.5f);
        return "thindielectric";
    }
    if (kind == "conductor") {
        CopyConductor(in, "", "reflectance");
        CopyAllRoughness(in);
        in->write.Bool("mirrors", true);
        return "metal";
    }
    if (kind == "coateddiffuse") {
        in->CopyReflectance("reflectance", "reflectance", 0.5f);
        CopyIndex(in, "eta", 1.5f);
        CopyAllRoughness(in);
        CopyLayer(in);
        return kind;
    }
    if (kind == "coatedconductor") {
        CopyConductor(in, "conductor.", "reflectance");
        CopyIndex(in, "interface.eta", 1.5f);
        CopyRoughness(in, "interface.");
        CopyRoughness(in, "conductor.");
        in->write.String("remapping", in->given.GetBool("remaproughness", true) ? "sqrt" : "none");
        CopyLayer(in);
        return kind;
    }
    if (kind == "diffusetransmission") {
        in->write.Spectrum("Kd", Rgb::Constant(in->given.GetFloat("scale", 1)));
        in->write.Spectrum("Ks", Rgb::Zero());
        in->CopyReflectance("reflectance", "reflect", 0.25f);
        in->CopyReflectance("transmittance", "transmit", 0.25f);
        return "translucent";
    }
    if (kind == "hair") {
        CopyHair(in);
        return kind;
    }
    std::string name = "subsurface";
    CopySubsurface(in, &name);
    return name;
}

}  // namespace

Entity TranslateMaterial(V4Reader& in) {
    const std::string& kind = in.Name();
    const std::string owner = "material \"" + Printable(kind) + "\"";
    in.given.GetString("type", "");
    RefuseKindOfV3("Material", kind, in.Loc());
    if (kind.empty() || kind == "none" || kind == "interface") {
        in.Ignore({"displacement", "normalmap"});
        return in.Finish("none", owner);
    }
    if (kind == "mix") {
        CopyMix(&in);
        return in.Finish(kind, owner);
    }
    constexpr std::string_view kKnown[] = {
        "coatedconductor",     "coateddiffuse", "conductor",  "dielectric",    "diffuse",
        "diffusetransmission", "hair",          "subsurface", "thindielectric"};
    if (std::ranges::count(kKnown, kind) == 0)
        in.Fail(fmt::format("{} is not supported; {}, interface and mix are", owner,
                            fmt::join(kKnown, ", ")));
    const std::string name = CopyKind(&in);
    CopyTilt(&in);
    return in.Finish(name, owner);
}

// Lights. Spectra give their colour alone; "scale" and powers give the brightness.

namespace {

constexpr float kDegree = kPi / 180;

Rgb Color(const V4Reader& in, const char* name) {
    return in.Light(name, Rgb::Ones()) * in.given.GetFloat("scale", 1);
}

void CopySpot(V4Reader* in) {
    const float cone = in->given.GetFloat("coneangle", 30),
                delta = in->given.GetFloat("conedeltaangle", 5);
    Rgb I = Color(*in, "I");
    if (const float power = in->given.GetFloat("power", -1); power > 0) {
        const float whole = std::cos((cone - delta) * kDegree), end = std::cos(cone * kDegree);
        I *= power / (2 * kPi * ((1 - whole) + (whole - end) / 2));
    }
    in->write.Spectrum("I", I);
    in->write.Float("coneangle", cone);
    in->write.Float("conedeltaangle", delta);
    in->Copy(ParameterType::Point3, {"from", "to"});
}

void CopyImageLight(V4Reader* in) {
    const std::string file = in->given.GetString("filename", "");
    if (file.empty()) in->Fail(fmt::format("LightSource \"{}\" needs a \"filename\"", in->Name()));
    in->write.String("mapname", file);
    in->write.Bool("decode", true);
    in->write.Spectrum("I", in->Name() == "goniometric"
                                ? Color(*in, "I")
                                : Rgb::Constant(in->given.GetFloat("scale", 1)).eval());
    in->Copy(ParameterType::Float, {"power"});
    if (in->Name() == "projection") in->write.Float("fov", in->given.GetFloat("fov", 90));
    if (in->Name() == "goniometric") in->write.Bool("equalarea", true);
}

void CopyInfinite(V4Reader* in) {
    Rgb L = Color(*in, "L");
    const std::string file = in->given.GetString("filename", "");
    if (file.empty()) {
        if (const float e = in->given.GetFloat("illuminance", -1); e > 0) L *= e * kInvPi;
    } else {
        if (in->Spectrum("L")) in->Fail("an infinite light has \"L\" or \"filename\", not both");
        in->write.String("mapname", file);
        in->write.Bool("equalarea", true);
        in->write.Bool("decode", true);
        in->Copy(ParameterType::Float, {"illuminance"});
    }
    in->write.Spectrum("L", L);
    if (!in->given.Find(ParameterType::Point3, "portal")) return;
    in->Copy(ParameterType::Point3, {"portal"});
    in->write.Bool("cutsout", true);
}

}  // namespace

Entity TranslateLight(V4Reader& in) {
    const std::string& kind = in.Name();
    in.Copy(ParameterType::String, {"lightgroup"});
    if (kind == "point") {
        const float power = in.given.GetFloat("power", -1);
        in.write.Spectrum("I", Color(in, "I") * (power > 0 ? power / (4 * kPi) : 1));
        in.Copy(ParameterType::Point3, {"from"});
    } else if (kind == "distant") {
        const float illuminance = in.given.GetFloat("illuminance", -1);
        in.write.Spectrum("L", Color(in, "L") * (illuminance > 0 ? illuminance : 1));
        in.Copy(ParameterType::Point3, {"from", "to"});
    } else if (kind == "spot") {
        CopySpot(&in);
        return in.Finish("spot-smooth", "LightSource \"spot\"");
    } else if (kind == "goniometric" || kind == "projection") {
        CopyImageLight(&in);
    } else if (kind == "infinite") {
        CopyInfinite(&in);
    } else {
        in.Fail(
            fmt::format("LightSource \"{}\" is not supported; point, distant, spot, "
                        "goniometric, projection and infinite are",
                        Printable(kind)));
    }
    return in.Finish(kind, "LightSource \"" + kind + "\"");
}

Entity TranslateAreaLight(V4Reader& in) {
    if (in.Name() != "diffuse")
        in.Fail(fmt::format("AreaLightSource \"{}\" is not supported; only \"diffuse\" is",
                            Printable(in.Name())));
    in.Copy(ParameterType::String, {"lightgroup"});
    in.write.Bool("twosided", in.given.GetBool("twosided", false));
    if (const std::string file = in.given.GetString("filename", ""); !file.empty()) {
        if (in.Spectrum("L")) in.Fail("an area light has \"L\" or \"filename\", not both");
        in.write.Texture("emission", in.AddImage(file, false));
    }
    in.write.Spectrum("L", Color(in, "L"));
    in.Copy(ParameterType::Float, {"power"});
    if (in.given.Find(ParameterType::Float, "spread")) {
        in.Warn(
            "\"spread\" is no parameter of pbrt-v4; it is taken as the angle of the cone, in "
            "degrees, that each point shines into");
        in.Copy(ParameterType::Float, {"spread"});
    }
    return in.Finish("diffuse", "AreaLightSource \"diffuse\"");
}

}  // namespace lull
