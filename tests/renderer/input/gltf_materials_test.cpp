// Checks materials of glTF files, and their variants.
#include <numbers>

#include "tests/renderer/input/gltf_files.h"

namespace lull::gltf_materials_test {
namespace {

TEST(GltfMaterials, HaveFactorsUpToRounding) {
    const auto material = [&](const json& extensions) {
        GltfFile file;
        file.Surface({{"extensions", extensions}});
        return kFolder.ErrorOf(file);
    };
    const double above = 1.0000001192;  // the float after 1
    EXPECT_EQ(material({{"KHR_materials_sheen", {{"sheenColorFactor", {above, 1, 0}}}}}), "");
    EXPECT_EQ(material({{"KHR_materials_anisotropy", {{"anisotropyStrength", above}}}}), "");
    EXPECT_EQ(material({{"KHR_materials_volume", {{"attenuationColor", {above, -1e-9, 0}}}}}), "");
    EXPECT_NE(material({{"KHR_materials_sheen", {{"sheenColorFactor", {1.01, 1, 0}}}}}), "");
}

TEST(GltfMaterials, MayAddTheInterfaceToTheBase) {
    GltfFile file;
    file.Surface(json::object());
    const auto adds = [&](const nlohmann::json& value) {
        file.root["materials"] = {{{"extras", {{"lull", {{"addedInterface", value}}}}}}};
        return kFolder.Parse(file).materials.at(0).parameters.GetBool("addedinterface", false);
    };
    EXPECT_TRUE(adds(true));
    EXPECT_FALSE(adds(false));
    file.root["materials"][0]["extras"]["lull"]["addedInterface"] = 1;
    EXPECT_EQ(kFolder.ErrorOf(file),
              "scene.gltf: /materials/0/extras/lull/addedInterface: has to be true or false");
}

TEST(GltfMaterials, MayEmitIntoACone) {
    GltfFile file;
    file.Surface({{"emissiveFactor", {1, 1, 1}}});
    json& own = file.root["materials"][0]["extras"]["lull"];
    const auto spread = [&](const json& value) {
        own = {{"spread", value}};
        return kFolder.Parse(file).shapes.at(0).areaLight->parameters.GetFloat("spread", -1);
    };
    EXPECT_NEAR(spread(0.5), 90 / std::numbers::pi, 1e-4);
    EXPECT_EQ(spread(3.1415927), -1);  // to all sides
    for (const json& bad : {json(0), json(-1), json(4), json("wide")}) {
        own = {{"spread", bad}};
        EXPECT_EQ(kFolder.ErrorOf(file),
                  "scene.gltf: /materials/0/extras/lull/spread: has to be a number above 0 and at "
                  "most pi");
    }
}

TEST(GltfMaterials, CarryFactorsTexturesAndExtensions) {
    GltfFile file;
    file.root["images"] = {{{"uri", "a%20b.png"}}};
    file.root["samplers"] = {{{"wrapS", 33648}, {"wrapT", 33071}, {"magFilter", 9728}}};
    file.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
    file.root["materials"] = {
        {{"pbrMetallicRoughness",
          {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
           {"baseColorTexture",
            {{"index", 0},
             {"texCoord", 1},
             {"extensions", {{"KHR_texture_transform", {{"offset", {0.25, 0.5}}}}}}}},
           {"metallicFactor", 0}}},
         {"alphaMode", "MASK"},
         {"alphaCutoff", 0.25},
         {"extensions",
          {{"KHR_materials_ior", {{"ior", 1.3}}},
           {"KHR_materials_transmission", {{"transmissionFactor", 0.75}}}}}}};
    file.root["extensionsUsed"] = {"KHR_materials_ior", "KHR_materials_iridescence"};
    file.Node({{"mesh", file.Triangle({{"material", 0}})}});
    Warnings warnings;
    const Description d = kFolder.Parse(file, {}, &warnings);
    // Of iridescence, of a sheet that transmits, of texture coordinates that the mesh lacks, and of
    // how both textures are filtered.
    EXPECT_EQ(warnings.Total(), 5);
    ASSERT_EQ(d.materials.size(), 1u);
    const Parameters& m = d.materials[0].parameters;
    EXPECT_EQ(d.materials[0].name, "metallicroughness");
    EXPECT_TRUE(m.GetSpectrum("basecolorfactor", Rgb::Zero()).isApprox(Rgb(0.1f, 0.2f, 0.3f)));
    EXPECT_EQ(m.GetInt("basecoloruv", 0), 1);
    EXPECT_EQ(m.GetFloat("metallicfactor", 1), 0);
    EXPECT_NEAR(m.GetFloat("ior", 0), 1.3, 1e-6);
    EXPECT_NEAR(m.GetFloat("transmissionfactor", 0), 0.75, 1e-6);
    ASSERT_EQ(d.textures.size(), 2u);  // its colours and its alpha
    const TextureEntity& texture = d.textures[0];
    EXPECT_EQ(texture.parameters.GetString("filename", ""), "a b.png");
    EXPECT_EQ(texture.parameters.GetString("wrap", ""), "mirrored");
    EXPECT_EQ(texture.parameters.GetString("wrapt", ""), "clamp");
    // v turned round twice: a shift downwards by a half.
    ExpectNear(FloatsOf(texture, ParameterType::Float, "uvtransform"), {1, 0, 0.25f, 0, 1, -0.5f},
               0);
    EXPECT_NEAR(d.shapes[0].parameters.GetFloat("coveragefactor", 0), 0.4, 1e-6);
    EXPECT_NEAR(d.shapes[0].parameters.GetFloat("alphacutoff", 0), 0.25, 1e-6);
    EXPECT_EQ(d.textures[1].parameters.GetString("channel", ""), "alpha");
}

TEST(GltfMaterials, AreSolidByVolumeOrByWish) {
    for (const double thickness : {0., 0.5})
        for (const bool wish : {false, true}) {
            GltfFile file;
            file.Surface({{"extensions",
                           {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                            {"KHR_materials_volume", {{"thicknessFactor", thickness}}}}}});
            Warnings warnings;
            const Description d = kFolder.Parse(file, {.solidGlass = wish}, &warnings);
            const bool isSolid = thickness > 0 || wish;
            EXPECT_EQ(d.materials.at(0).parameters.GetBool("solid", false), isSolid);
            EXPECT_EQ(warnings.Total(), isSolid ? 0 : 1);
        }
}

// A tenth of the light is left after half a unit; blue passes, green does not.
TEST(GltfMaterials, AbsorbInTheirVolume) {
    GltfFile file;
    file.Surface({{"extensions",
                   {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                    {"KHR_materials_volume",
                     {{"thicknessFactor", 1},
                      {"attenuationDistance", 0.5},
                      {"attenuationColor", {0.1, 0, 1}}}}}}});
    file.root["extensionsRequired"] = {"KHR_materials_volume"};
    const Description d = kFolder.ParseSilently(file);
    ASSERT_EQ(d.media.size(), 1u);
    const Rgb absorption = d.media[0].parameters.GetSpectrum("sigma_a", Rgb::Zero());
    EXPECT_NEAR(absorption.x(), 2 * std::log(10), 1e-5);
    EXPECT_GT(absorption.y(), 1e20f);
    EXPECT_EQ(absorption.z(), 0);
    EXPECT_TRUE(IsBlack(d.media[0].parameters.GetSpectrum("sigma_s", Rgb::Ones())));
    EXPECT_EQ(d.shapes.at(0).insideMedium, 0);
    EXPECT_EQ(d.shapes.at(0).outsideMedium, ShapeEntity::kSurrounding);
    EXPECT_TRUE(IntegratorSeesMedia(d.integrator.name));

    // A sheet has no inside; opaque and clear surfaces need none.
    const auto& material = json::json_pointer("/materials/0/extensions");
    for (const json& change :
         {json{{"KHR_materials_volume", {{"thicknessFactor", 0}}}},
          json{{"KHR_materials_transmission", {{"transmissionFactor", 0}}}},
          json{{"KHR_materials_volume", {{"attenuationColor", {1, 1, 1}}}}},
          json{{"KHR_materials_volume", {{"attenuationDistance", nullptr}}}}}) {
        GltfFile other = file;
        other.root[material].merge_patch(change);
        const Description none = kFolder.Parse(other);
        EXPECT_TRUE(none.media.empty()) << change;
        EXPECT_EQ(none.shapes.at(0).insideMedium, -1);
        EXPECT_EQ(none.integrator.name, "path");
    }
}

TEST(GltfMaterials, CarrySheenAndAnisotropy) {
    GltfFile file;
    file.root["images"] = {{{"uri", "a.png"}}};
    file.root["textures"] = {{{"source", 0}}};
    file.root["materials"] = {{{"extensions",
                                {{"KHR_materials_sheen",
                                  {{"sheenColorFactor", {0.5, 0.25, 1}},
                                   {"sheenRoughnessFactor", 0.75},
                                   {"sheenRoughnessTexture", {{"index", 0}}}}},
                                 {"KHR_materials_anisotropy",
                                  {{"anisotropyStrength", 0.5},
                                   {"anisotropyRotation", 1.5},
                                   {"anisotropyTexture", {{"index", 0}, {"texCoord", 1}}}}}}}}};
    file.root["extensionsRequired"] = {"KHR_materials_sheen", "KHR_materials_anisotropy"};
    const int p = file.Floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int n = file.Floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int uv = file.Floats({0, 0, 0, 1, 1, 0}, "VEC2");
    file.Node({{"mesh", file.Mesh({{"POSITION", p}, {"NORMAL", n}, {"TEXCOORD_1", uv}},
                                  {{"material", 0}})}});
    const Description d = kFolder.Parse(file);
    const Parameters& m = d.materials.at(0).parameters;
    EXPECT_TRUE(m.GetSpectrum("sheencolorfactor", Rgb::Zero()).isApprox(Rgb(0.5f, 0.25f, 1)));
    EXPECT_EQ(m.GetFloat("sheenroughnessfactor", 0), 0.75f);
    EXPECT_EQ(m.GetFloat("anisotropyfactor", 0), 0.5f);
    EXPECT_EQ(m.GetFloat("anisotropyrotation", 0), 1.5f);
    EXPECT_EQ(m.GetInt("anisotropyuv", 0), 1);
    ASSERT_TRUE(m.GetTexture("sheenroughness"));
    const int roughness = m.GetTexture("sheenroughness")->floatIndex;
    EXPECT_EQ(d.textures.at(size_t(roughness)).parameters.GetString("channel", ""), "alpha");
    // The first texture coordinate grows along y; no tangents came with the mesh.
    const auto tangents = FloatsOf(d.shapes.at(0), ParameterType::Float, "tangent");
    ASSERT_EQ(tangents.size(), 12u);
    EXPECT_NEAR(tangents[1], 1, 1e-6);
}

// What is left out, or misplaced, is named: extensions that no list has, and uvs that meshes lack.
TEST(GltfMaterials, WarnOfWhatIsMissing) {
    GltfFile file;
    file.root["images"] = {{{"uri", "a.webp"}}, {{"uri", "missing.png"}}};
    file.root["textures"] = {
        {{"source", 1}, {"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}}};
    file.root["extensionsUsed"] = {"EXT_texture_webp"};
    file.root["materials"] = {
        {{"extensions", {{"KHR_materials_iridescence", json::object()}}},
         {"pbrMetallicRoughness",
          {{"baseColorTexture",
            {{"index", 0}, {"texCoord", 1}, {"extensions", {{"EXT_a", json::object()}}}}}}}}};
    file.root["extensions"] = {{"EXT_b", json::object()}};
    const int p = file.Floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    file.Node({{"mesh", file.Mesh({{"POSITION", p}}, {{"material", 0}})},
               {"extensions", {{"EXT_c", json::object()}}},
               {"extras", {{"extensions", {{"EXT_d", json::object()}}}}}});
    Warnings warnings;
    const Description d = kFolder.Parse(file, {}, &warnings);
    EXPECT_EQ(d.textures.at(0).parameters.GetString("filename", ""), "a.webp");
    EXPECT_EQ(warnings.Total(), 5);
    for (const std::string name : {"KHR_materials_iridescence", "EXT_a", "EXT_b", "EXT_c"})
        EXPECT_EQ(
            warnings.Counts().count("extension \"" + name + "\" is not supported and left out"),
            1u);
    EXPECT_EQ(warnings.Counts().count("a texture is misplaced, since its mesh lacks TEXCOORD_1"),
              1u);
}

TEST(GltfMaterials, WarnOfNumbersBeyondTheirRange) {
    GltfFile file;
    file.Surface(
        {{"emissiveFactor", {2, 0, -0.5}},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {1.5, 1, 0, 1}}, {"metallicFactor", -1}, {"roughnessFactor", 1}}},
         {"extensions",
          {{"KHR_materials_specular",
            {{"specularFactor", 1.00001}, {"specularColorFactor", {3, 1, 1}}}},
           {"KHR_materials_emissive_strength", {{"emissiveStrength", -1e-6}}}}}});
    Warnings warnings;
    kFolder.Parse(file, {}, &warnings);
    EXPECT_EQ(warnings.Total(), 3);
    EXPECT_EQ(warnings.Counts().at("negative number, which counts as 0"), 1);
    EXPECT_EQ(warnings.Counts().at("number beyond 0 to 1, to which it is clamped"), 2);
}

TEST(GltfMaterials, WarnOfUnknownPropertiesOfOurOwn) {
    GltfFile file;
    file.root["materials"] = {
        {{"extras", {{"lull", {{"openBehind", true}, {"openbehind", true}}}}}}};
    file.root["cameras"] = {{{"type", "perspective"},
                             {"perspective", {{"yfov", 1}, {"znear", 0.1}}},
                             {"extras", {{"lull", {{"lensradius", 1}}}, {"other", 1}}}}};
    file.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"extras", {{"lull", {{"width", 1}}}}}}};
    file.Node({{"mesh", file.Triangle({{"material", 0}})},
               {"extras", {{"lull", {{"castsNoShadow", true}, {"hidden", true}}}}}});
    Warnings warnings;
    kFolder.Parse(file, {}, &warnings);
    EXPECT_EQ(warnings.Total(), 4);
    EXPECT_EQ(warnings.Counts().at("unknown property of lull's own"), 4);
}

