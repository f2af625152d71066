// Reads the scene's Integrator.
#include "renderer/scene/integrator.h"

#include <gtest/gtest.h>

#include "renderer/base/error.h"
#include "renderer/input/pbrt_parser.h"
#include "tests/renderer/files/test_files.h"

namespace lull::integrator_test {
namespace {

Integrator Read(const std::string& directive, Warnings* warnings, int maxDepth = -1,
                bool isVolumetric = false, const char* beyondBdpt = nullptr) {
    const TemporaryDirectory directory;
    Warnings ofParser;
    const Description description =
        ParsePbrt(directory.Write("test.pbrt", directive + "\nWorldBegin\nWorldEnd\n"), ofParser);
    return MakeIntegrator(description.integrator, maxDepth, isVolumetric, beyondBdpt, *warnings);
}

TEST(Integrator, IsPathUnlessTheSceneSays) {
    Warnings warnings;
    const Integrator integrator = Read("", &warnings);
    EXPECT_EQ(NameOf(integrator, false), "path");
    EXPECT_EQ(NameOf(integrator, true), "volpath");
    EXPECT_EQ(MaxDepth(integrator), 5);
    EXPECT_EQ(std::get<PathIntegrator>(integrator).rrThreshold, 1);
    EXPECT_EQ(warnings.Total(), 0);
}

TEST(Integrator, HasTheParametersOfTheScene) {
    for (const char* name : {"path", "volpath"}) {
        Warnings warnings;
        const std::string directive = std::string("Integrator \"") + name +
                                      "\" \"integer maxdepth\" [1] \"float rrthreshold\" [.25] "
                                      "\"string lightsamplestrategy\" \"power\"";
        EXPECT_EQ(TextOf(Read(directive, &warnings)),
                  "up to 1 bounce; Russian roulette below a throughput of 0.25");
        EXPECT_EQ(MaxDepth(Read(directive, &warnings, 70)), 70);
        EXPECT_EQ(MaxDepth(Read(directive, &warnings, 0)), 0);
        EXPECT_EQ(warnings.Total(), 0);
    }
}

TEST(Integrator, OfAnotherKindIsPathWithAWarning) {
    Warnings warnings;
    EXPECT_EQ(
        MaxDepth(Read("Integrator \"whitted\" \"integer maxdepth\" [9]", &warnings, -1, true)), 9);
    const std::map<std::string, int> expected = {
        {"Integrator \"whitted\" is rendered as \"volpath\"", 1}};
    EXPECT_EQ(warnings.Counts(), expected);
}

TEST(Integrator, StartsPathsFromLightsWhereTheSceneSays) {
    Warnings warnings;
    const Integrator bdpt = Read("Integrator \"bdpt\" \"integer maxdepth\" [9]", &warnings);
    EXPECT_EQ(NameOf(bdpt, false), "bdpt");
    EXPECT_EQ(MaxDepth(bdpt), 9);
    EXPECT_TRUE(TracesFromLights(bdpt));
    EXPECT_EQ(warnings.Total(), 0);
    for (const char* name : {"mlt", "sppm"})
        EXPECT_TRUE(TracesFromLights(
            Read(std::string("Integrator \"") + name + "\" \"integer chains\" [3]", &warnings)));
    const std::map<std::string, int> expected = {
        {"Integrator \"mlt\" is rendered as \"bdpt\"", 1},
        {"Integrator \"sppm\" is rendered as \"bdpt\"", 1}};
    EXPECT_EQ(warnings.Counts(), expected);
}

TEST(Integrator, IsPathWhereLightPathsCannotGo) {
    Warnings warnings;
    EXPECT_FALSE(
        TracesFromLights(Read("Integrator \"bdpt\"", &warnings, -1, true, "there is fog")));
    const std::map<std::string, int> expected = {
        {"Integrator \"bdpt\" is rendered as \"volpath\", as there is fog", 1}};
    EXPECT_EQ(warnings.Counts(), expected);
}

TEST(Integrator, KeepsSubpathsFromLightsShort) {
    Warnings warnings;
    EXPECT_EQ(MaxDepth(Read("Integrator \"bdpt\"", &warnings, 1000)), 100);
    EXPECT_EQ(warnings.Total(), 1);
}

// Nothing else ends paths between mirrors that reflect all light.
TEST(Integrator, EndsPathsThatLoseNothing) {
    Warnings warnings;
    EXPECT_EQ(MaxDepth(Read("Integrator \"path\" \"integer maxdepth\" [100000]", &warnings)),
              100000);
    EXPECT_EQ(warnings.Total(), 0);
    EXPECT_EQ(MaxDepth(Read("Integrator \"volpath\" \"integer maxdepth\" [2000000000]", &warnings,
                            -1, true)),
              100000);
    EXPECT_EQ(warnings.Counts().at("paths of \"volpath\" have 100000 bounces at most"), 1);
}

TEST(Integrator, ReportsWhatItCannotUse) {
    Warnings warnings;
    Read("Integrator \"path\" \"integer maxdpeth\" [9]", &warnings);
    EXPECT_EQ(warnings.Total(), 1);
    EXPECT_THROW(Read("Integrator \"path\" \"integer maxdepth\" [-1]", &warnings), Error);
}

}  // namespace
}  // namespace lull::integrator_test
