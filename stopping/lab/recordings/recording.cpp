#include "stopping/lab/recordings/recording.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

#include "stopping/base/hdf5_file.h"
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

namespace {

constexpr const char* kFormat = "lull data set 1";

// Rounds to `bits` significant bits; the others compress to nothing.
float RoundBits(float value, int bits) {
    const int dropped = 24 - bits;
    const uint32_t half = 1u << (dropped - 1), mask = (1u << dropped) - 1;
    return std::bit_cast<float>((std::bit_cast<uint32_t>(value) + half) & ~mask);
}

// Channels that are normalised over a window need more bits.
int SignificantBits(const Channel& channel) {
    const bool isEntropy =
        channel.name.starts_with('h') && channel.count > 1 && channel.name != "half_noise";
    return isEntropy || channel.name == "attributes26" ? 19 : 12;
}

std::string BlockName(int block) {
    return (block < 10 ? "block_0" : "block_") + std::to_string(block);
}

int BlockNumber(const std::string& name) {
    int number = -1;
    if (name.starts_with("block_"))
        std::from_chars(name.data() + 6, name.data() + name.size(), number);
    if (number < 0) throw std::runtime_error("the group '" + name + "' is not a block");
    return number;
}

void WriteBlock(const BlockRecording& block, Hdf5Group group) {
    const int64_t count = block.Count();
    const std::vector<int32_t> spp(block.spp.begin(), block.spp.end());
    group.AddArray<int32_t>("spp", std::array{count}, spp);
    const std::vector<int32_t> stops(block.cyclesStops.begin(), block.cyclesStops.end());
    group.AddArray<int32_t>("cycles_stops", std::array{int64_t(stops.size())}, stops);
    for (const Channel& channel : kChannels) {
        if (block.absent[ChannelIndex(channel.name)]) continue;
        std::vector<float> values;
        for (int i = 0; i < block.Count(); ++i)
            for (const float v : block.Values(i, channel.name))
                values.push_back(RoundBits(v, SignificantBits(channel)));
        group.AddArray<float>(std::string(channel.name), std::array{count, int64_t(channel.count)},
                              values, Hdf5Storage::Compressed);
    }
}

BlockRecording ReadBlock(const Hdf5Group& group) {
    BlockRecording block;
    const std::vector<int64_t> shape = group.Shape("spp");
    if (shape.size() != 1) throw std::runtime_error("'spp' is not a list");
    const std::vector<int32_t> spp = group.Array<int32_t>("spp", shape);
    block.spp.assign(spp.begin(), spp.end());
    if (std::ranges::adjacent_find(spp, std::greater_equal<>()) != spp.end())
        throw std::runtime_error("'spp' does not increase");
    const std::vector<int32_t> stops =
        group.Array<int32_t>("cycles_stops", std::array{int64_t(kCyclesThresholds.size())});
    std::ranges::copy(stops, block.cyclesStops.begin());

    block.values.resize(spp.size() * kRecordLength);
    for (const Channel& channel : kChannels) {
        if (channel.optional && !group.Has(std::string(channel.name))) {
            block.absent.set(ChannelIndex(channel.name));
            continue;
        }
        const std::vector<float> values = group.Array<float>(
            std::string(channel.name), std::array{shape[0], int64_t(channel.count)});
        const size_t offset = size_t(ChannelOffset(channel.name));
        for (size_t i = 0; i < spp.size(); ++i)
            std::copy_n(&values[i * size_t(channel.count)], channel.count,
                        &block.values[i * kRecordLength + offset]);
    }
    if (!std::ranges::all_of(block.values, [](float v) { return std::isfinite(v); }))
        throw std::runtime_error("a recorded value is not finite");
    return block;
}

ViewpointRecording ReadViewpoint(const std::string& name, const Hdf5Group& group) {
    ViewpointRecording viewpoint;
    viewpoint.name = name;
    viewpoint.blockCount = group.Int("block_count");
    viewpoint.cap = group.Int("cap");
    viewpoint.passSpp = group.Int("pass");
    const std::vector<std::string> provenance =
        group.HasAttribute("provenance") ? group.Strings("provenance") : std::vector<std::string>();
    for (const std::string& entry : provenance) {
        const size_t equals = entry.find('=');
        if (equals == std::string::npos) throw std::runtime_error("'provenance' is damaged");
        viewpoint.provenance[entry.substr(0, equals)] = entry.substr(equals + 1);
    }
    for (const std::string& blockName : group.Groups()) {
        const int number = BlockNumber(blockName);
        if (number >= viewpoint.blockCount)
            throw std::runtime_error("there are fewer blocks than '" + blockName + "' says");
        const Hdf5Group block = group.Group(blockName);
        viewpoint.blocks[number] = ReadBlock(block);
        viewpoint.blockNotes[number] = block.String("note");
    }
    return viewpoint;
}

}  // namespace

std::vector<ViewpointRecording> ReadDataset(const std::string& path) try {
    const Hdf5Group root = Hdf5Group::Open(path);
    if (!root.HasAttribute("format") || root.String("format") != kFormat)
        throw std::runtime_error("it is not a data set of lull");
    std::vector<ViewpointRecording> viewpoints;
    for (const std::string& name : root.Groups())
        viewpoints.push_back(ReadViewpoint(name, root.Group(name)));
    return viewpoints;
} catch (const std::runtime_error& e) {
    throw std::runtime_error(path + ": " + e.what());
}

std::vector<std::byte> EncodeDataset(std::span<const ViewpointRecording> viewpoints) {
    Hdf5Group root = Hdf5Group::CreateInMemory();
    root.SetString("format", kFormat);
    for (const ViewpointRecording& viewpoint : viewpoints) {
        Hdf5Group group = root.MakeGroup(viewpoint.name);
        group.SetInt("block_count", viewpoint.blockCount);
        group.SetInt("cap", viewpoint.cap);
        group.SetInt("pass", viewpoint.passSpp);
        std::vector<std::string> provenance;
        for (const auto& [key, value] : viewpoint.provenance)
            provenance.push_back(key + "=" + value);
        if (!provenance.empty()) group.SetStrings("provenance", provenance);
        for (const auto& [number, block] : viewpoint.blocks) {
            Hdf5Group blockGroup = group.MakeGroup(BlockName(number));
            WriteBlock(block, blockGroup);
            const auto note = viewpoint.blockNotes.find(number);
            blockGroup.SetString("note", note == viewpoint.blockNotes.end() ? "" : note->second);
        }
    }
    const auto content = root.Content();
    return {content.begin(), content.end()};
}

void AddToDataset(const ViewpointRecording& added, std::vector<ViewpointRecording>* viewpoints) {
    const auto old = std::ranges::find(*viewpoints, added.name, &ViewpointRecording::name);
    if (old == viewpoints->end()) {
        viewpoints->push_back(added);
        return;
    }
    const auto require = [&](bool same, const std::string& what) {
        if (!same)
            throw std::runtime_error("'" + added.name + "' is already recorded with another " +
                                     what);
    };
    require(old->blockCount == added.blockCount, "number of blocks");
    require(old->cap == added.cap, "cap");
    require(old->passSpp == added.passSpp, "pass");
    for (const auto& [key, value] : added.provenance) {
        const auto it = old->provenance.find(key);
        require(it != old->provenance.end() && it->second == value,
                key + " (" + (it == old->provenance.end() ? "none" : it->second) + ", now " +
                    value + ")");
    }
    for (const auto& [number, block] : added.blocks) {
        old->blocks[number] = block;
        old->blockNotes[number] =
            added.blockNotes.contains(number) ? added.blockNotes.at(number) : std::string();
    }
}

}  // namespace lull