TEST(GltfMaterials, CarryDiffuseTransmission) {
    GltfFile file;
    file.Surface({{"extensions",
                   {{"KHR_materials_diffuse_transmission",
                     {{"diffuseTransmissionFactor", 0.5},
                      {"diffuseTransmissionColorFactor", {0.5, 0.25, 1}}}}}}});
    file.root["extensionsRequired"] = {"KHR_materials_diffuse_transmission"};
    const Parameters m = kFolder.Parse(file).materials.at(0).parameters;
    EXPECT_EQ(m.GetFloat("diffusetransmissionfactor", 0), 0.5f);
    EXPECT_TRUE(
        m.GetSpectrum("diffusetransmissioncolorfactor", Rgb::Zero()).isApprox(Rgb(0.5f, 0.25f, 1)));
}

GltfFile WithVariants() {
    GltfFile file;
    file.root["materials"] = {{{"name", "white"}}, {{"name", "red"}}, {{"name", "blue"}}};
    file.root["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "berry"}},
                                                                     {{"name", "sky"}}};
    file.root["extensionsRequired"] = {"KHR_materials_variants"};
    const json mappings = {{{"material", 1}, {"variants", {0}}},
                           {{"material", 2}, {"variants", {1}}}};
    file.Node(
        {{"mesh", file.Triangle(
                      {{"material", 0},
                       {"extensions", {{"KHR_materials_variants", {{"mappings", mappings}}}}}})}});
    file.Node({{"mesh", file.Triangle({{"material", 0}})}});
    return file;
}

