// Materials of pbrt-v4.

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "renderer/input/pbrt/v4_reader.h"
#include "stopping/base/input_file.h"

namespace lull {
namespace {

// What pbrt-v4 has for materials of pbrt-v3.
struct Gone {
    std::string_view old;
    const char* instead;
};
constexpr Gone kGone[] = {
    {"matte", "\"diffuse\" with \"reflectance\""},
    {"plastic", "\"coateddiffuse\""},
    {"substrate", "\"coateddiffuse\""},
    {"uber", "\"coateddiffuse\" or \"mix\""},
    {"disney", "\"coateddiffuse\" or \"mix\""},
    {"translucent", "\"diffusetransmission\""},
    {"metal", "\"conductor\""},
    {"mirror", "\"conductor\" with \"reflectance\""},
    {"glass", "\"dielectric\""},
    {"fourier", "\"measured\""},
    {"kdsubsurface", "\"subsurface\" with \"reflectance\" and \"mfp\""},
};

// Reads roughness; of names that begin with `prefix` where that is given.
void CopyRoughness(V4Reader* in, const std::string& prefix = "") {
    const std::string both = prefix + "roughness";
    for (const char* axis : {"u", "v"}) {
        const std::string to = prefix + axis + "roughness";
        if (in->Has(ParameterType::Float, to.c_str()) || in->Texture(to.c_str()))
            in->CopyFloat(to.c_str());
        else if (in->Has(ParameterType::Float, both.c_str()) || in->Texture(both.c_str()))
            in->CopyFloat(both.c_str(), to.c_str());
        else
            in->Set(to.c_str(), 0.f);
    }
}

void CopyAllRoughness(V4Reader* in) {
    CopyRoughness(in);
    in->SetString("remapping", in->Bool("remaproughness", true) ? "sqrt" : "none");
}

void CopyIndex(V4Reader* in, const char* name, float otherwise) {
    if (in->Texture(name)) in->Fail(fmt::format("\"{}\" by a texture is not supported", name));
    float index = in->Float(name, otherwise);
    if (const auto spectrum = in->Spectrum(name)) {
        index = IndexOf(*spectrum, in->Loc());
        if (!std::holds_alternative<Rgb>(*spectrum))
            in->Context().warnings.Add(in->Loc(), "dispersion is not rendered",
                                       "an index of refraction is that of yellow light");
    }
    in->Set(name, index);
}

// Reads eta and k of a conductor, or its reflectance, of names that begin with `prefix`.
void CopyConductor(V4Reader* in, const std::string& prefix, const char* reflectance) {
    if (const TextureRef* texture = in->Texture(reflectance)) {
        in->SetTexture("reflectance", *texture);
    } else if (in->Spectrum(reflectance)) {
        in->Set("reflectance", in->Reflectance(reflectance, Rgb::Zero()));
    } else {
        const std::string eta = prefix + "eta", k = prefix + "k";
        const auto [n, absorption] = RgbOfConductor(
            in->Spectrum(eta.c_str()).value_or(NamedSpectrum{"metal-Cu-eta"}),
            in->Spectrum(k.c_str()).value_or(NamedSpectrum{"metal-Cu-k"}), in->Loc());
        if (const TextureRef* texture = in->Texture(eta.c_str()))
            in->SetTexture("eta", *texture);
        else
            in->Set("eta", n);
        if (const TextureRef* texture = in->Texture(k.c_str()))
            in->SetTexture("k", *texture);
        else
            in->Set("k", absorption);
    }
}

// Reads the layer between a coat and its base.
void CopyLayer(V4Reader* in) {
    in->Set("thickness", in->Float("thickness", 0.01f));
    in->Ignore({"g", "maxdepth", "nsamples"});
    if (in->Texture("albedo") || (in->Surface("albedo", Rgb::Zero()) > 0).any())
        in->Fail("a coat whose layer scatters (\"albedo\" above 0) is not supported");
}

void CopyMix(V4Reader* in) {
    const Parameter* names = in->All().Find(ParameterType::String, "materials");
    const auto* two = names ? std::get_if<std::vector<std::string>>(&names->values) : nullptr;
    if (!two || two->size() != 2) in->Fail("Material \"mix\" needs two names as \"materials\"");
    // The amount is the share of the second.
    in->SetString("namedmaterial1", (*two)[1]);
    in->SetString("namedmaterial2", (*two)[0]);
    if (in->Has(ParameterType::Float, "amount") || in->Texture("amount"))
        in->CopyFloat("amount", "share");
    else
        in->Set("share", 0.5f);
}

void CopySubsurface(V4Reader* in, std::string* name) {
    CopyAllRoughness(in);
    CopyIndex(in, "eta", 1.33f);
    in->Copy(ParameterType::Float, "g");
    in->Copy(ParameterType::Float, "scale");
    const auto coefficient = [&](const char* parameter, const char* to) {
        if (const TextureRef* texture = in->Texture(parameter))
            in->SetTexture(to, *texture);
        else if (in->Spectrum(parameter))
            in->Set(to, in->Surface(parameter, Rgb::Ones()));
    };
    if (in->Spectrum("reflectance") || in->Texture("reflectance")) {
        *name = "kdsubsurface";
        in->CopyReflectance("reflectance", "Kd", 0.5f);
        coefficient("mfp", "mfp");
        return;
    }
    in->Copy(ParameterType::String, "name");
    coefficient("sigma_a", "sigma_a");
    coefficient("sigma_s", "sigma_s");
}

void CopyHair(V4Reader* in) {
    for (const char* name : {"eumelanin", "pheomelanin", "eta", "beta_m", "beta_n", "alpha"})
        in->CopyFloat(name);
    const char* color = in->Texture("color") || in->Spectrum("color") ? "color" : "reflectance";
    if (in->Texture(color) || in->Spectrum(color)) in->CopyReflectance(color, "color", 0);
    if (const TextureRef* texture = in->Texture("sigma_a"))
        in->SetTexture("sigma_a", *texture);
    else if (in->Spectrum("sigma_a"))
        in->Set("sigma_a", in->Surface("sigma_a", Rgb::Zero()));
}

// Reads the maps of the shading normal, which all but mixtures and interfaces have.
void CopyTilt(V4Reader* in) {
    const std::string map = in->String("normalmap");
    // Where both are given the normal map counts.
    if (!map.empty())
        in->SetTexture("normals", in->AddImage(map, true));
    else
        in->Copy(ParameterType::Texture, "displacement", "bumpmap");
    in->Ignore({"displacement"});
}

// Reads the parameters of a kind but its tilt. Returns its name in the Description.
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
        in->SetBool("mirrors", true);
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
        in->SetString("remapping", in->Bool("remaproughness", true) ? "sqrt" : "none");
        CopyLayer(in);
        return kind;
    }
    if (kind == "diffusetransmission") {
        in->Set("Kd", Rgb::Constant(in->Float("scale", 1)).eval());
        in->Set("Ks", Rgb(Rgb::Zero()));
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

Entity TranslateMaterial(V4Reader in) {
    const std::string& kind = in.Name();
    const std::string owner = "material \"" + Printable(kind) + "\"";
    in.String("type");
    if (const Gone* gone = std::ranges::find(kGone, std::string_view(kind), &Gone::old);
        gone != std::end(kGone))
        in.Fail(
            fmt::format("{} is pbrt-v3's, in a scene for pbrt-v4; write {}", owner, gone->instead));
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

}  // namespace lull
