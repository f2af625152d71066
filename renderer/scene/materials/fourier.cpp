#include "renderer/scene/materials/basic.h"

#include <fmt/format.h>

#include <cstring>
#include <string_view>

#include "renderer/files/file_io.h"

namespace lull {

namespace {

// Takes little-endian values off the front of the file.
class Cursor {
  public:
    Cursor(std::string_view rest, const std::string& path) : rest(rest), path(path) {}

    template <typename T>
    std::vector<T> Take(size_t count) {
        static_assert(sizeof(T) == 4 && std::endian::native == std::endian::little);
        if (count > rest.size() / 4) Fail("is cut short");
        std::vector<T> values(count);
        if (count > 0) std::memcpy(values.data(), rest.data(), 4 * count);
        rest.remove_prefix(4 * count);
        return values;
    }
    int TakeInt() { return Take<int32_t>(1)[0]; }
    void TakeMagic(std::string_view magic) {
        if (!rest.starts_with(magic)) Fail("is not a .bsdf file of version 1");
        rest.remove_prefix(magic.size());
    }
    [[noreturn]] void Fail(const std::string& what) const { throw Error("'{}' {}", path, what); }

  private:
    std::string_view rest;
    const std::string& path;
};

void CheckFinite(const std::vector<float>& values, const Cursor& in) {
    for (const float v : values)
        if (!std::isfinite(v)) in.Fail("holds a number that is not finite");
}

}  // namespace

FourierTable LoadFourierTable(const std::string& path) {
    const FileContents file = ReadFile(path);
    Cursor in(file.View(), path);
    in.TakeMagic(std::string_view("SCATFUN\x01", 8));
    const int flags = in.TakeInt(), nodes = in.TakeInt(), coefficients = in.TakeInt();
    const int order = in.TakeInt(), channels = in.TakeInt(), bases = in.TakeInt();
    in.Take<int32_t>(3);  // metadata and textured parameters, which follow the rest
    FourierTable table;
    table.eta = in.Take<float>(1)[0];
    in.Take<int32_t>(4);
    if (flags != 1 || bases != 1 || (channels != 1 && channels != 3))
        in.Fail(
            "uses extrapolation, textures or other than 1 or 3 channels, which are not supported");
    constexpr int kMaxNodes = 1 << 14;
    if (nodes < 2 || nodes > kMaxNodes || coefficients < 0)
        in.Fail(fmt::format("has {} nodes and {} coefficients", nodes, coefficients));
    if (order < 0 || order > FourierTable::kMaxOrder)
        in.Fail(fmt::format("has series of order {}; up to {} are modelled", order,
                            FourierTable::kMaxOrder));
    if (!(table.eta > 0) || !std::isfinite(table.eta)) in.Fail("has no index of refraction");
    table.channels = channels;
    const size_t entries = size_t(nodes) * nodes;
    table.mu = in.Take<float>(nodes);
    table.cdf = in.Take<float>(entries);
    const std::vector<int32_t> places = in.Take<int32_t>(2 * entries);
    table.coefficients = in.Take<float>(coefficients);
    for (const auto* values : {&table.mu, &table.cdf, &table.coefficients})
        CheckFinite(*values, in);
    // Files hold the node of the horizon twice: seen from above, and from below.
    for (int i = 1; i < nodes; ++i) {
        const bool isEnd = i == 1 || i == nodes - 1;
        if (table.mu[i] < table.mu[i - 1] || (isEnd && table.mu[i] == table.mu[i - 1]))
            in.Fail("has nodes that do not ascend");
    }
    table.series.resize(entries);
    for (size_t e = 0; e < entries; ++e) {
        const int first = places[2 * e], length = places[2 * e + 1];
        if (length < 0 || length > order || first < 0 ||
            int64_t(first) + int64_t(length) * channels > coefficients)
            in.Fail(fmt::format("has a series of {} coefficients at {} of {}", length, first,
                                coefficients));
        table.series[e] = {first, length};
    }
    return table;
}

Fourier::Fourier(const MaterialReader& in) {
    const std::string file = in.entity.parameters.GetString("bsdffile", "");
    if (file.empty()) {
        problem = "a fourier material needs a \"bsdffile\"";
        return;
    }
    try {
        table = std::make_shared<const FourierTable>(
            LoadFourierTable(ResolvePath(in.description, file)));
    } catch (const Error& error) {
        problem = error.what();
    }
}

void Fourier::AddLobes(const MaterialInputs&, Bsdf* bsdf) const {
    bsdf->Add(FourierLobe{Rgb(1, 1, 1), table.get()});
}

}  // namespace lull
