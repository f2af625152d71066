// Lights of pbrt-v4. Spectra give their colour alone; "scale" and powers give the brightness.

#include <fmt/format.h>

#include <cmath>

#include "renderer/input/pbrt/v4_reader.h"
#include "stopping/base/input_file.h"

namespace lull {
namespace {

constexpr float kDegree = kPi / 180;

// Returns the light's colour times its "scale".
Rgb Color(const V4Reader& in, const char* name) {
    return in.Light(name, Rgb::Ones()) * in.Float("scale", 1);
}

void CopyPoints(V4Reader* in, std::initializer_list<const char*> names) {
    for (const char* name : names) in->Copy(ParameterType::Point3, name);
}

void CopySpot(V4Reader* in) {
    const float cone = in->Float("coneangle", 30), delta = in->Float("conedeltaangle", 5);
    Rgb I = Color(*in, "I");
    if (const float power = in->Float("power", -1); power > 0) {
        const float whole = std::cos((cone - delta) * kDegree), end = std::cos(cone * kDegree);
        I *= power / (2 * kPi * ((1 - whole) + (whole - end) / 2));
    }
    in->Set("I", I);
    in->Set("coneangle", cone);
    in->Set("conedeltaangle", delta);
    CopyPoints(in, {"from", "to"});
}

// Reads a light whose beam an image shapes; the image is named in the file's terms.
void CopyImageLight(V4Reader* in) {
    const std::string file = in->String("filename");
    if (file.empty()) in->Fail(fmt::format("LightSource \"{}\" needs a \"filename\"", in->Name()));
    in->SetString("mapname", file);
    in->SetBool("decode", true);
    in->Set("I", in->Name() == "goniometric" ? Color(*in, "I")
                                             : Rgb::Constant(in->Float("scale", 1)).eval());
    in->Copy(ParameterType::Float, "power");
    if (in->Name() == "projection") in->Set("fov", in->Float("fov", 90));
    if (in->Name() == "goniometric") in->SetBool("equalarea", true);
}

void CopyInfinite(V4Reader* in) {
    Rgb L = Color(*in, "L");
    const std::string file = in->String("filename");
    if (file.empty()) {
        if (const float e = in->Float("illuminance", -1); e > 0) L *= e * kInvPi;
    } else {
        if (in->Spectrum("L")) in->Fail("an infinite light has \"L\" or \"filename\", not both");
        in->SetString("mapname", file);
        in->SetBool("equalarea", true);
        in->SetBool("decode", true);
        in->Copy(ParameterType::Float, "illuminance");
    }
    in->Set("L", L);
    in->Copy(ParameterType::Point3, "portal");
    in->SetBool("cutsout", true);
}

}  // namespace

Entity TranslateLight(V4Reader in) {
    const std::string& kind = in.Name();
    in.Copy(ParameterType::String, "lightgroup");
    if (kind == "point") {
        const float power = in.Float("power", -1);
        in.Set("I", Rgb(Color(in, "I") * (power > 0 ? power / (4 * kPi) : 1)));
        CopyPoints(&in, {"from"});
    } else if (kind == "distant") {
        const float illuminance = in.Float("illuminance", -1);
        in.Set("L", Rgb(Color(in, "L") * (illuminance > 0 ? illuminance : 1)));
        CopyPoints(&in, {"from", "to"});
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

Entity TranslateAreaLight(V4Reader in) {
    if (in.Name() != "diffuse")
        in.Fail(fmt::format("AreaLightSource \"{}\" is not supported; only \"diffuse\" is",
                            Printable(in.Name())));
    in.Copy(ParameterType::String, "lightgroup");
    in.SetBool("twosided", in.Bool("twosided", false));
    if (const std::string file = in.String("filename"); !file.empty()) {
        if (in.Spectrum("L")) in.Fail("an area light has \"L\" or \"filename\", not both");
        in.SetTexture("emission", in.AddImage(file, false));
    }
    in.Set("L", Color(in, "L"));
    in.Copy(ParameterType::Float, "power");
    if (in.Has(ParameterType::Float, "spread")) {
        in.Warn(
            "\"spread\" is no parameter of pbrt-v4; it is taken as the angle of the cone, in "
            "degrees, that each point shines into");
        in.Copy(ParameterType::Float, "spread");
    }
    return in.Finish("diffuse", "AreaLightSource \"diffuse\"");
}

}  // namespace lull
