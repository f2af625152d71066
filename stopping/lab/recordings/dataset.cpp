#include "stopping/lab/recordings/dataset.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "stopping/base/hdf5_file.h"

namespace lull {

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
