#include "renderer/vision/visible_difference.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "renderer/base/error.h"
#include "renderer/base/math.h"

namespace lull {

namespace {

constexpr int kChannels = kOpponentChannels;
using Planes = std::array<Plane, kChannels>;
using Triple = std::array<double, kChannels>;

// The constants of ColorVideoVDP 0.5.6, calibrated by its authors.
constexpr double kDifferencePower = 2.264355182647705;                                      // p
constexpr Triple kMaskPower = {1.302622675895691, 2.8885908126831055, 3.6807713508605957};  // q
constexpr double kMaskGain = 0.160141;  // k = 10^-0.7954971
constexpr double kMaskSigma = 3;        // pixels of a band
constexpr Triple kChannelGain = {1, 1.45, 1};
constexpr double kLargest = 366.645;             // 10^2.5642455
constexpr double kSensitivityFactor = 0.968307;  // -0.2797423 dB
constexpr Triple kBaseWeight = {0.0036334486, 1.6627724, 4.1187453};
constexpr double kStillWeight = 0.577918291;
constexpr double kPatchArea = std::numbers::pi * 1.5 * 1.5;    // square degrees
constexpr double kLeastFrequency = 0.2, kBaseFrequency = 0.1;  // cycles per degree
constexpr double kLeastLuminance = 0.01;                       // cd/m2
constexpr double kLargestContrast = 1000;
// How much each channel (row) masks each (column), as powers of 2.
constexpr double kMaskedBy[kChannels][kChannels] = {{-0.189501047, -5.962151051, -4.318346024},
                                                    {2.565559387, 0.344067127, -2.719646454},
                                                    {3.811837196, -1.005170584, -0.519337654}};

// Rec. 709 to XYZ, XYZ to the cones of the CIE (2006), these to opponent channels of which all are
// relative to daylight: luminance, L - M and S - (L + M) (Derrington, Krauskopf, Lennie: Chromatic
// mechanisms in lateral geniculate nucleus of macaque, J. Physiol. 357, 1984).
using Matrix = std::array<Triple, 3>;
constexpr Matrix kXyzFromRgb = {{{0.4124564, 0.3575761, 0.1804375},
                                 {0.2126729, 0.7151522, 0.0721750},
                                 {0.0193339, 0.1191920, 0.9503041}}};
constexpr Matrix kConesFromXyz = {{{0.187596268556126, 0.585168649077728, -0.026384263306304},
                                   {-0.133397430663221, 0.405505777260049, 0.034502127690364},
                                   {0.000244379021663, -0.000542995890619, 0.019406849066323}}};
constexpr Matrix kOpponentFromCones = {
    {{1, 1, 0}, {1, -2.311130179947035, 0}, {-1, -1, 50.977571328718781}}};

constexpr Matrix Product(const Matrix& a, const Matrix& b) {
    Matrix product = {};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k) product[i][j] += a[i][k] * b[k][j];
    return product;
}
constexpr Matrix kOpponentFromRgb =
    Product(kOpponentFromCones, Product(kConesFromXyz, kXyzFromRgb));

Planes OpponentPlanes(std::span<const float> linear, int width, int height,
                      const DisplayModel& display) {
    const std::vector<float> light = DisplayedLight(linear, display);
    Planes planes;
    for (int c = 0; c < kChannels; ++c) {
        planes[c] = {width, height, std::vector<float>(light.size() / 3)};
        const Triple& m = kOpponentFromRgb[c];
        for (size_t i = 0; i < planes[c].values.size(); ++i)
            planes[c].values[i] =
                float(m[0] * double(light[3 * i]) + m[1] * double(light[3 * i + 1]) +
                      m[2] * double(light[3 * i + 2]));
    }
    return planes;
}

// Returns the frequencies of the bands: of the finest, of those whose peak is at 0.3228 of the
// sampling limit of their level, down to 0.2 cycles a degree, and of the rest.
std::vector<double> BandFrequencies(int width, int height, double pixelsPerDegree) {
    const int side = std::min(width, height);
    std::vector<double> frequencies;
    double frequency = pixelsPerDegree / 2;
    for (int level = 0; (side >> level) >= 4; ++level) {
        frequencies.push_back(frequency);
        if (frequency <= kLeastFrequency) break;
        frequency = level == 0 ? 0.3228 * pixelsPerDegree / 2 : frequency / 2;
    }
    frequencies.push_back(kBaseFrequency);
    return frequencies;
}

class SensitivityCurve {
  public:
    SensitivityCurve(OpponentChannel channel, double frequency) {
        for (size_t i = 0; i < values.size(); ++i)
            values[i] =
                float(kSensitivityFactor *
                      ContrastSensitivity(
                          channel, {.frequency = frequency,
                                    .area = kPatchArea,
                                    .luminance = std::exp2(kFrom + double(i) / kStepsPerOctave)}));
    }
    float At(float log2Luminance) const {
        const float x =
            std::clamp((log2Luminance - kFrom) * kStepsPerOctave, 0.f, float(values.size() - 2));
        const size_t i = size_t(x);
        return values[i] + (x - float(i)) * (values[i + 1] - values[i]);
    }

