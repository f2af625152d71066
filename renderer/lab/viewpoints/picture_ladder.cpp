#include "renderer/lab/viewpoints/picture_ladder.h"

#include <algorithm>
#include <cmath>

#include "stopping/base/state.h"
#include "stopping/signals/lightness.h"

namespace lull {

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

}  // namespace lull
