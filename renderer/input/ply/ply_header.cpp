#include "renderer/input/ply/ply_header.h"

#include <algorithm>
#include <charconv>
#include <iterator>

#include "renderer/files/file_io.h"

namespace lull {
namespace {

// Bound the size of a header; real ones have a dozen lines.
constexpr int kMostLines = 10000;
constexpr size_t kLongestLine = 4096;

struct PlyTypeName {
    std::string_view name;
    PlyType type;
};

constexpr PlyTypeName kPlyTypeNames[] = {
    {"char", PlyType::Int8},       {"int8", PlyType::Int8},      {"uchar", PlyType::Uint8},
    {"uint8", PlyType::Uint8},     {"short", PlyType::Int16},    {"int16", PlyType::Int16},
    {"ushort", PlyType::Uint16},   {"uint16", PlyType::Uint16},  {"int", PlyType::Int32},
    {"int32", PlyType::Int32},     {"uint", PlyType::Uint32},    {"uint32", PlyType::Uint32},
    {"int64", PlyType::Int64},     {"uint64", PlyType::Uint64},  {"float", PlyType::Float32},
    {"float32", PlyType::Float32}, {"double", PlyType::Float64}, {"float64", PlyType::Float64},
};

PlyType ParseType(std::string_view name, const FileLoc& loc) {
    const auto* known = std::ranges::find(kPlyTypeNames, name, &PlyTypeName::name);
    if (known == std::end(kPlyTypeNames))
        throw Error(loc, "unknown type '" + Printable(name) + "' in a PLY header");
    return known->type;
}

std::vector<std::string_view> SplitWords(std::string_view line) {
    std::vector<std::string_view> words;
    while (true) {
        line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size()));
        if (line.empty()) return words;
        words.push_back(line.substr(0, line.find_first_of(" \t\r")));
        line.remove_prefix(words.back().size());
    }
}

PlyFormat ParseFormat(std::string_view name, const FileLoc& loc) {
    if (name == "ascii") return PlyFormat::Ascii;
    if (name == "binary_little_endian") return PlyFormat::LittleEndian;
    if (name == "binary_big_endian") return PlyFormat::BigEndian;
    throw Error(loc, "unknown PLY format '" + Printable(name) + "'");
}

PlyElement ParseElement(const std::vector<std::string_view>& words, const FileLoc& loc) {
    PlyElement element{std::string(words[1]), 0, {}};
    const std::string_view text = words[2];
    const auto [end, status] =
        std::from_chars(text.data(), text.data() + text.size(), element.count);
    if (status != std::errc() || end != text.data() + text.size() || element.count < 0)
        throw Error(loc, "'" + Printable(text) + "' cannot be the count of PLY element '" +
                             Printable(element.name) + "'");
    return element;
}

PlyProperty ParseProperty(const std::vector<std::string_view>& words, const FileLoc& loc) {
    if (words.size() == 3)
        return {std::string(words[2]), ParseType(words[1], loc), false, PlyType::Uint8};
    if (words.size() != 5 || words[1] != "list")
        throw Error(loc,
                    "a PLY property is written 'property TYPE NAME' or "
                    "'property list TYPE TYPE NAME'");
    const PlyType countType = ParseType(words[2], loc);
    if (countType == PlyType::Float32 || countType == PlyType::Float64)
        throw Error(loc, "the counts of a PLY list must be of an integer type");
    return {std::string(words[4]), ParseType(words[3], loc), true, countType};
}

// Data may follow the last line's CR with a byte that looks like LF.
char LineEnd(std::string_view file) {
    const size_t first = file.substr(0, kLongestLine).find_first_of("\r\n");
    const bool isCr = first != std::string_view::npos && file[first] == '\r' &&
                      !file.substr(first + 1).starts_with('\n');
    return isCr ? '\r' : '\n';
}

}  // namespace

