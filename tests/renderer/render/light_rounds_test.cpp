// Renders with light paths: the same bits however they are cut, with the mean that paths have.
#include "renderer/render/light_rounds.h"

#include <gtest/gtest.h>

#include <atomic>

#include "renderer/render/session.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/render/synthetic_samples.h"
#include "tests/renderer/scene_of.h"

namespace lull::light_rounds_test {
namespace {

// A lamp that is a point in a glass ball: no path from the camera finds its light.
std::unique_ptr<const Scene> MakeScene(bool inGlass, const char* integrator,
                                       const char* filter = "box") {
    return SceneOf(std::string(R"(
LookAt 0 0 -3  0 0 0  0 1 0
Camera "perspective" "float fov" [45]
Film "image" "integer xresolution" [32] "integer yresolution" [24]
PixelFilter ")") + filter +
                   "\"\nIntegrator \"" + integrator + R"(" "integer maxdepth" [6]
WorldBegin
LightSource "point" "point from" [.2 .3 0] "rgb I" [3 2 1]
)" +
                   (inGlass ? "AttributeBegin Material \"glass\" Translate .2 .3 0 Shape "
                              "\"sphere\" \"float radius\" [.2] AttributeEnd"
                            : "") +
                   R"(
Material "matte" "rgb Kd" [.7 .5 .3]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3 4 5 6 4 6 7 3 2 6 3 6 7]
  "point P" [-1 -1 -1  1 -1 -1  1 -1 1  -1 -1 1   -1 1 -1  1 1 -1  1 1 1  -1 1 1]
WorldEnd
)");
}

const PixelRect kRegion = {{0, 0}, {32, 24}};

SessionOptions OptionsFor(const std::string& checkpoint, int threads = 1) {
    SessionOptions options;
    options.render.schedule = {.blockSize = 16, .passLength = 20, .cap = 100, .inSteps = true};
    options.render.threads = threads;
    options.render.makeCriterion = [](const BlockInfo& block) {
        return std::make_unique<ScriptedCriterion>(40 + 20 * block.index);
    };
    options.film.grid = GridOf(options.render.schedule);
    options.film.layers.features = true;
    options.checkpoint = {.file = checkpoint, .interval = 1e6, .resume = true};
    options.identity = {{"scene", "lamp"}};
    return options;
}

TEST(LightRounds, HaveTheSameBitsForAnyThreadsAndInterruption) {
    const auto scene = MakeScene(true, "bdpt", "gaussian");
    Session whole(*scene, kRegion, OptionsFor(""));
    ASSERT_FALSE(whole.Run().cancelled);
    Session parallel(*scene, kRegion, OptionsFor("", 2));
    parallel.Run();
    EXPECT_TRUE(SameSums(parallel.GetFilm(), whole.GetFilm()));

    const TemporaryDirectory directory;
    const std::string file = directory.File("c.h5");
    int interruptions = 0;
    for (bool isDone = false; !isDone;) {
        int left = 15 * (1 + interruptions);
        SessionOptions options = OptionsFor(file);
        options.render.isCancelled = [&] { return left-- <= 0; };
        Session session(*scene, kRegion, options);
        session.Resume();
        isDone = !session.Run().cancelled;
        interruptions += !isDone;
        if (!isDone) continue;
        EXPECT_TRUE(SameSums(session.GetFilm(), whole.GetFilm()));
    }
    EXPECT_GT(interruptions, 2);
}

// Counts the blocks that come to a number of samples, and stops none.
class CountingCriterion : public Criterion {
  public:
    CountingCriterion(int at, std::atomic<int>* left) : at(at), left(left) {}
    ViewNeed Need(int) const override { return ViewNeed::MeanAndHalf; }
    Decision Observe(const BlockView& view) override {
        if (view.spp == at) --*left;
        Decision decision;
        decision.checked = true;
        return decision;
    }

  private:
    int at;
    std::atomic<int>* left;
};

