#include "renderer/scene/media/nanovdb.h"

#include <fmt/format.h>
#include <zlib.h>
#include <Eigen/LU>

#include <cmath>
#include <cstring>
#include <memory>
#include <string_view>

#include "renderer/files/file_io.h"
#include "stopping/base/input_file.h"

namespace lull {
namespace {

// Bytes that are read only where there are any.
class Bytes {
  public:
    Bytes(std::string_view all, const FileLoc& place) : all(all), place(place) {}

    [[noreturn]] void Fail(const std::string& why) const { throw Error(place, why); }
    [[noreturn]] void FailDamaged() const { Fail("the NanoVDB file is damaged or cut short"); }

    std::string_view Part(uint64_t offset, uint64_t size) const {
        if (size > all.size() || offset > all.size() - size) FailDamaged();
        return all.substr(offset, size);
    }
    template <typename T>
    T At(uint64_t offset) const {
        T value;
        std::memcpy(&value, Part(offset, sizeof(T)).data(), sizeof(T));
        return value;
    }
    size_t Size() const { return all.size(); }
    Bytes Of(std::string_view others) const { return {others, place}; }

  private:
    std::string_view all;
    FileLoc place;
};

struct Entry {
    std::string_view name = {}, packed = {};
    uint64_t size = 0, packedSize = 0;
    uint32_t type = 0, kind = 0;
    int codec = 0;
    bool isOld = false;  // of formats before 22
};

// Finds the grid in the segments of a file, each a head, the description of its grids, and these.
std::optional<Entry> Find(const Bytes& file, const std::string& name) {
    for (uint64_t at = 0; at < file.Size();) {
        if (file.Part(at, 7) != "NanoVDB") file.Fail("is no NanoVDB file");
        // Later versions have three parts.
        const uint32_t version = file.At<uint32_t>(at + 8);
        const uint32_t format = version < 1u << 21 ? version : version >> 21;
        const bool isOld = format >= 19 && format <= 21;
        if (!isOld && format != 32)
            file.Fail(
                fmt::format("has format {} of NanoVDB; 19 to 21 and 32 are supported. "
                            "nanovdb_convert of OpenVDB 8 to 12 writes 32",
                            format));
        std::vector<Entry> entries(file.At<uint16_t>(at + 12));
        const int codec = file.At<uint16_t>(at + 14);
        at += 16;
        for (Entry& e : entries) {
            const uint32_t nameSize = file.At<uint32_t>(at + (isOld ? 40 : 136));
            e = {.size = file.At<uint64_t>(at),
                 .packedSize = file.At<uint64_t>(at + 8),
                 .type = file.At<uint32_t>(at + 32),
                 .kind = file.At<uint32_t>(at + 36),
                 .codec = codec,
                 .isOld = isOld};
            at += isOld ? 144 : 176;
            e.name = file.Part(at, nameSize);
            e.name = e.name.substr(0, e.name.find('\0'));
            at += nameSize;
        }
        for (Entry& e : entries) {
            e.packed = file.Part(at, e.packedSize);
            if (e.name == name) return e;
            at += e.packedSize;
        }
    }
    return {};
}

void CheckKind(const Bytes& file, const Entry& entry) {
    constexpr std::string_view kTypes[] = {"unknown", "float", "double", "int16", "int32",  "int64",
                                           "vec3f",   "vec3d", "mask",   "half",  "uint32", "bool",
                                           "rgba8",   "fp4",   "fp8",    "fp16",  "fpn"};
    constexpr uint32_t kFloat = 1, kFog = 2;
    const std::string owner = "the grid \"" + Printable(entry.name) + "\"";
    if (entry.type != kFloat)
        file.Fail(owner + " is of type " +
                  std::string(entry.type < std::size(kTypes) ? kTypes[entry.type] : "unknown") +
                  "; float is supported");
    if (entry.kind != 0 && entry.kind != kFog) file.Fail(owner + " is no fog volume");
}

std::string_view Unpack(const Bytes& file, const Entry& entry, std::unique_ptr<char[]>* unpacked) {
    enum { kPlain, kZip, kBlosc };
    if (entry.codec == kBlosc)
        file.Fail("is packed by BLOSC, which is not supported; write it with ZIP, or not packed");
    if (entry.codec == kPlain && entry.size == entry.packed.size()) return entry.packed;
    const Bytes packed = file.Of(entry.packed);
    constexpr uint64_t kMostExpansion = 1032;  // of zlib
    if (entry.codec != kZip || entry.size / kMostExpansion > entry.packed.size())
        file.FailDamaged();
    const std::string_view stream = packed.Part(8, packed.At<uint64_t>(0));
    *unpacked = std::make_unique_for_overwrite<char[]>(entry.size);
    uLongf size = entry.size;
    if (uncompress(reinterpret_cast<Bytef*>(unpacked->get()), &size,
                   reinterpret_cast<const Bytef*>(stream.data()), stream.size()) != Z_OK ||
        size != entry.size)
        file.FailDamaged();
    return {unpacked->get(), entry.size};
}

// Reads the tree: a root with children of 32x32x32, 16x16x16 and 8x8x8, of which the last are
// bricks. By NanoVDB.h of OpenVDB, "Memory layout", and of old formats Houdini 18.5's.
class TreeReader {
  public:
    TreeReader(const Bytes& bytes, bool isOld)
        : bytes(bytes), isOld(isOld), toVisit(int64_t(bytes.Size())) {}

