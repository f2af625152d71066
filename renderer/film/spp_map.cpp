#include "renderer/film/spp_map.h"

#include <string>

#include "renderer/base/math.h"
#include "renderer/image/image_io.h"

namespace lull {

namespace {

// Digits of 3 x 5 dots, three bits a row from the top.
constexpr uint16_t kDigits[10] = {
    0b111'101'101'101'111, 0b010'110'010'010'111, 0b111'001'111'100'111, 0b111'001'011'001'111,
    0b101'101'111'001'001, 0b111'100'111'001'111, 0b111'100'111'101'111, 0b111'001'010'010'010,
    0b111'101'111'101'111, 0b111'101'111'001'111};
constexpr int kDigitWidth = 4, kDigitHeight = 5;  // dots, with the gap to the next

constexpr uint16_t kPlus = 0b000'010'111'010'000;

int TextWidth(const std::string& number, int dot) {
    return (int(number.size()) * kDigitWidth - 1) * dot;
}

class Canvas {
  public:
    Canvas(int width, int height)
        : map{width, height, std::vector<uint8_t>(size_t(width) * size_t(height) * 3, 255)} {}

    void Fill(const PixelRect& rect, const Rgb& srgb) {
        std::array<uint8_t, 3> color;
        for (int c = 0; c < 3; ++c) color[size_t(c)] = Encode8Bit(LinearFromSrgb(srgb[c]));
        const PixelRect r{rect.min.cwiseMax(0), rect.max.cwiseMin(Vec2i(map.width, map.height))};
        for (int y = r.min.y(); y < r.max.y(); ++y)
            for (int x = r.min.x(); x < r.max.x(); ++x)
                std::copy_n(color.begin(), 3,
                            &map.srgb[3 * (size_t(y) * size_t(map.width) + size_t(x))]);
    }

    // Draws with the upper left corner at `at`, each dot `dot` pixels wide.
    void Number(const std::string& number, Vec2i at, int dot, const Rgb& srgb) {
        for (const char c : number) {
            for (int i = 0; i < 15; ++i)
                if ((c == '+' ? kPlus : kDigits[c - '0']) >> (14 - i) & 1) {
                    const Vec2i p = at + dot * Vec2i(i % 3, i / 3);
                    Fill({p, p + Vec2i(dot, dot)}, srgb);
                }
            at.x() += kDigitWidth * dot;
        }
    }

    SppMap map;
};

// Places spp on the logarithmic scale.
float Scale(int spp, int lowest, int highest) {
    if (lowest >= highest) return 1;
    return std::log(float(std::max(spp, lowest)) / float(lowest)) /
           std::log(float(highest) / float(lowest));
}

void DrawFrame(Canvas& canvas, const PixelRect& rect) {
    const Rgb red(0.9f, 0.1f, 0.1f);
    const int width = std::clamp(std::min(rect.Width(), rect.Height()) / 50, 1, 4);
    canvas.Fill({rect.min, {rect.max.x(), rect.min.y() + width}}, red);
    canvas.Fill({{rect.min.x(), rect.max.y() - width}, rect.max}, red);
    canvas.Fill({rect.min, {rect.min.x() + width, rect.max.y()}}, red);
    canvas.Fill({{rect.max.x() - width, rect.min.y()}, rect.max}, red);
}

void DrawBlock(Canvas& canvas, const PixelRect& rect, const SppBlock& block, float t) {
    const Rgb color = Viridis(t);
    canvas.Fill(rect, color);
    // Draw a line along the sides that face the next blocks, halfway to black.
    const Rgb line = color * 0.5f;
    canvas.Fill({{rect.max.x() - 1, rect.min.y()}, rect.max}, line);
    canvas.Fill({{rect.min.x(), rect.max.y() - 1}, rect.max}, line);

    if (block.isNoisy) DrawFrame(canvas, rect);
    const std::string number = std::to_string(block.spp) + (block.isNoisy ? "+" : "");
    const int dot = std::min(
        {4, rect.Width() * 3 / 4 / TextWidth(number, 1), rect.Height() / 2 / kDigitHeight});
    if (dot < 1) return;
    const Vec2i size(TextWidth(number, dot), kDigitHeight * dot);
    const Rgb ink = Luminance(color) > 0.5f ? Rgb(0, 0, 0) : Rgb(1, 1, 1);
    canvas.Number(number, (rect.min + rect.max - size) / 2, dot, ink);
}

// Draws the bar at rows [top, top + barHeight) and its numbers below: both ends, and the powers of
// ten for which there is room between them.
void DrawLegend(Canvas& canvas, int top, int barHeight, int dot, int lowest, int highest) {
    const int width = canvas.map.width;
    for (int x = 0; x < width; ++x)
        canvas.Fill({{x, top}, {x + 1, top + barHeight}},
                    Viridis(width > 1 ? float(x) / float(width - 1) : 1));

    int usedFrom = width, usedTo = 0;  // no numbers between usedTo and usedFrom
    auto draw = [&](int spp, bool isEnd) {
        const std::string number = std::to_string(spp);
        const int textWidth = TextWidth(number, dot);
        const int center = int(Scale(spp, lowest, highest) * float(width - 1));
        const int x = std::clamp(center - textWidth / 2, 0, std::max(0, width - textWidth));
        if (!isEnd && (x < usedTo + 2 * kDigitWidth * dot ||
                       x + textWidth > usedFrom - 2 * kDigitWidth * dot))
            return;
        canvas.Fill({{center, top + barHeight - 3}, {center + 1, top + barHeight + dot}},
                    Rgb(0, 0, 0));
        canvas.Number(number, {x, top + barHeight + 2 * dot}, dot, Rgb(0, 0, 0));
        if (isEnd && spp == highest)
            usedFrom = x;
        else
            usedTo = x + textWidth;
    };
    draw(highest, true);
    if (lowest < highest) draw(lowest, usedFrom > 2 * TextWidth(std::to_string(lowest), dot));
    for (int64_t spp = 10; spp < highest; spp *= 10)
        if (spp > lowest) draw(int(spp), false);
}

}  // namespace

Rgb Viridis(float t) {
    // Nine points of the map, evenly spaced; 8-bit sRGB.
    static constexpr int kTable[9][3] = {{68, 1, 84},    {71, 44, 122},  {59, 81, 139},
                                         {44, 113, 142}, {33, 144, 141}, {39, 173, 129},
                                         {92, 200, 99},  {170, 220, 50}, {253, 231, 37}};
    const float x = std::clamp(t, 0.f, 1.f) * 8;
    const int i = std::min(int(x), 7);
    Rgb color;
    for (int c = 0; c < 3; ++c)
        color[c] = Lerp(x - float(i), float(kTable[i][c]), float(kTable[i + 1][c])) / 255;
    return color;
}

SppMap DrawSppMap(const PixelRect& region, std::span<const SppBlock> blocks, int lowest,
                  int highest) {
    const int dot = std::clamp(region.Width() / 200, 1, 4);
    const int gap = 4 * dot, barHeight = 8 * dot;
    Canvas canvas(region.Width(), region.Height() + gap + barHeight + (kDigitHeight + 3) * dot);
    for (const SppBlock& block : blocks)
        DrawBlock(canvas, {block.pixels.min - region.min, block.pixels.max - region.min}, block,
                  Scale(block.spp, lowest, highest));
    DrawLegend(canvas, region.Height() + gap, barHeight, dot, lowest, highest);
    return std::move(canvas.map);
}

}  // namespace lull