  private:
    static constexpr int kFrom = -7, kTo = 18, kStepsPerOctave = 16;  // log2 of cd/m2
    std::array<float, size_t((kTo - kFrom) * kStepsPerOctave + 2)> values = {};
};

// Contrasts relative to the luminance around, and that luminance.
struct ContrastBand {
    Planes contrast;
    std::vector<float> luminance;
};

// Divides the detail missing from the next level by its luminance, and leaves that level in
// `planes`. Inner bands are twice as high, as their kernel halves a grating.
ContrastBand TakeBand(int level, Planes* planes) {
    ContrastBand band;
    Planes next;
    for (int c = 0; c < kChannels; ++c) {
        Plane& plane = (*planes)[c];
        next[c] = Reduce(plane);
        const Plane around = Expand(next[c], plane.width, plane.height);
        if (c == 0)
            for (const float v : around.values)
                band.luminance.push_back(std::max(v, float(kLeastLuminance)));
        for (size_t i = 0; i < plane.values.size(); ++i)
            plane.values[i] = (level == 0 ? 1.f : 2.f) *
                              std::min((plane.values[i] - around.values[i]) / band.luminance[i],
                                       float(kLargestContrast));
        band.contrast[c] = std::move(plane);
    }
    *planes = std::move(next);
    return band;
}

ContrastBand TakeBase(Planes planes) {
    double sum = 0;
    for (const float v : planes[0].values) sum += std::max(double(v), kLeastLuminance);
    const float mean = float(sum / double(planes[0].values.size()));
    for (Plane& plane : planes)
        for (float& v : plane.values) v = std::min(v / mean, float(kLargestContrast));
    return {std::move(planes), std::vector<float>(planes[0].values.size(), mean)};
}

Planes SensitivityPlanes(double frequency, int width, int height,
                         const std::vector<float>& luminance) {
    const std::array<SensitivityCurve, kChannels> curves = {
        SensitivityCurve(OpponentChannel::Achromatic, frequency),
        SensitivityCurve(OpponentChannel::RedGreen, frequency),
        SensitivityCurve(OpponentChannel::YellowViolet, frequency)};
    Planes planes;
    for (Plane& plane : planes) plane = {width, height, std::vector<float>(luminance.size())};
    for (size_t i = 0; i < luminance.size(); ++i) {
        const float log2Luminance = std::log2(luminance[i]);
        for (int c = 0; c < kChannels; ++c) planes[c].values[i] = curves[c].At(log2Luminance);
    }
    return planes;
}

void ToThresholds(const Planes& sensitivity, Planes* contrast) {
    for (int c = 0; c < kChannels; ++c)
        for (size_t i = 0; i < sensitivity[c].values.size(); ++i)
            (*contrast)[c].values[i] *= sensitivity[c].values[i];
}

float PowerOf(float base, double exponent) {
    return base > 0 ? std::pow(base, float(exponent)) : 0;
}

Planes Masks(const Planes& image, const Planes& reference) {
    const int width = image[0].width, height = image[0].height;
    const std::vector<double> around = GaussianKernel(kMaskSigma, int(2 * kMaskSigma));
    Planes masks;
    for (Plane& mask : masks) mask = {width, height, std::vector<float>(image[0].values.size())};
    for (int from = 0; from < kChannels; ++from) {
        std::vector<float> common(image[from].values.size());
        for (size_t i = 0; i < common.size(); ++i)
            common[i] =
                std::min(std::abs(image[from].values[i]), std::abs(reference[from].values[i]));
        common = Convolve(common, width, height, around, around);
        for (float& v : common) v = PowerOf(float(kMaskGain) * v, kMaskPower[from]);
        for (int to = 0; to < kChannels; ++to) {
            const float weight = float(std::exp2(kMaskedBy[from][to]));
            for (size_t i = 0; i < common.size(); ++i) masks[to].values[i] += weight * common[i];
        }
    }
    return masks;
}

Planes MaskedDifference(Planes image, Planes reference) {
    for (int c = 0; c < kChannels; ++c)
        for (Planes* planes : {&image, &reference})
            for (float& v : (*planes)[c].values) v *= float(kChannelGain[c]);
    const Planes masks = Masks(image, reference);
    for (int c = 0; c < kChannels; ++c)
        for (size_t i = 0; i < image[c].values.size(); ++i) {
            float& v = image[c].values[i];
            v = PowerOf(std::abs(v - reference[c].values[i]), kDifferencePower) /
                (1 + masks[c].values[i]);
            v *= float(kLargest) / (float(kLargest) + v);
        }
    return image;
}

Planes BaseDifference(Planes image, const Planes& reference) {
    for (int c = 0; c < kChannels; ++c)
        for (size_t i = 0; i < image[c].values.size(); ++i)
            image[c].values[i] =
                float(kBaseWeight[c]) * std::abs(image[c].values[i] - reference[c].values[i]);
    return image;
}

void CheckSize(std::span<const float> picture, int width, int height) {
    const size_t size = 3 * size_t(std::max(width, 0)) * size_t(std::max(height, 0));
    if (size == 0 || picture.size() != size)
        throw Error("visible difference: pictures of one size, not empty, are needed");
}

std::vector<double> Shares(int level, int size, int begin, int end) {
    const double side = std::exp2(level);
    std::vector<double> shares;
    for (int i = 0; i < size; ++i) {
        // Cell i is centred at pixel i * side; the outermost reach as far as the picture.
        const double low = i == 0 ? begin : (i - 0.5) * side + 0.5;
        const double high = i == size - 1 ? end : (i + 0.5) * side + 0.5;
        shares.push_back(std::max(0.0, std::min<double>(high, end) - std::max<double>(low, begin)));
    }
    return shares;
}

}  // namespace