    VdbGrid Read() {
        const uint64_t blind = isOld ? bytes.At<uint32_t>(592) : 0;
        const uint64_t map = isOld ? 312 : 296, tree = isOld ? 608 + 288 * blind : 672;
        root = tree + bytes.At<uint64_t>(tree + 24);
        ReadBox();
        ReadMap(map);
        const uint32_t tiles = bytes.At<uint32_t>(root + (isOld ? 32 : 24));
        for (uint64_t i = 0; i < tiles; ++i) ReadTile(root + 64 + 32 * i, tiles);
        result.grid.BoundBricks();
        return std::move(result);
    }

  private:
    // Where the parts of a node are, from its start, in bytes.
    struct Layout {
        int log2;                         // of children along a side
        int side;                         // of a child, in bricks
        uint64_t childMask, table, size;  // the table has values, or where children are
        uint64_t firstChild;              // old: their distance, in nodes
    };
    Layout LayoutOf(int level) const {
        if (level == 2)
            return isOld ? Layout{5, 16, 4096, 8192, 139328, 139296}
                         : Layout{5, 16, 4128, 8256, 270400, 0};
        return isOld ? Layout{4, 1, 512, 1024, 17472, 17440} : Layout{4, 1, 544, 1088, 33856, 0};
    }
    static constexpr uint64_t kLeafSize = 2144;

    // Makes the grid for the box of all active voxels and the next ones.
    void ReadBox() {
        constexpr int kFarthest = 1 << 30;
        constexpr int64_t kMostBricks = 1 << 26;
        Vec3i low, high;
        for (int i = 0; i < 3; ++i) {
            low[i] = bytes.At<int>(root + 4 * uint64_t(i));
            high[i] = bytes.At<int>(root + 12 + 4 * uint64_t(i));
        }
        if ((low.array() > high.array()).any()) low = high = Vec3i::Zero();  // empty
        if (low.minCoeff() < -kFarthest || high.maxCoeff() > kFarthest) bytes.FailDamaged();
        SparseGrid& grid = result.grid;
        int64_t count = 1;
        for (int i = 0; i < 3; ++i) {
            first[i] = low[i] >> 3;
            grid.size[i] = ((high[i] + 1) >> 3) - first[i] + 1;
            if (grid.size[i] > kMostBricks / count)
                bytes.Fail(
                    fmt::format("its {}x{}x{} voxels are too many", int64_t(high.x()) - low.x() + 1,
                                int64_t(high.y()) - low.y() + 1, int64_t(high.z()) - low.z() + 1));
            count *= grid.size[i];
        }
        result.low = (low - 8 * first).cast<float>();
        result.high = (high + Vec3i::Ones() - 8 * first).cast<float>();
        grid.background = Checked(bytes.At<float>(root + (isOld ? 48 : 28)));
        grid.bricks.resize(size_t(count), {.value = grid.background});
        grid.values.reserve(bytes.Size() / kLeafSize * SparseGrid::kValues);
    }

    void ReadMap(uint64_t map) {
        Mat4d mediumFromVoxel = Mat4d::Identity();
        Eigen::Vector3d origin;
        for (uint64_t i = 0; i < 3; ++i) {
            for (uint64_t j = 0; j < 3; ++j)
                mediumFromVoxel(int(i), int(j)) = bytes.At<double>(map + 88 + 8 * (3 * i + j));
            origin[int(i)] = bytes.At<double>(map + 232 + 8 * i);
        }
        mediumFromVoxel.topRightCorner<3, 1>() =
            origin + mediumFromVoxel.topLeftCorner<3, 3>() * (8 * first).cast<double>();
        result.voxelFromMedium = mediumFromVoxel.inverse();
        if (!mediumFromVoxel.allFinite() || !result.voxelFromMedium.allFinite())
            bytes.FailDamaged();
    }