// A first cap, or an interruption, loses nothing of what was learned, be it at the end of a round
// or within one.
TEST(LightRounds, HaveTheSameBitsFromTheEndsOfRoundsOn) {
    const auto scene = MakeScene(true, "bdpt", "gaussian");
    const auto optionsFor = [](const std::string& file, int cap) {
        SessionOptions options = OptionsFor(file);
        options.render.makeCriterion = {};
        options.render.schedule.cap = cap;
        options.identity["cap"] = std::to_string(cap);
        options.checkpoint.mayDiffer = MayDiffer::Stops;
        options.checkpoint.isKept = true;
        return options;
    };
    Session whole(*scene, kRegion, optionsFor("", 60));
    whole.Run();
    for (const int cap : {2, 5, 20, 27}) {
        const TemporaryDirectory directory;
        const std::string file = directory.File("c.h5");
        for (const int end : {cap, 60}) {
            Session session(*scene, kRegion, optionsFor(file, end));
            session.Resume();
            session.Run();
            if (end == 60) {
                EXPECT_TRUE(SamePixels(session.GetFilm(), whole.GetFilm())) << cap;
            }
        }
    }
    // Cancelled when the last block's pass has been decided on.
    for (const int spp : {20, 40}) {
        const TemporaryDirectory directory;
        const std::string file = directory.File("c.h5");
        std::atomic<int> left = int(MakeBlocks(kRegion, OptionsFor("").render.schedule).size());
        SessionOptions first = optionsFor(file, 60);
        first.render.isCancelled = [&] { return left <= 0; };
        first.render.makeCriterion = [&](const BlockInfo&) {
            return std::make_unique<CountingCriterion>(spp, &left);
        };
        Session interrupted(*scene, kRegion, first);
        EXPECT_TRUE(interrupted.Run().cancelled);
        SessionOptions second = optionsFor(file, 60);
        second.identity["stop"] = "another";
        Session session(*scene, kRegion, second);
        session.Resume();
        session.Run();
        EXPECT_TRUE(SamePixels(session.GetFilm(), whole.GetFilm())) << spp;
    }
}

// Returns the mean over the image of all samples, or of either half.
struct Means {
    double all = 0, half = 0, other = 0;
};
Means MeansOf(const Film& film) {
    Means means;
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 32; ++x) {
            const FilmPixel pixel = film.At({x, y});
            const double inHalf = HalfCount(pixel.count), count = pixel.count;
            means.all += pixel.sum[1] / count / (32 * 24);
            means.half += pixel.halfSum[1] / inHalf / (32 * 24);
            means.other += (pixel.sum[1] - pixel.halfSum[1]) / (count - inHalf) / (32 * 24);
        }
    return means;
}

// Renders without a rule.
std::unique_ptr<Session> RunTo(const Scene& scene, int cap, int threads = 2) {
    SessionOptions options = OptionsFor("", threads);
    options.render.makeCriterion = {};
    options.render.schedule.cap = cap;
    auto session = std::make_unique<Session>(scene, kRegion, options);
    session->Run();
    return session;
}

Means Render(const Scene& scene, int spp) { return MeansOf(RunTo(scene, spp)->GetFilm()); }

TEST(LightRounds, HaveTheMeanOfPaths) {
    for (const char* filter : {"box", "gaussian", "mitchell"}) {
        const Means paths = Render(*MakeScene(false, "path", filter), 256);
        const Means bdpt = Render(*MakeScene(false, "bdpt", filter), 256);
        EXPECT_NEAR(bdpt.all / paths.all, 1, 0.01) << filter;
        EXPECT_NEAR(bdpt.half / paths.all, 1, 0.015);
        EXPECT_NEAR(bdpt.other / paths.all, 1, 0.015);
    }
}

// The mean does not depend on how many samples are taken, nor on where rounds end.
TEST(LightRounds, FindLightBehindGlass) {
    const auto path = MakeScene(true, "path"), bdpt = MakeScene(true, "bdpt");
    EXPECT_LT(Render(*path, 64).all, 0.02);
    const Means few = Render(*bdpt, 24), many = Render(*bdpt, 200);
    EXPECT_GT(many.all, 0.1);
    EXPECT_NEAR(few.all / many.all, 1, 0.03);
    EXPECT_NEAR(many.half / many.other, 1, 0.03);
}

// The first round's samples decide how many light paths the next ones have.
TEST(LightRounds, TakeMoreLightPathsWhereTheseHaveTheVariance) {
    const auto pathsIn = [](bool inGlass) {
        const auto scene = MakeScene(inGlass, "bdpt");
        return RunTo(*scene, 100)->Options().lightRounds->Shares().lightPaths;
    };
    EXPECT_GT(pathsIn(true), LightRounds::kFirst.lightPaths);
    EXPECT_LT(pathsIn(false), LightRounds::kFirst.lightPaths);
}

