// Tests media of NanoVDB files.
#include "renderer/scene/media/nanovdb.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <random>

#include "renderer/input/spectrum.h"
#include "tests/renderer/scene/media/medium_scene.h"
#include "tests/shared_folder.h"

namespace lull::media_test {
namespace {

// The file, fields.nvdb, is of NanoVDB's own GridBuilder and io::writeGrids (OpenVDB 10, ZIP): at
// voxels of 0.25 whose first is at (1, 2, 3), from (-5, -3, 2) to (9, 6, 7), "density" and
// "temperature" as below, and "heights" in doubles.
float DensityAt(const Vec3i& v) {
    return float((v.x() * v.x() + 3 * v.y() * v.y() + 7 * v.z() * v.z()) % 11) / 8;
}
float TemperatureAt(const Vec3i& v) { return 1000 + 100 * float((v.x() + v.y() + v.z()) & 7); }

std::string FieldsFile() { return LULL_TESTS_DIR "/renderer/scene/media/fields.nvdb"; }

// Interpolates between values in the box, and 0 outside.
template <typename ValueAt>
float Interpolated(const Vec3f& x, const ValueAt& valueAt) {
    float sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        Vec3i v;
        float weight = 1;
        for (int i = 0; i < 3; ++i) {
            v[i] = int(std::floor(x[i])) + (corner >> i & 1);
            weight *= 1 - std::abs(x[i] - float(v[i]));
        }
        const bool isThere = (v.array() >= Vec3i(-5, -3, 2).array()).all() &&
                             (v.array() <= Vec3i(9, 6, 7).array()).all();
        if (isThere) sum += weight * valueAt(v);
    }
    return sum;
}

TEST(NanoVdb, IsTheGridThatWasWritten) {
    const MediumTable table =
        MakeTable("nanovdb", {String("filename", FieldsFile()), Color("sigma_a", {0.5f, 1, 0}),
                              Color("sigma_s", {1, 1, 2}), Float("Lescale", 0.1f)});
    // pbrt-v4's box, which goes on to the next voxels.
    const Vec3f low(-0.25f, 1.25f, 3.5f), high(3.5f, 3.75f, 5);
    const auto& grid = std::get<SparseGrid>(std::get<GridMedium>(table.media[0]).density);
    EXPECT_EQ(grid.values.size(), 6u * 512);
    const auto voxel = [](const Vec3f& p) { return Vec3f((p - Vec3f(1, 2, 3)) / 0.25f); };
    const auto pointAt = [&](const Vec3f& p, const Vec3f& u) {
        const float d = Interpolated(voxel(p), DensityAt);
        EXPECT_NEAR(grid(u), d, 1e-4) << p.transpose();
        const float kelvin = Interpolated(voxel(p), TemperatureAt);
        const Rgb Le = kelvin > 100 ? Rgb(10.68569f * RgbFromBlackbody(double(kelvin)).max(0.f))
                                    : Rgb(Rgb::Zero());
        return Point{Rgb(0.5f, 1, 0) * d, Rgb(1, 1, 2) * d, Le};
    };
    for (const Vec3f& d : {Vec3f(0.7f, 0.4f, 0.2f), Vec3f(-0.7f, -0.4f, -0.1f), Vec3f(1, 0, 0)}) {
        const Vec3f unit = d.normalized();
        ExpectIntegrals(table, {Vec3f(1.6f, 2.4f, 4.2f) - 2 * unit, unit, 4.5f}, low, high, pointAt,
                        20000);
    }
    EXPECT_EQ(table
                  .Sample(0, {Vec3f(0, 0, 0), Vec3f::UnitX(), kInfinity},
                          *std::make_unique<Sampler>(SamplerKind::Random, 1))
                  .t.has_value(),
              false);
}

TEST(NanoVdb, RefusesWhatItCannotShow) {
    const auto error = [](std::vector<Parameter> parameters) {
        return ErrorOf([&] { MakeTable("nanovdb", std::move(parameters)); });
    };
    const auto file = String("filename", FieldsFile());
    EXPECT_HAS(error({file, String("gridname", "smoke")}), "has no grid \"smoke\"");
    EXPECT_HAS(error({file, String("gridname", "heights")}),
               "fields.nvdb: the grid \"heights\" is of type double");
    EXPECT_HAS(error({String("filename", "missing.nvdb")}), "scene.pbrt:3: ");
    const TemporaryDirectory folder;
    const std::string bytes = ReadBytes(FieldsFile());
    const auto changed = [&](size_t at, char value) {
        std::string other = bytes;
        other[at] = value;
        return error({String("filename", folder.Write("f.nvdb", other))});
    };
    EXPECT_HAS(changed(0, 'M'), "f.nvdb: is no NanoVDB file");
    EXPECT_HAS(changed(11, 0), "f.nvdb: has format ");
    EXPECT_HAS(changed(14, 2), "f.nvdb: is packed by BLOSC");
    EXPECT_HAS(changed(22, 1), "f.nvdb: the NanoVDB file is damaged");  // its size
    EXPECT_HAS(changed(16 + 36, 1), "f.nvdb: the grid \"density\" is no fog volume");
    EXPECT_HAS(error({String("filename", folder.Write("f.nvdb", bytes.substr(0, 2000)))}),
               "damaged or cut short");
}

// Whatever a file has instead of its numbers, it is read or refused.
TEST(NanoVdb, SurvivesDamage) {
    const TemporaryDirectory folder;
    const std::string zipped = ReadBytes(FieldsFile());
    // Unpacks the first grid, so that its nodes can be damaged.
    uint64_t size, packedSize;
    std::memcpy(&size, &zipped[16], 8);
    std::memcpy(&packedSize, &zipped[24], 8);
    std::string plain = zipped.substr(0, 16 + 176 + sizeof("density"));
    plain[12] = 1;
    plain[14] = 0;
    std::memcpy(&plain[24], &size, 8);
    std::string grid(size, 0);
    uLongf unpacked = size;
    // Behind the heads of all grids, and its own size.
    const size_t start =
        16 + 3 * 176 + sizeof("density") + sizeof("temperature") + sizeof("heights");
    ASSERT_EQ(uncompress(reinterpret_cast<Bytef*>(grid.data()), &unpacked,
                         reinterpret_cast<const Bytef*>(&zipped[start + 8]), packedSize - 8),
              Z_OK);
    plain += grid;
    std::vector<size_t> filled;
    for (size_t i = 0; i < plain.size(); ++i)
        if (plain[i] != 0) filled.push_back(i);
    std::mt19937 random(1);
    int read = 0, refused = 0;
    for (int i = 0; i < 60; ++i) {
        std::string bytes = plain;
        const size_t head = std::min<size_t>(filled.size(), 400);
        for (int n = 0; n < 3; ++n)
            bytes[filled[random() % (i % 2 ? filled.size() : head)]] = char(random());
        if (i % 8 == 0) bytes.resize(random() % bytes.size());
        try {
            ReadNanoVdb(folder.Write("f.nvdb", bytes), "density", {});
            ++read;
        } catch (const Error&) {
            ++refused;
        }
    }
    EXPECT_GT(read, 5);
    EXPECT_GT(refused, 5);
}

// Houdini 18.5 wrote an older format.
TEST(NanoVdb, ReadsOldFiles) {
    LULL_SHARED_FILE(file, "pbrt4-scenes/houdini/resources/sphere.nvdb");
    const auto grid = ReadNanoVdb(file.string(), "density", {});
    ASSERT_TRUE(grid);
    double sum = 0;
    for (int i = 0; i < 32 * 32 * 32; ++i)
        sum += double(grid->grid.Value({i % 32, i / 32 % 32, i / 1024}));
    EXPECT_NEAR(sum, 17166.68, 0.01);  // a ball of 16 voxels that fades to its surface
    EXPECT_EQ(grid->high, Vec3f(32, 32, 32));
    EXPECT_NEAR(grid->voxelFromMedium(0, 0), 14.2222, 1e-3);
    EXPECT_FALSE(ReadNanoVdb(file.string(), "temperature", {}));
}

}  // namespace
}  // namespace lull::media_test
