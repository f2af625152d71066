#include "stopping/lab/recordings/extension.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "stopping/base/parallel.h"

namespace lull {

namespace {

constexpr double kDoublings = 2;  // that laws are fitted to

// How a number goes with the samples: power(value) = A + b n^exponent, where A can be 0.
struct Law {
    double exponent = 0;  // 0: constant
    bool hasLevel = true;
    bool isSquared = false;  // the square of the value follows the law

    double In(double value) const { return isSquared ? value * value : value; }
    double Out(double value) const { return isSquared ? std::sqrt(std::max(0.0, value)) : value; }
    double Abscissa(double spp) const { return std::pow(spp, exponent); }
};

constexpr Law kEntropyLaw{.exponent = -0.9};
constexpr Law kNoiseLaw{.exponent = -0.5, .hasLevel = false};
constexpr Law kDeviationLaw{.exponent = -1, .isSquared = true};
constexpr Law kFilteredLaw{.exponent = -0.5};  // of filters, which take out noise and more
constexpr Law kConstant{};

Law LawOf(std::string_view channel) {
    for (const char* name : {"h4", "h25", "h100", "h400", "h1", "h2"})
        if (channel == name) return kEntropyLaw;
    for (const char* name :
         {"noise", "masked_noise", "half_noise", "peak_noise", "dammertz", "luxtile"})
        if (channel == name) return kNoiseLaw;
    if (channel == "deviation" || channel == "texture") return kDeviationLaw;
    return channel == "attributes26" ? kFilteredLaw : kConstant;
}

struct Fit {
    Law law;
    double level = 0, slope = 0;

    float At(int spp) const { return float(law.Out(level + slope * law.Abscissa(spp))); }
};

Fit FitLaw(const BlockRecording& recording, size_t first, size_t number, const Law& law) {
    const auto valueOf = [&](size_t i) {
        return law.In(recording.values[i * size_t(kRecordLength) + number]);
    };
    const size_t count = recording.spp.size();
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (size_t i = first; i < count; ++i) {
        const double at = law.Abscissa(recording.spp[i]), value = valueOf(i);
        n += 1;
        x += at;
        y += value;
        xx += at * at;
        xy += at * value;
    }
    Fit fit{.law = law};
    if (law.exponent == 0) {
        fit.level = y / n;
    } else if (!law.hasLevel) {
        fit.slope = xy / xx;
    } else {
        const double spread = xx - x * x / n;
        fit.slope = spread > 0 ? (xy - x * y / n) / spread : 0;
        fit.level = valueOf(count - 1) - fit.slope * law.Abscissa(recording.spp[count - 1]);
    }
    return fit;
}

std::vector<Fit> FitAll(const BlockRecording& recording) {
    const double begin = recording.spp.back() / std::exp2(kDoublings);
    const auto from = std::ranges::lower_bound(recording.spp, int(begin));
    const size_t count = recording.spp.size(), last = count - std::min(count, size_t(3));
    const size_t first = std::min(size_t(from - recording.spp.begin()), last);
    std::vector<Fit> fits;
    for (size_t c = 0; c < kChannels.size(); ++c)
        for (int i = 0; i < kChannels[c].count; ++i)
            fits.push_back(recording.absent[c]
                               ? Fit{}
                               : FitLaw(recording, first, fits.size(), LawOf(kChannels[c].name)));
    return fits;
}

void ExtendCycles(int last, int passSpp, int end, BlockRecording* recording) {
    double product = 0;  // T^2 n
    for (size_t i = 0; i < kCyclesThresholds.size(); ++i) {
        const double squared = kCyclesThresholds[i] * kCyclesThresholds[i];
        int& stop = recording->cyclesStops[i];
        if (stop > 0) product = squared * stop;
        if (stop > 0 || product == 0) continue;
        const double passes = std::ceil(product / squared / passSpp);
        const double spp = std::max(passes * passSpp, double(last) + passSpp);
        if (spp <= end) stop = int(spp);
    }
}

int LastStep(const BlockRecording& recording) {
    const size_t count = recording.spp.size();
    return count > 1 ? recording.spp[count - 1] - recording.spp[count - 2] : recording.spp[0];
}

}  // namespace

BlockRecording ExtendRecording(const BlockRecording& recording, int passSpp, int end) {
    if (recording.spp.empty()) throw std::invalid_argument("a recording has no passes");
    const std::vector<Fit> fits = FitAll(recording);
    BlockRecording extended = recording;
    const bool isAny = passSpp == 0;
    if (isAny) passSpp = LastStep(recording);
    const int last = recording.spp.back();
    for (int spp = isAny ? last + passSpp : (last / passSpp + 1) * passSpp; spp <= end;
         spp += passSpp) {
        if (!isAny && !IsRecorded(spp, passSpp, end)) continue;
        extended.spp.push_back(spp);
        for (const Fit& fit : fits) extended.values.push_back(fit.At(spp));
    }
    ExtendCycles(recording.spp.back(), passSpp, end, &extended);
    return extended;
}

ExtendedBlocks ExtendBlocks(std::span<const LabelledBlock> blocks) {
    ExtendedBlocks result{.recordings = {}, .blocks = {blocks.begin(), blocks.end()}};
    std::vector<LabelledBlock*> open;
    for (LabelledBlock& block : result.blocks)
        if (block.recording->spp.empty() || block.recording->spp.back() < kMostShownSpp)
            open.push_back(&block);
    result.recordings.resize(open.size());
    ForEachIndex(int(open.size()), [&](int i) {
        LabelledBlock& block = *open[size_t(i)];
        auto& recording = result.recordings[size_t(i)];
        recording = std::make_unique<const BlockRecording>(
            ExtendRecording(*block.recording, block.passSpp, kMostShownSpp));
        block.recording = recording.get();
    });
    return result;
}

}  // namespace lull
