// Records the measurements of a block that stopping rules need, pass by pass, so that rules can be
// trained and judged without rendering again.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stopping/rules/baselines.h"
#include "stopping/signals/attributes26.h"

namespace lull {

// The spp at which the human thresholds end: observers were shown no more.
inline constexpr int kMostShownSpp = 10000;

// The thresholds at which the rule `cycles`, which remembers pixels, runs along in recordings.
inline constexpr std::array<double, 13> kCyclesThresholds = {
    0.64, 0.32, 0.16, 0.08, 0.06, 0.04, 0.03, 0.02, 0.015, 0.01, 0.0075, 0.005, 0.0025};

// Names numbers that are recorded of a block: one for each of `count` sub-blocks, row-major, or, of
// the whole block, one or a list.
struct Channel {
    std::string_view name;
    int count;
    bool optional = false;  // some blocks do not have it: older ones, or pictures (AddPicture())
};

// All of them in the order in which a record has them. h4 ... h400 are SVD-entropies of the
// lightness L of the display image, h1 and h2 their parts at m = 100 (svd_entropy.h); lightness and
// deviation are mean and standard deviation of L; texture is the mean of t, and noise,
// masked_noise, half_noise and peak_noise are defined in lightness_noise.h. dammertz and luxtile
// are the errors of those rules (baselines.h). attributes26 is ComputeAttributes() of L. Those from
// noise to luxtile compare the mean with a half of the samples.
inline constexpr std::array<Channel, 16> kChannels = {{{"h4", 4},
                                                       {"h25", 25},
                                                       {"h100", 100},
                                                       {"h400", 400},
                                                       {"h1", 100},
                                                       {"h2", 100},
                                                       {"lightness", 100},
                                                       {"deviation", 100},
                                                       {"texture", 100},
                                                       {"noise", 100, true},
                                                       {"masked_noise", 100, true},
                                                       {"half_noise", 100, true},
                                                       {"peak_noise", 100, true},
                                                       {"dammertz", 1, true},
                                                       {"luxtile", 1, true},
                                                       {"attributes26", kAttributes, true}}};

// Returns which of kChannels it is, the place of its first number in a record, or how many there
// are. Each throws std::invalid_argument for a name that there is not.
size_t ChannelIndex(std::string_view name);
int ChannelOffset(std::string_view name);
int ChannelCount(std::string_view name);
inline constexpr int kRecordLength = [] {
    int length = 0;
    for (const Channel& channel : kChannels) length += channel.count;
    return length;
}();

struct BlockRecording {
    std::vector<int> spp;       // of the records, increasing
    std::vector<float> values;  // kRecordLength for each of them, 0 in channels that are absent
    std::bitset<kChannels.size()> absent;  // which of kChannels this block does not have
    // spp at which `cycles` stopped at each of kCyclesThresholds; 0: not within the recording.
    std::array<int, kCyclesThresholds.size()> cyclesStops = {};

    int Count() const { return int(spp.size()); }
    // Returns a channel's numbers in record i. Throws std::invalid_argument for one not there.
    std::span<const float> Values(int i, std::string_view channel) const;
};

// Adds the record of a picture of which no half of the samples is known, with increasing spp; only
// the mean is read. Channels that compare halves are absent. The block must have at least 20 x 20
// pixels. Throws std::invalid_argument as CheckView() does, or if the recording has halves.
void AddPicture(const BlockView& view, BlockRecording* recording);

// Returns whether a block was recorded with a half of its samples, or has no record yet.
bool HasHalves(const BlockRecording& recording);

// Returns whether a pass is recorded: up to 400 spp all, then every second one, and the last.
bool IsRecorded(int spp, int passSpp, int cap);

// Records and never votes: "stops" the block at the first pass at or beyond `limit` spp. Blocks
// must have at least 20 x 20 pixels. Records go to `recording`, which must outlive it.
class BlockRecorder final : public Criterion {
  public:
    BlockRecorder(int passSpp, int cap, int limit, BlockRecording* recording);
    ~BlockRecorder() override;

    ViewNeed Need(int) const override { return ViewNeed::MeanAndHalf; }
    Decision Observe(const BlockView& view) override;
    std::vector<std::byte> Save() const override;
    void Restore(std::span<const std::byte> state) override;

  private:
    void StartCycles();

    int passSpp, cap, limit;
    BlockRecording* recording;
    std::vector<std::unique_ptr<Criterion>> cycles;  // null where it has stopped
};

// Reads and writes data sets: HDF5 files of recordings, a group a viewpoint, a group a block in it.

struct ViewpointRecording {
    std::string name;
    int blockCount = 0;  // in the whole image
    int cap = 0;         // spp at which recordings end at the latest
    int passSpp = 0;     // samples per pixel and pass; 0: records come at any spp
    // Origin of the recordings: scene, its hash, resolution, sampler, ...
    std::map<std::string, std::string> provenance;
    std::map<int, BlockRecording> blocks;   // by row-major number; others are absent
    std::map<int, std::string> blockNotes;  // cost of each recording
};

// Reads all viewpoints of a file. Blocks may lack optional channels, each by itself. Throws
// std::runtime_error beginning with the file's name.
std::vector<ViewpointRecording> ReadDataset(const std::string& path);

// Returns the bytes of a data set file. Statistics are rounded to 12 significant bits, entropies
// and attributes to 19, which compresses them to half their size.
std::vector<std::byte> EncodeDataset(std::span<const ViewpointRecording> viewpoints);

// Adds the blocks of a viewpoint, replacing existing ones; a new viewpoint if there was none of
// that name. Throws std::runtime_error with the difference if there is one that was recorded in
// another way (provenance, cap, passes, number of blocks).
void AddToDataset(const ViewpointRecording& added, std::vector<ViewpointRecording>* viewpoints);

}  // namespace lull
