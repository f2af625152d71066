#include "renderer/scene/textures/mip_pyramid.h"

#include <fmt/core.h>

#include <bit>

#include "renderer/base/memory.h"

namespace lull {
namespace {

// Returns the texel that stands for the i-th of n; -1 for none, which is black.
int WrapIndex(int i, int n, Wrap wrap) {
    if (i >= 0 && i < n) return i;
    switch (wrap) {
        case Wrap::Repeat:
            return (i % n + n) % n;
        case Wrap::Clamp:
            return std::clamp(i, 0, n - 1);
        case Wrap::Mirror: {
            const int inPair = (i % (2 * n) + 2 * n) % (2 * n);
            return inPair < n ? inPair : 2 * n - 1 - inPair;
        }
        case Wrap::Black:
            break;
    }
    return -1;
}

// Brings a coordinate near the image, where it means the same: all that follows fits integers.
float NearImage(float s, Wrap wrap) {
    constexpr float kFar = 1e4f;
    const float period = wrap == Wrap::Repeat ? 1 : wrap == Wrap::Mirror ? 2 : 0;
    if (period == 0) return std::min(std::max(-kFar, s), kFar);
    const float near = s - period * std::floor(s / period);
    return near < period ? near : 0;
}

// The windowed sinc, 0 beyond 1.
float Lanczos(float x) {
    constexpr float kTau = 2;
    x = std::abs(x);
    if (x < 1e-5f) return 1;
    if (x > 1) return 0;
    x *= kPi;
    return std::sin(x * kTau) / (x * kTau) * (std::sin(x) / x);
}

// How a texel of the enlarged axis is made of four of the original.
struct ResampleWeight {
    int first;
    std::array<float, 4> weights;
};

std::vector<ResampleWeight> MakeResampleWeights(int oldCount, int newCount) {
    constexpr float kRadius = 2;
    std::vector<ResampleWeight> result;
    for (int i = 0; i < newCount; ++i) {
        const float center = (float(i) + 0.5f) * float(oldCount) / float(newCount);
        ResampleWeight w{int(std::floor(center - kRadius + 0.5f)), {}};
        float sum = 0;
        for (int j = 0; j < 4; ++j) {
            w.weights[size_t(j)] = Lanczos((float(w.first + j) + 0.5f - center) / kRadius);
            sum += w.weights[size_t(j)];
        }
        for (float& weight : w.weights) weight /= sum;
        result.push_back(w);
    }
    return result;
}

// Enlarges an axis of `from`, along which texels lie `stride` floats apart; the others are `lines`,
// of which line k starts at start(k) in the input and startTo(k) in the output.
template <typename Start, typename StartTo>
void ResampleAxis(const std::vector<float>& from, std::vector<float>* to, int oldCount,
                  int newCount, size_t stride, size_t lines, const Start& start,
                  const StartTo& startTo, Wrap wrap) {
    const std::vector<ResampleWeight> weights = MakeResampleWeights(oldCount, newCount);
    for (size_t line = 0; line < lines; ++line)
        for (int i = 0; i < newCount; ++i) {
            const ResampleWeight& w = weights[size_t(i)];
            float sum = 0;
            for (int j = 0; j < 4; ++j)
                if (const int at = WrapIndex(w.first + j, oldCount, wrap); at >= 0)
                    sum += w.weights[size_t(j)] * from[start(line) + size_t(at) * stride];
            (*to)[startTo(line) + size_t(i) * stride] = sum;
        }
}

// Resamples an image of `count` channels to sides that are no smaller.
std::vector<float> Enlarge(const std::vector<float>& texels, const Vec2i& from, const Vec2i& to,
                           size_t count, Wrap wrapS, Wrap wrapT) {
    // Each texel of the rows is a line of `count` channels, and so is each of the columns.
    std::vector<float> wide(size_t(to.x()) * size_t(from.y()) * count);
    const auto inRows = [&](int across) {
        return [=](size_t line) { return line / count * size_t(across) * count + line % count; };
    };
    ResampleAxis(texels, &wide, from.x(), to.x(), count, size_t(from.y()) * count, inRows(from.x()),
                 inRows(to.x()), wrapS);
    std::vector<float> result(size_t(to.x()) * size_t(to.y()) * count);
    const auto inColumns = [](size_t line) { return line; };
    ResampleAxis(wide, &result, from.y(), to.y(), size_t(to.x()) * count, size_t(to.x()) * count,
                 inColumns, inColumns, wrapT);
    for (float& t : result) t = std::max(0.f, t);
    return result;
}

// The Gaussian of exponent 2, less its value at the ellipse's edge, over the squared radius.
std::array<float, 128> MakeEwaWeights() {
    std::array<float, 128> weights;
    for (size_t i = 0; i < weights.size(); ++i)
        weights[i] = std::exp(-2 * float(i) / float(weights.size() - 1)) - std::exp(-2.f);
    return weights;
}

const std::array<float, 128> kEwaWeights = MakeEwaWeights();

}  // namespace

MipPyramid::MipPyramid(int width, int height, int channels, std::vector<float> texels, Wrap wrapS,
                       Wrap wrapT)
    : channels(channels), wrapS(wrapS), wrapT(wrapT) {
    const int w = int(std::bit_ceil(unsigned(width))), h = int(std::bit_ceil(unsigned(height)));
    const size_t count = size_t(channels);
    CheckMemory(int64_t(size_t(w) * size_t(h) * count * sizeof(float)) * 7 / 3,
                fmt::format("filtering an image of {}x{} texels", width, height),
                "leave out --filtering pbrt-v3");
    if (w != width || h != height)
        texels = Enlarge(texels, {width, height}, {w, h}, count, wrapS, wrapT);
    levels.push_back({w, h, std::move(texels)});
    while (levels.back().width > 1 || levels.back().height > 1) {
        const Level& fine = levels.back();
        Level next{std::max(1, fine.width / 2), std::max(1, fine.height / 2), {}};
        next.texels.resize(size_t(next.width) * size_t(next.height) * count);
        float* to = next.texels.data();
        const auto at = [&](int x, int y, size_t c) {
            x = WrapIndex(x, fine.width, wrapS);
            y = WrapIndex(y, fine.height, wrapT);
            if (x < 0 || y < 0) return 0.f;
            return fine.texels[(size_t(y) * size_t(fine.width) + size_t(x)) * count + c];
        };
        for (int y = 0; y < next.height; ++y)
            for (int x = 0; x < next.width; ++x)
                for (size_t c = 0; c < count; ++c)
                    *to++ = 0.25f * (at(2 * x, 2 * y, c) + at(2 * x + 1, 2 * y, c) +
                                     at(2 * x, 2 * y + 1, c) + at(2 * x + 1, 2 * y + 1, c));
        levels.push_back(std::move(next));
    }
}

size_t MipPyramid::Bytes() const {
    size_t bytes = 0;
    for (const Level& level : levels) bytes += level.texels.size() * sizeof(float);
    return bytes;
}

template <typename T>
T MipPyramid::Texel(int level, int x, int y) const {
    const Level& l = levels[size_t(level)];
    const float* t = &l.texels[(size_t(y) * size_t(l.width) + size_t(x)) * size_t(channels)];
    if constexpr (std::is_same_v<T, float>)
        return t[0];
    else
        return channels == 1 ? Rgb(Rgb::Constant(t[0])) : Rgb(t[0], t[1], t[2]);
}

template <typename T>
T MipPyramid::Bilinear(int level, const Vec2f& st) const {
    const Level& l = levels[size_t(level)];
    const Footprint f = BilinearFootprint(st, l.width, l.height, wrapS, wrapT);
    return f.w00 * Texel<T>(level, f.x0, f.y0) + f.w10 * Texel<T>(level, f.x1, f.y0) +
           f.w01 * Texel<T>(level, f.x0, f.y1) + f.w11 * Texel<T>(level, f.x1, f.y1);
}

template <typename T>
T MipPyramid::Trilinear(const Vec2f& st, float width) const {
    const float level = float(LevelCount() - 1) + std::log2(std::max(1e-8f, width));
    if (level < 0) return Bilinear<T>(0, st);
    if (!(level < float(LevelCount() - 1))) return Coarsest<T>();
    const int fine = int(level);
    const float share = level - float(fine);
    return (1 - share) * Bilinear<T>(fine, st) + share * Bilinear<T>(fine + 1, st);
}

template <typename T>
T MipPyramid::Ewa(const Vec2f& st, Vec2f d0, Vec2f d1, float maxAnisotropy) const {
    if (d0.squaredNorm() < d1.squaredNorm()) std::swap(d0, d1);
    const float longer = d0.norm();
    float shorter = d1.norm();
    if (shorter == 0) return Bilinear<T>(0, st);
    if (shorter * maxAnisotropy < longer) {
        const float scale = longer / (shorter * maxAnisotropy);
        d1 *= scale;
        shorter *= scale;
    }
    const float level = std::max(0.f, float(LevelCount() - 1) + std::log2(shorter));
    // The comparison also fails for NaN.
    if (!(level < float(LevelCount()) && longer + shorter < kInfinity)) return Coarsest<T>();
    const int fine = int(level);
    const float share = level - float(fine);
    const Vec2f near(NearImage(st.x(), wrapS), NearImage(st.y(), wrapT));
    return (1 - share) * EwaOfLevel<T>(fine, near, d0, d1) +
           share * EwaOfLevel<T>(fine + 1, near, d0, d1);
}

template <typename T>
T MipPyramid::EwaOfLevel(int level, const Vec2f& st, Vec2f d0, Vec2f d1) const {
    if (level >= LevelCount()) return Coarsest<T>();
    const Level& l = levels[size_t(level)];
    const Vec2f size{float(l.width), float(l.height)};
    const Vec2f center = st.cwiseProduct(size) - Vec2f(0.5f, 0.5f);
    d0 = d0.cwiseProduct(size);
    d1 = d1.cwiseProduct(size);

    // The ellipse is a x^2 + b x y + c y^2 < f about the centre, a texel wider than the footprint.
    // f is a c - b^2 / 4, multiplied out, since the difference would be lost for thin ellipses; the
    // box around it then reaches sqrt(c) to each side, and sqrt(a) up and down.
    const float a = Sqr(d0.y()) + Sqr(d1.y()) + 1;
    const float b = -2 * (d0.x() * d0.y() + d1.x() * d1.y());
    const float c = Sqr(d0.x()) + Sqr(d1.x()) + 1;
    const float perF =
        1 / (Sqr(d0.x() * d1.y() - d0.y() * d1.x()) + d0.squaredNorm() + d1.squaredNorm() + 1);
    const float across = std::sqrt(c), up = std::sqrt(a);
    const int x0 = int(std::ceil(center.x() - across)), x1 = int(std::floor(center.x() + across));
    const int y0 = int(std::ceil(center.y() - up)), y1 = int(std::floor(center.y() + up));

    T sum;
    if constexpr (std::is_same_v<T, float>)
        sum = 0;
    else
        sum = Rgb::Zero();
    float sumWeights = 0;
    for (int y = y0; y <= y1; ++y) {
        const int row = WrapIndex(y, l.height, wrapT);
        const float dy = float(y) - center.y();
        for (int x = x0; x <= x1; ++x) {
            const float dx = float(x) - center.x();
            const float r2 = std::max(0.f, (a * dx * dx + b * dx * dy + c * dy * dy) * perF);
            if (!(r2 < 1)) continue;
            const float weight = kEwaWeights[size_t(r2 * float(kEwaWeights.size()))];
            sumWeights += weight;
            const int column = WrapIndex(x, l.width, wrapS);
            if (row >= 0 && column >= 0) sum += weight * Texel<T>(level, column, row);
        }
    }
    return sum / sumWeights;
}

template float MipPyramid::Bilinear(int, const Vec2f&) const;
template float MipPyramid::Trilinear(const Vec2f&, float) const;
template float MipPyramid::Ewa(const Vec2f&, Vec2f, Vec2f, float) const;
template Rgb MipPyramid::Bilinear(int, const Vec2f&) const;
template Rgb MipPyramid::Trilinear(const Vec2f&, float) const;
template Rgb MipPyramid::Ewa(const Vec2f&, Vec2f, Vec2f, float) const;

}  // namespace lull
