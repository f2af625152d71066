// Tests every directive of the pbrt-v3 parser for what it does to the description.
#include <Eigen/LU>

#include "renderer/input/pbrt_parser.h"
#include "tests/renderer/input/test_files.h"

namespace lull {
namespace {

constexpr double kTolerance = 1e-12;

class Directives : public testing::Test {
  protected:
    // Returns the transform of the first shape in the world.
    Mat4d ShapeTransform(const std::string& directives) {
        const auto d = folder.ParseWorld(directives + " Shape \"sphere\"");
        return d.shapes.at(0).worldFromObject;
    }

    TestFolder folder;
    Warnings warnings;
};

Mat4d Translation(double x, double y, double z) {
    Mat4d m = Mat4d::Identity();
    m.topRightCorner<3, 1>() = Eigen::Vector3d(x, y, z);
    return m;
}

TEST_F(Directives, EmptyWorldHasDefaults) {
    const auto d = folder.Parse("WorldBegin WorldEnd");
    EXPECT_EQ(d.camera.name, "perspective");
    EXPECT_EQ(d.film.name, "image");
    EXPECT_EQ(d.filter.name, "box");
    EXPECT_EQ(d.sampler.name, "halton");
    EXPECT_EQ(d.integrator.name, "path");
    EXPECT_EQ(d.cameraFromWorld, Mat4d::Identity());
    EXPECT_TRUE(d.shapes.empty() && d.lights.empty() && d.materials.empty());
    EXPECT_EQ(d.directory + "/", folder.File(""));
}

TEST_F(Directives, OptionsKeepNameParametersAndPlace) {
    const auto d = folder.Parse(
        "Camera \"orthographic\" \"float fov\" 39\nFilm \"image\" \"integer xresolution\" [40]\n"
        "Sampler \"random\"\nPixelFilter \"gaussian\"\nIntegrator \"path\" \"integer maxdepth\" 3\n"
        "Accelerator \"kdtree\" \"float emptybonus\" .3\nTransformTimes 0 1\nWorldBegin\nWorldEnd",
        &warnings);
    EXPECT_EQ(d.camera.name, "orthographic");
    EXPECT_EQ(d.camera.parameters.GetFloat("fov", 0), 39);
    EXPECT_EQ(d.film.parameters.GetInt("xresolution", 0), 40);
    EXPECT_EQ(d.film.loc.line, 2);
    EXPECT_EQ(d.film.loc.Prefix(), folder.File("scene.pbrt") + ":2: ");
    EXPECT_EQ(d.sampler.name, "random");
    EXPECT_EQ(d.filter.name, "gaussian");
    EXPECT_EQ(d.integrator.parameters.GetInt("maxdepth", 0), 3);
    EXPECT_EQ(warnings.Total(), 0);
}

TEST_F(Directives, LaterOptionCountsWithAWarning) {
    const auto d = folder.Parse(
        "Film \"image\" Film \"image\" \"float scale\" 2 WorldBegin WorldEnd", &warnings);
    EXPECT_EQ(d.film.parameters.GetFloat("scale", 0), 2);
    EXPECT_EQ(warnings.Counts().at("Film given again; the later one counts"), 1);
}

TEST_F(Directives, ChangeTheTransform) {
    const std::string matrix = "[2 0 0 0  0 3 0 0  0 0 4 0  5 6 7 1]";
    Mat4d given = Translation(5, 6, 7);
    given.diagonal() = Eigen::Vector4d(2, 3, 4, 1);
    const std::pair<std::string, Mat4d> cases[] = {
        {"Translate 1 2 3", Translation(1, 2, 3)},
        {"Scale 2 3 -4", Mat4d(Eigen::Vector4d(2, 3, -4, 1).asDiagonal())},
        {"Rotate 0 0 0 0", Mat4d::Identity()},
        {"Translate 1 2 3 Identity", Mat4d::Identity()},
        {"Translate 1 1 1 Transform " + matrix, given},
        {"Translate 1 1 1 ConcatTransform " + matrix, Translation(1, 1, 1) * given},
        {"AttributeBegin Translate 1 2 3 CoordinateSystem \"there\" AttributeEnd "
         "CoordSysTransform \"there\"",
         Translation(1, 2, 3)},
        // Where both ends agree.
        {"ActiveTransform All Translate 1 2 3", Translation(1, 2, 3)},
        {"ActiveTransform StartTime Translate 1 2 3 ActiveTransform EndTime Translate 1 2 3 "
         "ActiveTransform All",
         Translation(1, 2, 3)}};
    for (const auto& [directives, expected] : cases)
        EXPECT_EQ(ShapeTransform(directives), expected) << directives;
}

TEST_F(Directives, TransformPoints) {
    const auto map = [&](const std::string& directives, double x, double y, double z) {
        return (ShapeTransform(directives) * Eigen::Vector4d(x, y, z, 1)).eval();
    };
    EXPECT_TRUE(map("Rotate 90 0 0 2", 1, 0, 0).isApprox(Eigen::Vector4d(0, 1, 0, 1), kTolerance));
    // The later one applies first; matrices are given by columns.
    EXPECT_EQ(map("Translate 1 0 0 Scale 2 2 2", 1, 1, 1), Eigen::Vector4d(3, 2, 2, 1));
    EXPECT_EQ(map("Transform [0 1 0 0 -1 0 0 0 0 0 1 0 0 0 0 1]", 1, 0, 0),
              Eigen::Vector4d(0, 1, 0, 1));
}

TEST_F(Directives, LookAtMapsTheViewToZ) {
    const auto d = folder.Parse(
        "LookAt 1 2 3  1 2 8  0 1 0 Camera \"perspective\" WorldBegin Shape \"sphere\" WorldEnd");
    const auto p = [&](double x, double y, double z) {
        return (d.cameraFromWorld * Eigen::Vector4d(x, y, z, 1)).eval();
    };
    EXPECT_TRUE(p(1, 2, 3).isApprox(Eigen::Vector4d(0, 0, 0, 1), kTolerance));
    EXPECT_TRUE(p(1, 2, 8).isApprox(Eigen::Vector4d(0, 0, 5, 1), kTolerance));
    EXPECT_TRUE(p(2, 4, 3).isApprox(Eigen::Vector4d(1, 2, 0, 1), kTolerance));
    // The world starts at identity again.
    EXPECT_EQ(d.shapes[0].worldFromObject, Mat4d::Identity());
}

TEST_F(Directives, CameraSpaceIsNamed) {
    const auto d = folder.Parse(
        "Translate 0 0 5 Camera \"perspective\" WorldBegin Translate 1 1 1\n"
        "AttributeBegin CoordSysTransform \"camera\" LightSource \"point\" AttributeEnd\n"
        "CoordSysTransform \"world\" LightSource \"point\" WorldEnd");
    EXPECT_EQ(d.cameraFromWorld, Translation(0, 0, 5));
    EXPECT_EQ(d.lights[0].worldFromLight, Translation(0, 0, -5));
    EXPECT_EQ(d.lights[1].worldFromLight, Mat4d::Identity());
}

TEST_F(Directives, ShapesThatMoveAreInstancesOfObjectsOfTheirOwn) {
    const auto d = folder.Parse(
        "TransformTimes .5 2 WorldBegin AreaLightSource \"diffuse\" Translate 0 0 1\n"
        "ActiveTransform EndTime Translate 1 0 0 Shape \"sphere\" WorldEnd",
        &warnings);
    EXPECT_TRUE(d.shapes.empty());
    ASSERT_EQ(d.objects.size(), 1u);
    EXPECT_EQ(d.objects[0].shapes.at(0).worldFromObject, Mat4d::Identity());
    EXPECT_FALSE(d.objects[0].shapes[0].areaLight);
    ASSERT_EQ(d.instances.size(), 1u);
    EXPECT_EQ(d.instances[0].worldFromInstance, Translation(0, 0, 1));
    const Motion& motion = d.motions.at(d.instances[0].motion);
    ASSERT_EQ(motion.size(), 1u);
    EXPECT_EQ(motion[0].at[0], Translation(0, 0, 1));
    EXPECT_EQ(motion[0].at[1], Translation(1, 0, 1));
    EXPECT_EQ(d.transformTimes, (std::array<double, 2>{0.5, 2}));
    EXPECT_EQ(warnings.Counts().at("area light ignored at a moving shape"), 1);
}

TEST_F(Directives, ShapesMoveWithinObjectsThatMove) {
    const auto d = folder.ParseWorld(
        "ObjectBegin \"o\" Shape \"disk\" ActiveTransform EndTime Translate 0 1 0\n"
        "Shape \"sphere\" ObjectEnd ObjectInstance \"o\"\n"
        "ActiveTransform EndTime Translate 1 0 0 ObjectInstance \"o\"");
    ASSERT_EQ(d.objects.size(), 2u);
    ASSERT_EQ(d.instances.size(), 4u);
    EXPECT_EQ(d.instances[0].object, 0);
    EXPECT_EQ(d.instances[0].motion, -1);
    EXPECT_EQ(d.instances[1].object, 1);
    EXPECT_EQ(d.motions.at(d.instances[2].motion).size(), 1u);
    const Motion& both = d.motions.at(d.instances[3].motion);
    ASSERT_EQ(both.size(), 2u);
    EXPECT_EQ(both[0].at[1], Translation(1, 0, 0));
    EXPECT_EQ(both[1].at[1], Translation(0, 1, 0));
}

TEST_F(Directives, CamerasMoveAndLightsDoNot) {
    const auto d = folder.Parse(
        "ActiveTransform StartTime Translate 1 0 0 Camera \"perspective\"\n"
        "WorldBegin ActiveTransform EndTime Translate 0 0 1 LightSource \"point\" WorldEnd",
        &warnings);
    ASSERT_TRUE(d.movingCameraFromWorld);
    EXPECT_EQ(d.cameraFromWorld, Translation(1, 0, 0));
    EXPECT_EQ(d.movingCameraFromWorld->at[1], Mat4d::Identity());
    EXPECT_EQ(d.lights.at(0).worldFromLight, Mat4d::Identity());
    EXPECT_EQ(warnings.Counts().at("motion ignored"), 1);
}

TEST_F(Directives, AttributeScopeRestoresEverything) {
    const auto d = folder.ParseWorld(
        "Material \"plastic\" AttributeBegin Material \"glass\" Translate 1 0 0 "
        "ReverseOrientation AreaLightSource \"diffuse\" Shape \"sphere\" AttributeEnd "
        "Shape \"disk\"");
    ASSERT_EQ(d.shapes.size(), 2u);
    EXPECT_EQ(d.materials[d.shapes[0].material].name, "glass");
    EXPECT_TRUE(d.shapes[0].reverseOrientation);
    ASSERT_TRUE(d.shapes[0].areaLight);
    EXPECT_EQ(d.shapes[0].areaLight->name, "diffuse");
    EXPECT_EQ(d.materials[d.shapes[1].material].name, "plastic");
    EXPECT_FALSE(d.shapes[1].reverseOrientation);
    EXPECT_FALSE(d.shapes[1].areaLight);
    EXPECT_EQ(d.shapes[1].worldFromObject, Mat4d::Identity());
}

TEST_F(Directives, TransformScopeRestoresTheTransformOnly) {
    const auto d = folder.ParseWorld(
        "TransformBegin Translate 1 0 0 Material \"glass\" Texture \"t\" \"float\" \"constant\" "
        "TransformEnd Shape \"sphere\" \"texture alpha\" \"t\"");
    EXPECT_EQ(d.shapes[0].worldFromObject, Mat4d::Identity());
    EXPECT_EQ(d.materials[d.shapes[0].material].name, "glass");
    EXPECT_EQ(d.shapes[0].parameters.GetTexture("alpha")->floatIndex, 0);
}

TEST_F(Directives, SecondReverseOrientationAndEmptyAreaLightSwitchOff) {
    const auto d = folder.ParseWorld(
        "ReverseOrientation ReverseOrientation AreaLightSource \"diffuse\" AreaLightSource \"\" "
        "Shape \"sphere\"");
    EXPECT_FALSE(d.shapes[0].reverseOrientation);
    EXPECT_FALSE(d.shapes[0].areaLight);
}

TEST_F(Directives, LightKeepsTransformAndPlace) {
    const auto d = folder.ParseWorld("\nTranslate 1 0 0\nLightSource \"point\" \"rgb I\" [1 2 3]");
    ASSERT_EQ(d.lights.size(), 1u);
    EXPECT_EQ(d.lights[0].name, "point");
    EXPECT_EQ(d.lights[0].worldFromLight, Translation(1, 0, 0));
    EXPECT_EQ(d.lights[0].loc.line, 3);
}

TEST_F(Directives, ShapeBeforeAnyMaterialIsMatte) {
    const auto d = folder.ParseWorld("Shape \"sphere\" Shape \"sphere\" Material \"glass\"");
    ASSERT_EQ(d.materials.size(), 2u);
    EXPECT_EQ(d.shapes[0].material, d.shapes[1].material);
    EXPECT_EQ(d.materials[d.shapes[0].material].name, "matte");
}

TEST_F(Directives, NamedMaterials) {
    const auto d = folder.ParseWorld(
        "MakeNamedMaterial \"gold\" \"string type\" \"metal\" \"float roughness\" .1\n"
        "Material \"matte\" NamedMaterial \"gold\" Shape \"sphere\"");
    const MaterialEntity& material = d.materials.at(d.shapes.at(0).material);
    EXPECT_EQ(material.name, "metal");
    EXPECT_EQ(material.materialName, "gold");
    EXPECT_FLOAT_EQ(material.parameters.GetFloat("roughness", 0), .1f);
    material.parameters.ReportUnused("", warnings);  // "type" is used
    EXPECT_EQ(warnings.Total(), 0);
}

TEST_F(Directives, ParametersOfShapesReplaceThoseOfTheirMaterial) {
    const auto d = folder.ParseWorld(
        "Texture \"t\" \"spectrum\" \"constant\"\n"
        "MakeNamedMaterial \"a\" \"string type\" \"plastic\" \"rgb Kd\" [1 0 0] "
        "\"texture Ks\" \"t\" NamedMaterial \"a\"\nShape \"sphere\" \"float radius\" 2\n"
        "Shape \"sphere\" \"texture Kd\" \"t\" \"rgb Ks\" [0 1 0] \"float roughness\" .5",
        &warnings);
    const MaterialEntity &own = d.materials.at(size_t(d.shapes.at(1).material)),
                         &common = d.materials.at(size_t(d.shapes.at(0).material));
    EXPECT_EQ(own.name, "plastic");
    EXPECT_EQ(own.parameters.GetTexture("Kd")->name, "t");
    EXPECT_EQ(own.parameters.GetTexture("Ks"), nullptr);
    EXPECT_EQ(own.parameters.GetSpectrum("Kd", Rgb::Zero()).x(), 0);
    EXPECT_EQ(own.parameters.GetSpectrum("Ks", Rgb::Zero()).y(), 1);
    EXPECT_EQ(own.parameters.GetFloat("roughness", 0), .5f);
    EXPECT_EQ(common.parameters.GetSpectrum("Kd", Rgb::Zero()).x(), 1);
    d.shapes[1].parameters.ReportUnused("", warnings);
    EXPECT_EQ(warnings.Total(), 0);
}

TEST_F(Directives, RedefinedMaterialCountsForWhatFollows) {
    const auto d = folder.ParseWorld(
        "MakeNamedMaterial \"a\" \"string type\" \"matte\" NamedMaterial \"a\" Shape \"sphere\"\n"
        "MakeNamedMaterial \"a\" \"string type\" \"glass\" Shape \"sphere\"\n"
        "NamedMaterial \"a\" Shape \"sphere\"",
        &warnings);
    EXPECT_EQ(d.materials[d.shapes[0].material].name, "matte");
    EXPECT_EQ(d.materials[d.shapes[1].material].name, "matte");
    EXPECT_EQ(d.materials[d.shapes[2].material].name, "glass");
    EXPECT_EQ(warnings.Counts().at("named material redefined"), 1);
}

TEST_F(Directives, MixNamesItsOperandsAsTheyStood) {
    const auto d = folder.ParseWorld(
        "MakeNamedMaterial \"a\" \"string type\" \"matte\"\n"
        "Material \"mix\" \"string namedmaterial1\" \"a\" \"string namedmaterial2\" \"b\"\n"
        "MakeNamedMaterial \"b\" \"string type\" \"glass\"\n"
        "MakeNamedMaterial \"m\" \"string type\" \"mix\" \"string namedmaterial1\" \"b\"\n"
        "  \"string namedmaterial2\" \"a\"");
    ASSERT_EQ(d.materials.size(), 4u);
    EXPECT_EQ(d.materials[1].operands, (std::array{0, -1}));
    EXPECT_EQ(d.materials[3].operands, (std::array{2, 0}));
}

TEST_F(Directives, TexturesOfBothKindsAndTheirScopes) {
    const auto d = folder.ParseWorld(
        "Translate 1 0 0 Texture \"t\" \"float\" \"constant\" \"float value\" 2\n"
        "Texture \"t\" \"spectrum\" \"scale\" \"texture tex1\" \"t\"\n"
        "AttributeBegin Texture \"t\" \"color\" \"checkerboard\" "
        "Material \"matte\" \"texture Kd\" \"t\" AttributeEnd\n"
        "Material \"matte\" \"texture Kd\" \"t\" \"texture sigma\" \"none\"",
        &warnings);
    ASSERT_EQ(d.textures.size(), 3u);
    EXPECT_EQ(d.textures[0].textureName, "t");
    EXPECT_FALSE(d.textures[0].isSpectrum);
    EXPECT_EQ(d.textures[0].worldFromTexture, Translation(1, 0, 0));
    EXPECT_TRUE(d.textures[1].isSpectrum);
    // Names mean what they meant before the texture itself was there.
    EXPECT_EQ(d.textures[1].parameters.GetTexture("tex1")->floatIndex, 0);
    EXPECT_EQ(d.textures[1].parameters.GetTexture("tex1")->spectrumIndex, -1);
    EXPECT_EQ(d.materials[0].parameters.GetTexture("Kd")->spectrumIndex, 2);
    EXPECT_EQ(d.materials[1].parameters.GetTexture("Kd")->spectrumIndex, 1);
    EXPECT_EQ(d.materials[1].parameters.GetTexture("Kd")->floatIndex, 0);
    EXPECT_EQ(d.materials[1].parameters.GetTexture("sigma")->spectrumIndex, -1);
    EXPECT_EQ(d.materials[1].parameters.GetTexture("sigma")->name, "none");
    EXPECT_EQ(warnings.Counts().at("texture redefined"), 1);
}

TEST_F(Directives, ObjectsHoldShapesAndInstancesPlaceThem) {
    const auto d = folder.ParseWorld(
        "Translate 1 0 0 ObjectBegin \"o\" Translate 0 1 0 Shape \"sphere\" ObjectEnd\n"
        "Shape \"disk\" AttributeBegin Identity Translate 0 0 1 ObjectInstance \"o\" "
        "AttributeEnd ObjectInstance \"o\"");
    ASSERT_EQ(d.objects.size(), 1u);
    EXPECT_EQ(d.objects[0].name, "o");
    ASSERT_EQ(d.objects[0].shapes.size(), 1u);
    EXPECT_EQ(d.objects[0].shapes[0].worldFromObject, Translation(1, 1, 0));
    ASSERT_EQ(d.shapes.size(), 1u);
    EXPECT_EQ(d.shapes[0].worldFromObject, Translation(1, 0, 0));
    ASSERT_EQ(d.instances.size(), 2u);
    EXPECT_EQ(d.instances[0].object, 0);
    EXPECT_EQ(d.instances[0].worldFromInstance, Translation(0, 0, 1));
    EXPECT_EQ(d.instances[1].worldFromInstance, Translation(1, 0, 0));
    EXPECT_EQ(d.instances[1].loc.line, 2);
}

// As pbrt-v3's exporters write it: attributes and objects share a stack, and their ends may cross.
TEST_F(Directives, EndsOfAttributesAndObjectsMayCross) {
    const auto d = folder.ParseWorld(
        "AttributeBegin Translate 1 0 0 ObjectBegin \"o\" Translate 0 1 0 Shape \"sphere\"\n"
        "AttributeEnd Shape \"disk\" ObjectEnd Shape \"cone\"");
    ASSERT_EQ(d.objects.size(), 1u);
    ASSERT_EQ(d.objects[0].shapes.size(), 2u);
    EXPECT_EQ(d.objects[0].shapes[0].worldFromObject, Translation(1, 1, 0));
    EXPECT_EQ(d.objects[0].shapes[1].worldFromObject, Translation(1, 0, 0));
    ASSERT_EQ(d.shapes.size(), 1u);
    EXPECT_EQ(d.shapes[0].worldFromObject, Mat4d::Identity());
}

TEST_F(Directives, RedefinedObjectCountsForWhatFollows) {
    const auto d = folder.ParseWorld(
        "ObjectBegin \"o\" ObjectEnd ObjectInstance \"o\" ObjectBegin \"o\" ObjectEnd "
        "ObjectInstance \"o\"",
        &warnings);
    EXPECT_EQ(d.instances[0].object, 0);
    EXPECT_EQ(d.instances[1].object, 1);
    EXPECT_EQ(warnings.Counts().at("object redefined"), 1);
}

TEST_F(Directives, AreaLightsInObjectsAreIgnoredWithAWarning) {
    const auto d = folder.ParseWorld(
        "AreaLightSource \"diffuse\" ObjectBegin \"o\" Shape \"sphere\" Shape \"sphere\" ObjectEnd",
        &warnings);
    EXPECT_FALSE(d.objects[0].shapes[0].areaLight);
    EXPECT_EQ(warnings.Counts().at("area light ignored in an object definition"), 2);
}

TEST_F(Directives, IncludeStartsAtTheScenesFolder) {
    folder.Write("parts/a.pbrt", "# a\nShape \"sphere\"\nInclude \"parts/b.pbrt\"\n");
    folder.Write("parts/b.pbrt", "Shape \"disk\"");
    const auto d = folder.ParseWorld(
        "Include \"parts/a.pbrt\" Include \"parts/b.pbrt\" \"float radius\" 3 Shape \"cone\"");
    ASSERT_EQ(d.shapes.size(), 4u);
    EXPECT_EQ(d.shapes[0].name, "sphere");
    EXPECT_EQ(d.shapes[0].loc.Prefix(), folder.File("parts/a.pbrt") + ":2: ");
    EXPECT_EQ(d.shapes[1].name, "disk");
    // Parameters may follow from the includer, as in pbrt-v3.
    EXPECT_EQ(d.shapes[2].parameters.GetFloat("radius", 0), 3);
    EXPECT_EQ(d.shapes[3].loc.Prefix(), folder.File("scene.pbrt") + ":1: ");
}

TEST_F(Directives, MediaAreIgnoredByThePathIntegrator) {
    const auto d = folder.Parse(
        "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" Integrator \"path\" WorldBegin "
        "MediumInterface \"m\" \"\" MediumInterface \"m\" MediumInterface \"\" Shape \"sphere\" "
        "WorldEnd",
        &warnings);
    EXPECT_EQ(d.shapes.size(), 1u);
    EXPECT_EQ(warnings.Counts().at("participating medium ignored"), 3);
}

TEST_F(Directives, MediaLieOnBothSidesOfShapes) {
    const auto d = folder.Parse(
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" MediumInterface \"\" \"fog\" "
        "Integrator \"volpath\" WorldBegin Translate 1 2 3 "
        "MakeNamedMedium \"m\" \"string type\" \"heterogeneous\" "
        "AttributeBegin MediumInterface \"m\" \"fog\" Shape \"sphere\" "
        "MediumInterface \"m\" Shape \"disk\" MediumInterface \"\" Shape \"disk\" AttributeEnd "
        "Shape \"sphere\" WorldEnd",
        &warnings);
    EXPECT_EQ(warnings.Total(), 0);
    ASSERT_EQ(d.media.size(), 2u);
    EXPECT_EQ(d.media[1].name, "heterogeneous");
    EXPECT_EQ(d.media[1].mediumName, "m");
    EXPECT_EQ(d.media[1].worldFromMedium(1, 3), 2);
    EXPECT_EQ(d.cameraMedium, 0);
    const int sides[][2] = {{1, 0}, {1, 1}, {-1, -1}, {-1, 0}};
    ASSERT_EQ(d.shapes.size(), std::size(sides));
    for (size_t i = 0; i < d.shapes.size(); ++i) {
        EXPECT_EQ(d.shapes[i].insideMedium, sides[i][0]) << i;
        EXPECT_EQ(d.shapes[i].outsideMedium, sides[i][1]) << i;
    }
}

}  // namespace
}  // namespace lull
