// Images and blocks of sizes that nobody had in mind.
#include <fmt/format.h>

#include <cmath>

#include "renderer/render/render.h"
#include "stopping/rules/rule_table.h"
#include "tests/hard_cases/hard_case.h"

namespace lull {

namespace {

// Returns noise around a smooth image.
void Noise(Sampler& sampler, const Vec2i& pixel, uint32_t index, PathSample* sample) {
    sampler.StartSample(pixel, index);
    const float smooth = 0.5f + 0.4f * std::sin(0.02f * float(pixel.x() + 2 * pixel.y()));
    sample->radiance = Rgb::Constant(smooth * 2 * sampler.Get1D());
}

// Renders and notes each pixel whose samples are not those of the block it is in, or that is in
// none or in two.
void Check(const Vec2i& size, int blockSize, const std::string& rule, int cap, Failures* wrong) {
    const Rule factory = ParseRule(rule);
    RenderOptions options;
    options.schedule = {
        .blockSize = blockSize, .passLength = 20, .cap = cap, .smallestSide = factory.smallestSide};
    options.sampler = Sampler(SamplerKind::Random, 0);
    options.makeCriterion = CriteriaOf(factory);
    Film film({{0, 0}, size}, {.grid = GridOf(options.schedule)});
    const RenderResult result = Render({.source = Noise, .film = &film}, options);

    const std::vector<float> counts = film.SppImage();
    std::vector<int> expected(counts.size(), 0), blocks(counts.size(), 0);
    for (const BlockResult& r : result.blocks)
        for (int y = r.block.pixels.min.y(); y < r.block.pixels.max.y(); ++y)
            for (int x = r.block.pixels.min.x(); x < r.block.pixels.max.x(); ++x) {
                const size_t i = size_t(y) * size_t(size.x()) + size_t(x);
                expected[i] = r.block.spp;
                ++blocks[i];
            }
    for (size_t i = 0; i < expected.size(); ++i) {
        const int count = int(counts[i]);
        wrong->Note(count != expected[i] || blocks[i] != 1 || count < 20 || count > cap, [&] {
            return fmt::format("{}x{}, blocks of {}, {}, pixel {}", size.x(), size.y(), blockSize,
                               rule, i);
        });
    }
}

HardCaseResult Sizes(const HardCaseOptions&) {
    Failures wrong;
    for (const Vec2i& size : {Vec2i(1, 1), Vec2i(199, 201), Vec2i(201, 1), Vec2i(10'000, 20)})
        for (const char* rule :
             {"fixed:20", "dammertz:0.06", "lnoise:2", "luxtile:0.5", "entropy:2"})
            Check(size, 200, rule, 60, &wrong);
    return wrong.Result("pixels");
}

HardCaseResult SmallBlocks(const HardCaseOptions&) {
    Failures wrong;
    for (const int blockSize : {1, 7, 19, 39, 41, 1000})
        for (const char* rule : {"dammertz:0.06", "lnoise:2", "cycles:0.2", "entropy:2"})
            Check({83, 47}, blockSize, rule, 100, &wrong);
    return wrong.Result("pixels");
}

}  // namespace

std::vector<HardCase> ImageSizeCases() {
    return {{"image sizes", "1x1, 199x201, 201x1 and 10,000x20 pixels",
             "pixels at the border are left out or sampled twice", Sizes},
            {"image sizes", "blocks of 1 to 1,000 pixels, smaller than a sub-block too",
             "sub-blocks without pixels; blocks that never stop", SmallBlocks}};
}

}  // namespace lull