// Each light path belongs to the group of its light, and so does what connections find.
TEST(LightRounds, TellGroupsOfLightsApart) {
    const auto scene = MakeScene(false, "bdpt", "gaussian");
    SessionOptions options = OptionsFor("", 2);
    options.film.layers.groups = {{"lamp", "rest"}, {0}};
    options.film.layers.groupNoise = true;
    Session session(*scene, kRegion, options);
    session.Run();
    Session plain(*scene, kRegion, OptionsFor("", 2));
    plain.Run();
    const Film& film = session.GetFilm();
    EXPECT_TRUE(SamePixels(film, plain.GetFilm()));
    const auto& groups = *film.layers.Find<LightGroupLayer>();
    const auto& squares = *film.layers.Find<SquareLayer>();
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 32; ++x) {
            const FilmPixel all = film.At({x, y}), lamp = groups.At(0, {x, y}, all.count);
            for (size_t c = 0; c < 3; ++c) {
                ASSERT_NEAR(lamp.sum[c], all.sum[c], 1e-5 * all.sum[c] + 1e-9);
                ASSERT_NEAR(lamp.halfSum[c], all.halfSum[c], 1e-5 * all.sum[c] + 1e-9);
            }
            ASSERT_NEAR(groups.SquaresAt(0, {x, y}), squares.At({x, y}),
                        1e-3 * squares.At({x, y}) + 1e-9);
            ASSERT_EQ(groups.At(1, {x, y}, all.count).sum, (std::array<double, 3>{}));
        }
}

TEST(SplatPlane, SumsInAnyOrder) {
    const PixelRect region{{2, 3}, {4, 5}};
    SplatPlane forth(region, 0.5), back(region, 0.5);
    std::vector<Rgb> values;
    for (int i = 0; i < 1000; ++i)
        values.push_back(Rgb(0.1f, -0.2f, 0.37f) * std::exp2(float(i % 37) - 20));
    for (size_t i = 0; i < values.size(); ++i) {
        forth.Add({3, 4}, values[i], i % 2);
        back.Add({3, 4}, values[values.size() - 1 - i], i % 2 == 0);
    }
    double sum = 0;
    for (const Rgb& v : values) sum += double(v[2]);
    EXPECT_EQ(forth.SumsAt({3, 4}).sum, back.SumsAt({3, 4}).sum);
    EXPECT_EQ(forth.SumsAt({3, 4}).squares, back.SumsAt({3, 4}).squares);
    StateWriter writer;
    back.Put(region, &writer);
    StateReader reader(writer.bytes);
    forth.Merge(&reader);
    EXPECT_EQ(forth.SumsAt({3, 4}).sum[0], 2 * back.SumsAt({3, 4}).sum[0]);
    EXPECT_EQ(forth.SumsAt({3, 4}).squares, 2 * back.SumsAt({3, 4}).squares);
    sum *= 2;
    EXPECT_NEAR(forth.SumsAt({3, 4}).sum[2], sum, 1e-5 * sum);
    EXPECT_EQ(forth.SumsAt({2, 3}).sum[0], 0);
    // Enormous values do not run over.
    for (int i = 0; i < 100; ++i) forth.Add({2, 3}, Rgb(1e30f, 1e30f, 1e30f), true);
    EXPECT_GT(forth.SumsAt({2, 3}).sum[0], 1e7);
}

// Light paths whose light is infinite, or negative, count as black, and as rejected, as samples of
// paths do. None of these finds the lamp in its glass ball.
TEST(LightRounds, RejectLightThatIsNone) {
    const auto scene = SceneOf(R"(
LookAt 0 0 -3  0 0 0  0 1 0
Camera "perspective" "float fov" [45]
Film "image" "integer xresolution" [32] "integer yresolution" [24] "float scale" [3e38]
Integrator "bdpt" "integer maxdepth" [6]
WorldBegin
LightSource "point" "point from" [.2 .3 0] "rgb I" [300 200 100]
AttributeBegin Material "glass" Translate .2 .3 0 Shape "sphere" "float radius" [.2] AttributeEnd
Material "matte" "rgb Kd" [.7 .5 .3]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-1 -1 -1  1 -1 -1  1 -1 1  -1 -1 1]
WorldEnd
)");
    const auto session = RunTo(*scene, 20, 1);
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 32; ++x)
            EXPECT_TRUE(std::isfinite(session->GetFilm().At({x, y}).sum[1]));
    EXPECT_GT(session->GetFilm().RejectedCount(), 50);
}

}  // namespace
}  // namespace lull::light_rounds_test