PlyHeader ParsePlyHeader(std::string_view file, FileLoc loc) {
    PlyHeader header;
    bool hasFormat = false;
    const char lineEnd = LineEnd(file);
    for (loc.line = 1;; ++loc.line) {
        const std::string_view rest = file.substr(header.bytes);
        const size_t length = rest.substr(0, kLongestLine).find(lineEnd);
        if (length == std::string_view::npos || loc.line > kMostLines)
            throw Error(loc, loc.line == 1 ? "not a PLY file: its first line must be 'ply'"
                                           : "the PLY header has no end_header");
        header.bytes += length + 1;
        const std::vector<std::string_view> words = SplitWords(rest.substr(0, length));
        if (loc.line == 1) {
            if (words.size() != 1 || words[0] != "ply")
                throw Error(loc, "not a PLY file: its first line must be 'ply'");
        } else if (words.empty() || words[0] == "comment" || words[0] == "obj_info") {
            continue;
        } else if (words[0] == "format" && words.size() >= 2) {
            header.format = ParseFormat(words[1], loc);
            hasFormat = true;
        } else if (words[0] == "element" && words.size() == 3) {
            header.elements.push_back(ParseElement(words, loc));
        } else if (words[0] == "property") {
            if (header.elements.empty())
                throw Error(loc, "a PLY property must come after an element");
            header.elements.back().properties.push_back(ParseProperty(words, loc));
        } else if (words[0] == "end_header") {
            break;
        } else {
            throw Error(
                loc, "'" + Printable(rest.substr(0, length)) + "' does not belong in a PLY header");
        }
    }
    if (!hasFormat) throw Error(loc, "the PLY header names no format");
    header.lines = loc.line;
    return header;
}

namespace {

using Triangle = std::array<size_t, 3>;
using Point = Eigen::Vector2d;

std::vector<Triangle> FanOf(size_t corners) {
    std::vector<Triangle> triangles;
    for (size_t i = 2; i < corners; ++i) triangles.push_back({0, i - 1, i});
    return triangles;
}

double TwiceArea(const Point& a, const Point& b, const Point& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

std::vector<Point> Flattened(std::span<const uint32_t> vertices, std::span<const Vec3f> positions) {
    const auto at = [&](size_t i) -> Eigen::Vector3d {
        return positions[vertices[i % vertices.size()]].cast<double>();
    };
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (size_t i = 1; i + 1 < vertices.size(); ++i)
        normal += (at(i) - at(0)).cross(at(i + 1) - at(0));
    int axis;
    normal.cwiseAbs().maxCoeff(&axis);
    const int x = (axis + 1) % 3, y = (axis + 2) % 3;
    std::vector<Point> points;
    for (size_t i = 0; i < vertices.size(); ++i)
        points.push_back(normal[axis] < 0 ? Point(at(i)[y], at(i)[x]) : Point(at(i)[x], at(i)[y]));
    return points;
}

bool IsConvex(const std::vector<Point>& p) {
    const size_t n = p.size();
    for (size_t i = 0; i < n; ++i)
        if (TwiceArea(p[i], p[(i + 1) % n], p[(i + 2) % n]) < 0) return false;
    return true;
}

bool IsEar(const std::vector<Point>& p, const std::vector<size_t>& left, size_t k) {
    const size_t n = left.size(), before = left[(k + n - 1) % n], here = left[k],
                 after = left[(k + 1) % n];
    const Point &a = p[before], &b = p[here], &c = p[after];
    if (!(TwiceArea(a, b, c) > 0)) return false;
    return std::ranges::none_of(left, [&](size_t i) {
        const Point& q = p[i];
        return q != a && q != b && q != c && TwiceArea(a, b, q) >= 0 && TwiceArea(b, c, q) >= 0 &&
               TwiceArea(c, a, q) >= 0;
    });
}

}  // namespace

std::vector<Triangle> TrianglesOf(std::span<const uint32_t> vertices,
                                  std::span<const Vec3f> positions) {
    const std::vector<Triangle> fan = FanOf(vertices.size());
    const auto isThere = [&](uint32_t v) {
        return v < positions.size() && positions[v].allFinite();
    };
    if (vertices.size() == 3 || !std::ranges::all_of(vertices, isThere)) return fan;
    const std::vector<Point> points = Flattened(vertices, positions);
    if (IsConvex(points)) return fan;
    std::vector<Triangle> triangles;
    std::vector<size_t> left(vertices.size());
    for (size_t i = 0; i < left.size(); ++i) left[i] = i;
    while (left.size() > 3) {
        size_t k = 0;
        while (k < left.size() && !IsEar(points, left, k)) ++k;
        if (k == left.size()) return fan;  // it crosses itself, or has no area
        const size_t n = left.size();
        triangles.push_back({left[(k + n - 1) % n], left[k], left[(k + 1) % n]});
        left.erase(left.begin() + long(k));
    }
    triangles.push_back({left[0], left[1], left[2]});
    return triangles;
}

}  // namespace lull
