#include <gtest/gtest.h>

#include "renderer/pages/html_page.h"
#include "tests/renderer/film/add_sample.h"
#include "tests/renderer/pages/page_data.h"

namespace lull {
namespace {

// Returns the page of a render of this scene.
std::string PageOf(const std::string& scene) {
    Provenance provenance;
    provenance.scene = scene;
    return MakeRenderPage(provenance, {}, Film({{0, 0}, {1, 1}}), {}, {}, nullptr);
}

TEST(MakeRenderPage, HoldsAllFilesAndNeedsNoOther) {
    const std::string page = PageOf("x");
    for (const char* name :
         {"page.css", "page.js", "viewer.js", "render.js", "uPlot.iife.min.js"}) {
        ASSERT_FALSE(EmbeddedFile(name).empty()) << name;
        EXPECT_HAS(page, std::string(EmbeddedFile(name))) << name;
    }
    for (const char* name : {"comparison.css", "comparison.js", "study.js"}) {
        ASSERT_FALSE(EmbeddedFile(name).empty()) << name;
        EXPECT_EQ(page.find(EmbeddedFile(name)), std::string::npos)
            << name << " is the laboratory's";
    }
    EXPECT_EQ(EmbeddedFile("no such file"), "");
    EXPECT_HAS(page, "http-equiv=\"Content-Security-Policy\" content=\"default-src 'none';");
    for (const char* reaching :
         {"src=\"http", "href=\"http", "@import", "url(", "fetch(", "import("})
        EXPECT_EQ(page.find(reaching), std::string::npos) << reaching;
    EXPECT_FALSE(Contains(page, ".js}}") || Contains(page, ".css}}") || Contains(page, "{{data}}"));
}

TEST(FillPage, CannotBeBrokenByItsData) {
    const std::string evil = "</script><script>alert(1)</script><!-- {{page.js}} \xff";
    const std::string page = FillPage("page.html", {{"data", JsonForScript({{"title", evil}})}});
    EXPECT_FALSE(Contains(page, "alert(1)</script>"));
    const std::string title = DataOf(page)["title"];
    EXPECT_TRUE(title.starts_with("</script><script>alert(1)</script><!-- {{page.js}} "));
}

TEST(PictureUri, IsAPngInBase64) {
    const std::string uri = PictureUri({2, 1, {0, 0, 0, 1, 1, 1}});
    EXPECT_TRUE(uri.starts_with("data:image/png;base64,iVBORw0KGgo"));
    EXPECT_EQ((uri.size() - std::string("data:image/png;base64,").size()) % 4, 0u);
    EXPECT_TRUE(MapUri(std::vector<float>{0, 0.5f, 1}, 3, 1).starts_with("data:image/png;base64,"));
}

TEST(PagePicture, IsTheImageWhereThatIsSmall) {
    EXPECT_EQ(PagePictureScale(2048, 2048), 1);
    EXPECT_EQ(PagePictureScale(3840, 2160), 2);
    EXPECT_EQ(PagePictureScale(7680, 4320), 3);
    Film film({{2, 1}, {5, 3}});
    AddTo(&film, {4, 2}, Rgb(1, 2, 3));
    EXPECT_EQ(PagePicture(film).values, film.MeanImage());
}

TEST(PagePicture, IsOfMeansWhereTheImageIsLarge) {
    const PixelRect region{{10, 20}, {10 + 2901, 20 + 1601}};
    Film film(region);
    AddTo(&film, {10, 20}, Rgb(4, 8, 0));
    AddTo(&film, {11, 21}, Rgb(0, 0, 12));
    AddTo(&film, region.max - Vec2i(1, 1), Rgb(5, 6, 7));  // alone in its place
    const RgbImage picture = PagePicture(film);
    ASSERT_EQ(picture.width, 1451);
    ASSERT_EQ(picture.height, 801);
    ASSERT_EQ(picture.values.size(), size_t(1451 * 801 * 3));
    EXPECT_EQ(std::vector(picture.values.begin(), picture.values.begin() + 4),
              std::vector<float>({1, 2, 3, 0}));
    EXPECT_EQ(std::vector(picture.values.end() - 3, picture.values.end()),
              std::vector<float>({5, 6, 7}));
    RenderResult result;
    Provenance provenance;
    provenance.scene = "a.pbrt";
    const Json data = DataOf(MakeRenderPage(provenance, result, film, {}, {}, nullptr));
    EXPECT_EQ(data["width"], 2901);
    EXPECT_HAS(data["notes"][0].get<std::string>(), "2x2");
}

TEST(MakeRenderPage, HasCurvesAndDecisions) {
    RenderResult result;
    result.blocks.resize(1);
    result.blocks[0].block = {
        .pixels = {{4, 4}, {8, 8}}, .spp = 20, .stopped = true, .stoppedByVote = true};
    result.blocks[0].decisions = {
        {20, {.stop = true, .checked = true, .value = 1, .threshold = 2}}};
    std::vector<BlockHistory> histories(1);
    histories[0].curves = {{20}, {0.5f}, {1.5f}};
    Provenance provenance;
    provenance.scene = "rooms/hall/scene.pbrt";
    provenance.criterion = "lnoise:2";
    provenance.schedule.cap = 100;
    const Film film({{4, 4}, {8, 8}});
    const Json data =
        DataOf(MakeRenderPage(provenance, result, film, histories, {{"odd", 2}}, nullptr));
    EXPECT_EQ(data["kind"], "render");
    EXPECT_EQ(data["title"], "hall");
    EXPECT_EQ(data["blocks"][0]["x"], 0);
    EXPECT_EQ(data["blocks"][0]["curves"]["noise"][0], 1.5);
    EXPECT_EQ(data["blocks"][0]["decisions"]["value"][0], 1);
    EXPECT_EQ(data["images"][0]["blocks"][0]["spp"], 20);
    EXPECT_EQ(data["warnings"]["odd"], 2);
    EXPECT_EQ(data["images"].size(), 1);

    const DenoisedImage denoised{{4, 4, std::vector<float>(48, .5f)},
                                 std::vector<float>(16, .3f),
                                 {VisibleError{.estimate = .25, .upper = .5}}};
    const Json clean = DataOf(MakeRenderPage(provenance, result, film, histories, {}, &denoised));
    EXPECT_EQ(clean["images"].size(), 3);
    EXPECT_EQ(clean["images"][0]["label"], "denoised image");
    EXPECT_EQ(clean["blocks"][0]["visibleDifference"]["upper"], .5);
}

}  // namespace
}  // namespace lull