    void ReadTile(uint64_t tile, uint64_t tiles) {
        const uint64_t key = bytes.At<uint64_t>(tile);
        Vec3i at;  // in bricks
        for (int i = 0; i < 3; ++i) at[i] = int(uint32_t(key >> (42 - 21 * i)) << 12) >> 3;
        if (isOld) {
            const int child = bytes.At<int>(tile + 12);
            if (child < 0) return Fill(at, 512, bytes.At<float>(tile + 8));
            return ReadNode(root + 64 + 32 * tiles + uint64_t(child) * LayoutOf(2).size, 2, at);
        }
        const auto child = bytes.At<uint64_t>(tile + 8);
        if (child == 0) return Fill(at, 512, bytes.At<float>(tile + 20));
        ReadNode(root + child, 2, at);
    }

    void ReadNode(uint64_t node, int level, const Vec3i& origin) {
        if (level == 0) return ReadLeaf(node, origin);
        const Layout layout = LayoutOf(level);
        Claim(node, layout.size);
        const int mask = (1 << layout.log2) - 1;
        for (int i = 0; i < 1 << 3 * layout.log2; ++i) {
            const Vec3i in(i >> 2 * layout.log2, i >> layout.log2 & mask, i & mask);
            const Vec3i at = origin + layout.side * in;
            const uint64_t entry = node + layout.table + uint64_t(i) * (isOld ? 4 : 8);
            if (!(bytes.At<uint8_t>(node + layout.childMask + uint64_t(i / 8)) >> i % 8 & 1)) {
                Fill(at, layout.side, bytes.At<float>(entry));
            } else if (isOld) {
                const uint64_t first = bytes.At<uint32_t>(node + layout.firstChild);
                const uint64_t size = level == 1 ? kLeafSize : LayoutOf(1).size;
                ReadNode(node + first * layout.size + bytes.At<uint32_t>(entry) * size, level - 1,
                         at);
            } else {
                ReadNode(node + bytes.At<uint64_t>(entry), level - 1, at);
            }
        }
    }

    void ReadLeaf(uint64_t node, const Vec3i& origin) {
        Claim(node, kLeafSize);
        const Vec3i at = origin - first;
        SparseGrid& grid = result.grid;
        if ((at.array() < 0).any() || (at.array() >= grid.size.array()).any()) return;
        grid.At(at).stored = int(grid.values.size() / SparseGrid::kValues);
        for (uint64_t i = 0; i < SparseGrid::kValues; ++i)
            grid.values.push_back(Checked(bytes.At<float>(node + (isOld ? 64 : 96) + 4 * i)));
    }

    // No file has the same node twice, let alone many times.
    void Claim(uint64_t node, uint64_t size) {
        bytes.Part(node, size);
        toVisit -= int64_t(size);
        if (toVisit < 0) bytes.FailDamaged();
    }

    float Checked(float value) const {
        if (!std::isfinite(value)) bytes.Fail("a value of the grid is not finite");
        return value;
    }

    void Fill(const Vec3i& origin, int side, float value) {
        const Vec3i low = (origin - first).cwiseMax(0);
        const Vec3i high = (origin - first + Vec3i::Constant(side)).cwiseMin(result.grid.size);
        if ((low.array() >= high.array()).any()) return;
        Checked(value);
        for (int z = low.z(); z < high.z(); ++z)
            for (int y = low.y(); y < high.y(); ++y)
                for (int x = low.x(); x < high.x(); ++x) result.grid.At({x, y, z}).value = value;
    }

    const Bytes bytes;
    const bool isOld;
    int64_t toVisit;  // bytes of nodes, at most
    uint64_t root = 0;
    Vec3i first = Vec3i::Zero();  // brick of the grid
    VdbGrid result;
};

}  // namespace

std::optional<VdbGrid> ReadNanoVdb(const std::string& path, const std::string& name,
                                   const FileLoc& loc) {
    const FileContents contents = ReadFile(path, loc);
    const Bytes file(contents.View(), {std::make_shared<const std::string>(path), 0});
    if (file.Size() == 0) file.FailDamaged();
    const std::optional<Entry> entry = Find(file, name);
    if (!entry) return {};
    CheckKind(file, *entry);
    std::unique_ptr<char[]> unpacked;
    return TreeReader(file.Of(Unpack(file, *entry, &unpacked)), entry->isOld).Read();
}

}  // namespace lull