TEST(GltfVariants, ChooseMaterialsByNameOrNumber) {
    const auto namesOf = [](const std::string& variant) {
        const Description d = kFolder.Parse(WithVariants(), {.variant = variant});
        EXPECT_EQ(d.variants, (std::vector<std::string>{"berry", "sky"}));
        std::vector<std::string> names;
        for (const ShapeEntity& shape : d.shapes)
            names.push_back(d.materials.at(size_t(shape.material)).materialName);
        return names;
    };
    EXPECT_EQ(namesOf(""), (std::vector<std::string>{"white", "white"}));
    for (const char* sky : {"sky", "1"})
        EXPECT_EQ(namesOf(sky), (std::vector<std::string>{"blue", "white"}));
    EXPECT_HAS(ErrorOf([&] { namesOf("fish"); }),
               "has no variant \"fish\"; it has 0 \"berry\", 1 \"sky\"");
    EXPECT_HAS(ErrorOf([&] { kFolder.Parse(OneTriangle(), {.variant = "0"}); }),
               "has no variant \"0\"; it has none");
}

TEST(GltfMaterials, KeepEmbeddedImagesEncoded) {
    GltfFile file;
    const std::string png = "\x89PNG and so on";
    const int view = file.View(png);
    file.root["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}},
                           {{"uri", "data:image/jpeg;base64," + Base64("\xff\xd8jpeg")}}};
    file.root["textures"] = {{{"source", 0}}, {{"source", 1}}};
    file.Surface({{"emissiveFactor", {1, 1, 1}},
                  {"emissiveTexture", {{"index", 1}}},
                  {"normalTexture", {{"index", 0}}}});
    const Description d = kFolder.Parse(file);
    ASSERT_EQ(d.images.size(), 2u);
    EXPECT_EQ(d.images[0].type, "png");
    EXPECT_EQ(d.images[0].bytes.size(), png.size());
    EXPECT_EQ(d.images[1].type, "jpg");
    EXPECT_NE(d.images[0].name, d.images[1].name);
}

}  // namespace
}  // namespace lull::gltf_materials_test
