#include "stopping/base/checksum.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "stopping/base/hdf5_file.h"
#include "tests/stopping/scratch_file.h"

namespace lull {
namespace {

std::string Problem(const std::string& text) {
    const ScratchFile file(".sealed", text);
    try {
        CheckSeal(file.path);
        return "";
    } catch (const std::runtime_error& e) {
        return e.what();
    }
}

std::string Sealed(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    std::vector<std::byte> sealed(bytes.begin(), bytes.end());
    Seal(&sealed);
    return {reinterpret_cast<const char*>(sealed.data()), sealed.size()};
}

TEST(Seal, FindsEveryFlippedBit) {
    for (const std::string& text : {std::string(), std::string(100, 'x')}) {
        const std::string good = Sealed(text);
        EXPECT_EQ(Problem(good), "");
        const auto content = CheckSeal(std::as_bytes(std::span(good)));
        EXPECT_EQ(std::string(reinterpret_cast<const char*>(content.data()), content.size()), text);
        for (size_t bit = 0; bit < 8 * good.size(); ++bit) {
            std::string bad = good;
            bad[bit / 8] ^= char(1 << bit % 8);
            EXPECT_NE(Problem(bad), "") << bit;
            EXPECT_THROW(CheckSeal(std::as_bytes(std::span(bad))), std::runtime_error) << bit;
        }
        for (size_t size = 0; size < good.size(); ++size)
            EXPECT_NE(Problem(good.substr(0, size)), "") << size;
        EXPECT_NE(Problem(good + "x"), "");
    }
}

TEST(Seal, SaysWhatIsWrong) {
    std::string bad = Sealed(std::string(100, 'x'));
    bad[50] = 'y';
    EXPECT_NE(Problem(bad).find("damaged"), std::string::npos);
    EXPECT_NE(Problem("something else").find("cut short"), std::string::npos);
    try {
        CheckSeal("/nowhere/x.h5");
        FAIL();
    } catch (const std::runtime_error& e) {
        EXPECT_NE(std::string(e.what()).find("No such file"), std::string::npos) << e.what();
    }
}

TEST(Hdf5Group, SaysWhyAFileCannotBeOpened) {
    const auto problem = [](const std::string& path) -> std::string {
        try {
            Hdf5Group::Open(path);
            return "";
        } catch (const std::runtime_error& e) {
            return e.what();
        }
    };
    EXPECT_EQ(problem("/nowhere/x.h5"), "cannot open it: No such file or directory");
    const ScratchFile text(".h5", "this is no HDF5 file");
    EXPECT_EQ(problem(text.path), "cannot open it as HDF5");
}

}  // namespace
}  // namespace lull
