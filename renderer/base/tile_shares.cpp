#include "renderer/base/tile_shares.h"

namespace lull {

namespace {

constexpr int kWhole = TileShares::kWhole;

// Fills in running sums that end in kWhole: a unit for each positive weight, the rest by weight.
template <size_t N>
void FillIn(std::span<const float> weights, std::array<uint16_t, N>* sums) {
    double total = 0;
    int positive = 0;
    for (const float w : weights) {
        total += double(w);
        positive += w > 0;
    }
    if (positive == 0) {
        sums->fill(uint16_t(kWhole));
        return;
    }
    double running = 0;
    int units = 0;
    for (size_t i = 0; i < N; ++i) {
        running += double(weights[i]);
        units += weights[i] > 0;
        const double part = std::min(1., running / total) * (kWhole - positive);
        (*sums)[i] = uint16_t(units + int(part + 0.5));
    }
}

template <size_t N>
bool AreSums(const std::array<uint16_t, N>& sums) {
    return std::is_sorted(sums.begin(), sums.end()) && sums.back() == kWhole;
}

}  // namespace

TileShares::TileShares(std::span<const float> weights) {
    std::array<float, kBands> ofBands = {};
    for (size_t b = 0; b < kBands; ++b) {
        const auto band = weights.subspan(b * kColumns, kColumns);
        for (const float w : band) ofBands[b] += w;
        FillIn(band, &columns[b]);
    }
    FillIn(ofBands, &bands);
}

bool IsValid(const TileShares& shares) {
    return AreSums(shares.bands) && std::all_of(shares.columns.begin(), shares.columns.end(),
                                                [](const auto& sums) { return AreSums(sums); });
}

}  // namespace lull