VisibleReference PrepareReference(std::span<const float> reference, int width, int height,
                                  const DisplayModel& display) {
    CheckSize(reference, width, height);
    VisibleReference result{width, height, display, {}};
    Planes planes = OpponentPlanes(reference, width, height, display);
    const std::vector<double> frequencies = BandFrequencies(width, height, display.pixelsPerDegree);
    for (size_t level = 0; level < frequencies.size(); ++level) {
        const bool isBase = level + 1 == frequencies.size();
        ContrastBand band = isBase ? TakeBase(std::move(planes)) : TakeBand(int(level), &planes);
        const Plane& first = band.contrast[0];
        Planes sensitivity =
            SensitivityPlanes(frequencies[level], first.width, first.height, band.luminance);
        ToThresholds(sensitivity, &band.contrast);
        result.bands.push_back(
            {frequencies[level], std::move(band.contrast), std::move(sensitivity)});
    }
    return result;
}

VisibleDifference FindVisibleDifference(std::span<const float> image,
                                        const VisibleReference& reference) {
    CheckSize(image, reference.width, reference.height);
    VisibleDifference result{reference.width, reference.height, {}};
    Planes planes = OpponentPlanes(image, reference.width, reference.height, reference.display);
    for (size_t level = 0; level < reference.bands.size(); ++level) {
        const ReferenceBand& band = reference.bands[level];
        const bool isBase = level + 1 == reference.bands.size();
        Planes contrast =
            isBase ? TakeBase(std::move(planes)).contrast : TakeBand(int(level), &planes).contrast;
        ToThresholds(band.sensitivity, &contrast);
        result.bands.push_back({band.frequency, int(level),
                                isBase ? BaseDifference(std::move(contrast), band.contrast)
                                       : MaskedDifference(std::move(contrast), band.contrast)});
    }
    return result;
}

VisibleDifference FindVisibleDifference(std::span<const float> image,
                                        std::span<const float> reference, int width, int height,
                                        const DisplayModel& display) {
    return FindVisibleDifference(image, PrepareReference(reference, width, height, display));
}

double PooledDifference(const VisibleDifference& difference, const PixelRect& rect) {
    // The mean square over places, then the fourth power over bands and channels.
    double pooled = 0;
    for (const VisibleBand& band : difference.bands) {
        const int width = band.difference[0].width, height = band.difference[0].height;
        const std::vector<double> inX = Shares(band.level, width, rect.min.x(), rect.max.x()),
                                  inY = Shares(band.level, height, rect.min.y(), rect.max.y());
        for (const Plane& plane : band.difference) {
            double sum = 0;
            for (int y = 0; y < height; ++y) {
                if (inY[size_t(y)] == 0) continue;
                for (int x = 0; x < width; ++x)
                    sum += inX[size_t(x)] * inY[size_t(y)] *
                           Sqr(double(plane.values[size_t(y) * size_t(width) + size_t(x)]));
            }
            pooled += Sqr(sum / double(rect.Area()));
        }
    }
    return kStillWeight * std::pow(pooled, 0.25);
}

double PooledDifference(const VisibleDifference& difference) {
    return PooledDifference(difference, {{0, 0}, {difference.width, difference.height}});
}

std::vector<float> VisibleMap(const VisibleDifference& difference) {
    Plane sum;
    for (size_t i = difference.bands.size(); i-- > 0;) {
        const Planes& planes = difference.bands[i].difference;
        Plane level{planes[0].width, planes[0].height, std::vector<float>(planes[0].values.size())};
        if (!sum.values.empty()) level = Expand(sum, level.width, level.height);
        for (const Plane& plane : planes)
            for (size_t p = 0; p < plane.values.size(); ++p)
                level.values[p] += Sqr(Sqr(plane.values[p]));
        sum = std::move(level);
    }
    for (float& v : sum.values) v = float(kStillWeight) * std::sqrt(std::sqrt(v));
    return std::move(sum.values);
}

}  // namespace lull
