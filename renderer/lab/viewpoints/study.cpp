#include "renderer/lab/viewpoints/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/base/error.h"
#include "stopping/base/state.h"
#include "stopping/signals/lightness.h"

namespace lull {

namespace {

std::vector<double> LightnessOfCodes(const DisplayPixels& pixels) {
    std::vector<double> lightness(pixels.size() / 3);
    Lightness(pixels, lightness);
    return lightness;
}

}  // namespace

std::string StudyId(const Study& study) {
    uint64_t hash = 0xcbf29ce484222325;  // FNV-1a, 64 bits (Fowler, Noll, Vo)
    const auto add = [&](const auto* values, size_t count) {
        for (const std::byte b : std::as_bytes(std::span(values, count)))
            hash = (hash ^ uint64_t(b)) * 0x100000001b3;
    };
    add(study.viewpoint.c_str(), study.viewpoint.size() + 1);
    add(study.levels.data(), study.levels.size());
    for (const StudyBlock& block : study.blocks) {
        for (const Vec2i& corner : {block.pixels.min, block.pixels.max}) add(corner.data(), 2);
        for (const DisplayPixels& picture : block.pictures) add(picture.data(), picture.size());
    }
    return fmt::format("{:016x}", hash);
}

double NoiseOf(const StudyBlock& block, size_t level) {
    const std::vector<double> picture = LightnessOfCodes(block.pictures.at(level)),
                              reference = LightnessOfCodes(block.pictures.back());
    double sum = 0;
    for (size_t i = 0; i < picture.size(); ++i)
        sum += (picture[i] - reference[i]) * (picture[i] - reference[i]);
    return picture.empty() ? 0 : std::sqrt(sum / double(picture.size()));
}

Study BeginStudy(const std::string& viewpoint, const PixelRect& region, std::vector<int> levels,
                 const std::vector<Block>& blocks, const RenderIdentity& identity) {
    Study study{.viewpoint = viewpoint,
                .width = region.Width(),
                .height = region.Height(),
                .levels = std::move(levels),
                .blocks = {},
                .provenance = identity};
    for (const Block& block : blocks)
        study.blocks.push_back(
            {{block.pixels.min - region.min, block.pixels.max - region.min}, {}});
    return study;
}

RenderResult RenderStudy(RenderOptions options, Study* study, ViewpointRecording* viewpoint) {
    const ScheduleOptions& schedule = options.schedule;
    std::vector<BlockRecording> recordings(study->blocks.size());
    options.makeCriterion = [&](const BlockInfo& info) {
        const size_t i = size_t(info.index);
        std::unique_ptr<Criterion> recorder;
        if (viewpoint)
            recorder = std::make_unique<BlockRecorder>(schedule.passLength, schedule.cap,
                                                       schedule.cap, &recordings[i]);
        return std::make_unique<PictureLadder>(study->levels, std::move(recorder),
                                               &study->blocks[i].pictures);
    };
    RenderResult result = Render(options);
    if (result.cancelled || !viewpoint) return result;
    for (size_t i = 0; i < recordings.size(); ++i)
        AddBlock(i, std::move(recordings[i]), result.blocks[i], viewpoint);
    return result;
}

namespace {

constexpr uint32_t kLadderTag = 0x3152444c;  // "LDR1"

}  // namespace

std::vector<int> LadderByRatio(int pass, int cap, double ratio) {
    if (pass < 1 || cap < 1 || !(ratio > 1))
        throw std::invalid_argument("a ladder needs passes, a cap and a ratio above 1");
    std::vector<int> levels;
    // Levels less than half a step below the cap are left out.
    for (int spp = pass; spp * std::sqrt(ratio) <= cap && spp < cap;) {
        levels.push_back(spp);
        const double passes = std::round(spp * ratio / pass);
        spp = int(std::min(std::max(double(pass) * passes, double(spp) + pass), double(cap)));
    }
    levels.push_back(cap);
    return levels;
}

std::vector<int> LadderByCount(int pass, int cap, int count) {
    if (pass < 1 || cap < 1 || count < 2)
        throw std::invalid_argument("a ladder needs passes, a cap and two levels");
    std::vector<int> levels;
    const double span = std::max(1.0, double(cap) / pass);
    for (int i = 0; i + 1 < count; ++i) {
        const double spp = pass * std::round(std::pow(span, double(i) / (count - 1)));
        const int next = int(std::max(spp, levels.empty() ? 0.0 : double(levels.back()) + pass));
        if (next >= cap) break;
        levels.push_back(next);
    }
    levels.push_back(cap);
    return levels;
}

PictureLadder::PictureLadder(std::vector<int> levels, std::unique_ptr<Criterion> companion,
                             std::vector<DisplayPixels>* pictures)
    : levels(std::move(levels)), companion(std::move(companion)), pictures(pictures) {
    pictures->clear();
}

bool PictureLadder::IsLevel(int spp) const { return std::ranges::binary_search(levels, spp); }

ViewNeed PictureLadder::Need(int spp) const {
    const ViewNeed own = IsLevel(spp) ? ViewNeed::Mean : ViewNeed::Nothing;
    return companion ? std::max(own, companion->Need(spp)) : own;
}

Decision PictureLadder::Observe(const BlockView& view) {
    if (IsLevel(view.spp)) {
        CheckView(view, ViewNeed::Mean);
        EncodeSrgb8(view.mean, pictures->emplace_back(view.mean.size()));
    }
    if (companion) companion->Observe(view);
    return {.stop = view.spp >= levels.back(),
            .value = double(view.spp),
            .threshold = double(levels.back())};
}

std::vector<std::byte> PictureLadder::Save() const {
    StateWriter writer;
    writer.Put(kLadderTag);
    writer.Put(uint64_t(pictures->size()));
    for (const DisplayPixels& picture : *pictures) writer.PutVector(picture);
    writer.Put(uint8_t(companion != nullptr));
    if (companion) writer.PutAll<std::byte>(companion->Save());
    return std::move(writer.bytes);
}

void PictureLadder::Restore(std::span<const std::byte> state) {
    StateReader reader(state);
    reader.Expect(kLadderTag);
    pictures->clear();
    const auto count = reader.Get<uint64_t>();
    if (count > levels.size()) throw std::runtime_error("the saved pictures are of another ladder");
    for (uint64_t i = 0; i < count; ++i)
        pictures->push_back(reader.GetVector<uint8_t>("the saved pictures are damaged"));
    if (reader.Get<uint8_t>() != uint8_t(companion != nullptr))
        throw std::runtime_error("the saved pictures were made with another companion");
    if (companion)
        companion->Restore(state.last(reader.Left()));
    else
        reader.Finish();
}

// Makes a study of the pictures of another renderer.

namespace {

std::vector<int> ChooseLevels(const std::vector<int>& available, int count, double ratio) {
    const int low = available.front(), cap = available.back();
    std::vector<double> wanted;
    const double span = std::log(double(cap) / low);
    const int steps = count > 0 ? count - 1 : std::max(1, int(std::round(span / std::log(ratio))));
    for (int i = 0; i <= steps; ++i) wanted.push_back(std::log(low) + span * i / steps);
    std::vector<int> levels;
    for (const double w : wanted) {
        const int nearest = *std::ranges::min_element(
            available, {}, [&](int spp) { return std::abs(std::log(double(spp)) - w); });
        if (levels.empty() || levels.back() < nearest) levels.push_back(nearest);
    }
    return levels;
}

}  // namespace

Study MakeStudy(const PictureFolder& folder, int blockSize, int count, double ratio) {
    if (folder.files.size() < 2)
        throw Error(folder.files.begin()->second +
                    ": is the only picture of its folder; a study needs two at least");
    Study study{.viewpoint = folder.name, .width = folder.width, .height = folder.height};
    study.levels = ChooseLevels(folder.Spp(), count, ratio);
    study.provenance["renderer"] = "another";
    for (const Block& block : MakeBlocks(folder.Region(), {.blockSize = blockSize}))
        study.blocks.push_back({block.pixels, {}});
    for (const int spp : study.levels) {
        const RgbImage picture = ReadPicture(folder, spp);
        DisplayPixels shown(picture.values.size());
        EncodeSrgb8(picture.values, shown);
        for (StudyBlock& block : study.blocks)
            block.pictures.push_back(CutPixels(shown, folder.width, block.pixels));
    }
    return study;
}

}  // namespace lull
