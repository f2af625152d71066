#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "stopping/base/hdf5_file.h"
#include "stopping/base/state.h"
#include "tests/stopping/scratch_file.h"

namespace lull {
namespace {

std::string TextIn(const std::string& path) {
    try {
        return Hdf5Group::Open(path).String("text");
    } catch (const std::runtime_error& error) {
        return error.what();
    }
}

// The library never returned from an object that has no size, or one so large that the sum with its
// header is 0.
TEST(GlobalHeaps, HaveObjectsThatEnd) {
    const ScratchFile file(".h5");
    {
        Hdf5Group root = Hdf5Group::Create(file.path);
        root.SetString("text", "thirteen more");
        // Beyond the first chunk that is read.
        root.AddArray<double>("x", std::vector<int64_t>{200000}, std::vector<double>(200000, 1));
        root.SetString("second", std::string(3000, 'x'));
    }
    EXPECT_EQ(TextIn(file.path), "thirteen more");

    const std::string good = ContentsOf(file.path);
    int heaps = 0;
    for (size_t at = good.find("GCOL"); at != good.npos; at = good.find("GCOL", at + 4), ++heaps)
        for (const uint16_t index : {0, 1})
            for (const uint64_t size :
                 {uint64_t(0), ~uint64_t(0), ~uint64_t(15), uint64_t(1) << 40}) {
                if (index == 1 && size == 0) continue;  // an empty text
                std::string bad = good;
                bad.replace(at + 16, 2, reinterpret_cast<const char*>(&index), 2);
                bad.replace(at + 24, 8, reinterpret_cast<const char*>(&size), 8);
                std::ofstream(file.path, std::ios::binary) << bad;
                EXPECT_EQ(TextIn(file.path), "cannot read its texts: a heap of them is damaged")
                    << at << " " << index << " " << size;
            }
    EXPECT_GE(heaps, 1);
    for (size_t size = 0; size < good.size(); size += good.size() / 40) {
        std::ofstream(file.path, std::ios::binary) << good.substr(0, size);
        EXPECT_NE(TextIn(file.path), "thirteen more");
    }
}

TEST(Hdf5Group, SaysWhyAFileCannotBeOpened) {
    EXPECT_EQ(TextIn("/nowhere/x.h5"), "cannot open it: No such file or directory");
    const ScratchFile text(".h5", "this is no HDF5 file");
    EXPECT_EQ(TextIn(text.path), "cannot open it as HDF5");
}

TEST(State, SaysWhatIsDamaged) {
    StateWriter writer;
    writer.Put(uint32_t(7));
    StateReader message(writer.bytes, "a message");
    EXPECT_EQ(WhatOf([&] { message.Get<uint64_t>(); }), "a message is cut short");
    EXPECT_EQ(WhatOf([&] { message.Finish(); }), "a message is longer than expected");
    EXPECT_EQ(WhatOf([&] { message.Expect(8); }), "a message is of another kind");
    EXPECT_EQ(WhatOf([&] { message.Finish(); }), "");
    EXPECT_EQ(WhatOf([&] { StateReader(writer.bytes).Get<uint64_t>(); }),
              "the saved state is cut short");
    EXPECT_EQ(int(StateReader(writer.bytes).Get<bool>()), 1);
}

}  // namespace

}  // namespace lull
