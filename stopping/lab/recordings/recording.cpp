#include "stopping/lab/recordings/recording.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "stopping/base/state.h"
#include "stopping/signals/lightness.h"
#include "stopping/signals/lightness_noise.h"
#include "stopping/signals/svd_entropy.h"

namespace lull {

namespace {

constexpr uint32_t kRecorderTag = 0x31434552;  // "REC1"
constexpr int kAllPassesUntil = 400;           // spp
constexpr int kStatisticsSubBlocks = 100;
constexpr std::array<std::string_view, 6> kHalfChannels = {
    "noise", "masked_noise", "half_noise", "peak_noise", "dammertz", "luxtile"};

void Append(std::span<const float> from, std::vector<float>* to) {
    to->insert(to->end(), from.begin(), from.end());
}

// Appends the entropies h4 ... h400, h1 and h2.
void AppendEntropies(std::span<const double> lightness, int width, int height,
                     std::vector<float>* to) {
    std::vector<float> h1, h2;
    for (const int m : {4, 25, 100, 400})
        for (const SvdEntropy& e : SubBlockEntropies(lightness, width, height, m)) {
            to->push_back(float(e.h));
            if (m != kStatisticsSubBlocks) continue;
            h1.push_back(float(e.h1));
            h2.push_back(float(e.h2));
        }
    Append(h1, to);
    Append(h2, to);
}

// Computes a record: all channels in their order.
void AppendRecord(const BlockView& view, std::vector<float>* to) {
    const std::vector<double> lightness = LightnessOf(view.mean);
    AppendEntropies(lightness, view.width, view.height, to);
    const LightnessNoise noise = ComputeLightnessNoise(view);
    const LightnessNoiseStatistics s =
        SubBlockStatistics(noise, view.width, view.height, kStatisticsSubBlocks);
    for (const std::vector<float>* channel :
         {&s.lightness, &s.deviation, &s.texture, &s.noise, &s.maskedNoise, &s.halfNoise, &s.peak})
        Append(*channel, to);
    to->push_back(float(DammertzError(view)));
    to->push_back(float(LuxTileError(view)));
    for (const double v : ComputeAttributes(lightness, view.width, view.height))
        to->push_back(float(v));
}

}  // namespace

size_t ChannelIndex(std::string_view name) {
    const auto channel = std::ranges::find(kChannels, name, &Channel::name);
    if (channel == kChannels.end())
        throw std::invalid_argument("nothing called '" + std::string(name) + "' is recorded");
    return size_t(channel - kChannels.begin());
}

int ChannelOffset(std::string_view name) {
    int offset = 0;
    for (size_t i = 0; i < ChannelIndex(name); ++i) offset += kChannels[i].count;
    return offset;
}

int ChannelCount(std::string_view name) { return kChannels[ChannelIndex(name)].count; }

std::span<const float> BlockRecording::Values(int i, std::string_view channel) const {
    if (absent[ChannelIndex(channel)])
        throw std::invalid_argument(
            "a block was recorded without '" + std::string(channel) + "'" +
            (std::ranges::find(kHalfChannels, channel) != kHalfChannels.end()
                 ? ", which compares a half of the samples; pictures by themselves have none"
                 : ""));
    return std::span(values).subspan(size_t(i) * kRecordLength + size_t(ChannelOffset(channel)),
                                     size_t(ChannelCount(channel)));
}

void AddPicture(const BlockView& view, BlockRecording* recording) {
    CheckView(view, ViewNeed::Mean);
    if (recording->spp.empty())
        for (const std::string_view channel : kHalfChannels)
            recording->absent.set(ChannelIndex(channel));
    if (HasHalves(*recording))
        throw std::invalid_argument("a picture was added to a recording with halves");
    recording->spp.push_back(view.spp);
    // Compared with itself, measurements of halves are 0.
    BlockView same = view;
    same.halfMean = view.mean;
    AppendRecord(same, &recording->values);
}

bool HasHalves(const BlockRecording& recording) {
    return !recording.absent[ChannelIndex("half_noise")];
}

bool IsRecorded(int spp, int passSpp, int cap) {
    return spp <= kAllPassesUntil || (spp - passSpp) % (2 * passSpp) == 0 || spp >= cap;
}

BlockRecorder::BlockRecorder(int passSpp, int cap, int limit, BlockRecording* recording)
    : passSpp(passSpp), cap(cap), limit(limit), recording(recording) {
    StartCycles();
}
BlockRecorder::~BlockRecorder() = default;

void BlockRecorder::StartCycles() {
    cycles.clear();
    for (const double threshold : kCyclesThresholds)
        cycles.push_back(MakeCriterion(CyclesRule(threshold)));
}

Decision BlockRecorder::Observe(const BlockView& view) {
    CheckView(view, ViewNeed::MeanAndHalf);
    for (size_t i = 0; i < cycles.size(); ++i)
        if (cycles[i] && cycles[i]->Observe(view).stop) {
            recording->cyclesStops[i] = view.spp;
            cycles[i].reset();
        }
    const bool stop = view.spp >= limit;
    if (stop || IsRecorded(view.spp, passSpp, cap)) {
        recording->spp.push_back(view.spp);
        AppendRecord(view, &recording->values);
    }
    return {.stop = stop, .value = double(view.spp), .threshold = double(limit)};
}

std::vector<std::byte> BlockRecorder::Save() const {
    StateWriter writer;
    writer.Put(kRecorderTag);
    writer.Put(int32_t(kRecordLength));
    writer.Put(int32_t(recording->Count()));
    writer.PutAll<int>(recording->spp);
    writer.PutAll<float>(recording->values);
    writer.Put(recording->cyclesStops);
    for (const std::unique_ptr<Criterion>& criterion : cycles)
        writer.PutVector(criterion ? criterion->Save() : std::vector<std::byte>());
    return std::move(writer.bytes);
}

void BlockRecorder::Restore(std::span<const std::byte> state) {
    StateReader reader(state);
    reader.Expect(kRecorderTag);
    if (reader.Get<int32_t>() != kRecordLength)
        throw std::runtime_error(
            "the saved recording has other channels: it can be finished only by the version of "
            "lull that began it");
    const int32_t count = reader.Get<int32_t>();
    if (count < 0 || size_t(count) * kRecordLength * sizeof(float) > reader.Left())
        throw std::runtime_error("the saved recording is damaged");
    recording->spp.resize(size_t(count));
    recording->values.resize(size_t(count) * kRecordLength);
    reader.GetAll(std::span(recording->spp));
    reader.GetAll(std::span(recording->values));
    recording->cyclesStops = reader.Get<decltype(recording->cyclesStops)>();
    StartCycles();
    for (size_t i = 0; i < cycles.size(); ++i) {
        const auto bytes = reader.GetVector<std::byte>("the saved recording is damaged");
        if (recording->cyclesStops[i] > 0)
            cycles[i].reset();
        else
            cycles[i]->Restore(bytes);
    }
    reader.Finish();
}

}  // namespace lull
