#include "renderer/film/display.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdio>

#include "tests/renderer/files/test_files.h"
#include "tests/renderer/film/add_sample.h"
#include "tests/renderer/film/viewer_server.h"

namespace lull {
namespace {

const PixelRect kRegion = {{10, 20}, {160, 110}};

// Counts warnings.
struct Warned {
    std::atomic<int> count = 0;
    std::function<void(const std::string&)> Sink() {
        return [this](const std::string&) { ++count; };
    }
};

// Gives the pixels of a rectangle a sample each; so many different values that a pixel at the wrong
// place shows.
void AddSamples(const PixelRect& r, Film* film) {
    for (int y = r.min.y(); y < r.max.y(); ++y)
        for (int x = r.min.x(); x < r.max.x(); ++x)
            AddTo(film, {x, y}, Rgb(float(x), float(y), float(film->At({x, y}).count) + 0.25f));
}

void ExpectSame(const ViewedImage& image, const Film& film, const PixelRect& stopped) {
    ASSERT_EQ(image.width, kRegion.Width());
    ASSERT_EQ(image.height, kRegion.Height());
    ASSERT_EQ(image.channels.size(), 5u);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const Vec2i p = kRegion.min + Vec2i(x, y);
            const size_t i = size_t(y) * size_t(image.width) + size_t(x);
            const Rgb mean = film.At(p).Mean();
            ASSERT_EQ(image.channels.at("R")[i], mean.x());
            ASSERT_EQ(image.channels.at("G")[i], mean.y());
            ASSERT_EQ(image.channels.at("B")[i], mean.z());
            ASSERT_EQ(image.channels.at("spp")[i], float(film.At(p).count));
            const bool isStopped =
                (p.array() >= stopped.min.array()).all() && (p.array() < stopped.max.array()).all();
            ASSERT_EQ(image.channels.at("stop")[i], isStopped ? 1 : 0);
        }
}

TEST(DisplayAddress, IsHostAndPort) {
    EXPECT_EQ(ParseDisplayAddress("localhost:14158").host, "localhost");
    EXPECT_EQ(ParseDisplayAddress("localhost:14158").port, "14158");
    EXPECT_EQ(ParseDisplayAddress("[::1]:80").host, "::1");
    for (const char* bad : {"", "localhost", ":80", "localhost:", "localhost:0", "localhost:65536",
                            "localhost:80x", "::1:80", "[]:80", "localhost:-1"})
        EXPECT_HAS(ErrorOf([&] { ParseDisplayAddress(bad); }), "is not HOST:PORT") << bad;
}

// Byte by byte, as tev's Ipc.h has it.
TEST(Display, SendsTevsMessages) {
    ViewerServer server;
    const PixelRect region = {{4, 0}, {6, 1}};
    Film film(region);
    AddTo(&film, {4, 0}, Rgb(1, 2, 0.5f));
    AddTo(&film, {5, 0}, Rgb(0, 0, 1));
    Warned warned;
    {
        Display display(ParseDisplayAddress(server.Address()), "a.exr", region, warned.Sink());
        display.Show(region, film);
        display.ShowStop({{5, 0}, {6, 1}});
        display.Finish(60);
    }
    ASSERT_EQ(server.Finish().size(), 1u);
    const std::string names = "5200 4700 4200 73707000 73746f7000 ";
    const std::string create =
        FromHex("27000000 04 01 612e65787200 02000000 01000000 05000000 " + names);
    const auto numbers = [](std::initializer_list<int> values, int digits) {
        std::string hex;
        for (const int v : values) {
            char text[3];
            std::snprintf(text, sizeof text, "%02x", unsigned(v));
            hex += text + std::string(size_t(digits) - 2, '0');
        }
        return hex;
    };
    std::string update = "a7000000 06 00 612e65787200 05000000 " + names;
    update +=
        numbers({0, 0, 2, 1}, 8) + numbers({0, 1, 2, 3, 4}, 16) + numbers({5, 5, 5, 5, 5}, 16);
    update += "0000803f 00000040 0000003f 0000803f 00000000";  // 1, 2, .5, 1 spp, goes on
    update += "00000000 00000000 0000803f 0000803f 0000803f";
    // What is shown between two looks goes as one message, or as two.
    const std::string& got = server.Finish()[0];
    EXPECT_EQ(got.substr(0, create.size()), create);
    const ViewedImage image = Reassemble(got);
    if (image.updates == 1) {
        EXPECT_EQ(got, create + FromHex(update));
    }
    EXPECT_EQ(image.channels.at("R"), (std::vector<float>{1, 0}));
    EXPECT_EQ(image.channels.at("stop"), (std::vector<float>{0, 1}));
    EXPECT_EQ(warned.count, 0);
}

TEST(Display, ComesToTheImageThatManyThreadsShow) {
    ViewerServer server;
    Film film(kRegion);
    const PixelRect stopped = {{30, 20}, {80, 70}};
    Warned warned;
    {
        Display display(ParseDisplayAddress(server.Address()), "image", kRegion, warned.Sink());
        std::vector<std::thread> threads;
        // Each has rows of its own.
        for (int t = 0; t < 3; ++t)
            threads.emplace_back([&, t] {
                for (int pass = 0; pass < 20; ++pass) {
                    for (int y = kRegion.min.y() + 30 * t; y < kRegion.min.y() + 30 * (t + 1);
                         ++y) {
                        const PixelRect row = {{kRegion.min.x() + pass, y},
                                               {kRegion.max.x() - 2 * pass, y + 1}};
                        AddSamples(row, &film);
                        display.Show(row, film);
                    }
                    std::this_thread::sleep_for(std::chrono::milliseconds(10));
                }
            });
        display.ShowStop(stopped);
        for (std::thread& thread : threads) thread.join();
        display.Finish(60);
    }
    ASSERT_EQ(server.Finish().size(), 1u);
    const ViewedImage image = Reassemble(server.Finish()[0]);
    EXPECT_EQ(image.name, "image");
    ExpectSame(image, film, stopped);
    EXPECT_EQ(warned.count, 0);
}

// What was denoised stays so, while there are more samples.
TEST(Display, ShowsDenoisedPixelsInPlaceOfTheFilm) {
    ViewerServer server;
    Film film(kRegion);
    const PixelRect denoised = {{20, 30}, {90, 100}};
    std::vector<float> rgb;
    for (int i = 0; i < 3 * denoised.Area(); ++i) rgb.push_back(float(i));
    Warned warned;
    {
        Display display(ParseDisplayAddress(server.Address()), "image", kRegion, warned.Sink());
        AddSamples(kRegion, &film);
        display.Show(kRegion, film);
        display.ShowDenoised(denoised, rgb);
        AddSamples(kRegion, &film);
        display.Show(kRegion, film);
        display.Finish(60);
    }
    ASSERT_EQ(server.Finish().size(), 1u);
    ViewedImage image = Reassemble(server.Finish()[0]);
    for (int y = 0, i = 0; y < denoised.Height(); ++y)
        for (int x = 0; x < denoised.Width(); ++x, ++i) {
            const Vec2i p = denoised.min + Vec2i(x, y), at = p - kRegion.min;
            const size_t pixel = size_t(at.y()) * size_t(kRegion.Width()) + size_t(at.x());
            for (int c = 0; c < 3; ++c) {
                float& value = image.channels.at(std::string(1, "RGB"[c]))[pixel];
                ASSERT_EQ(value, float(3 * i + c));
                value = film.At(p).Mean()[c];
            }
        }
    ExpectSame(image, film, {{0, 0}, {0, 0}});
}

TEST(Display, WarnsOnceWhereNobodyIsThere) {
    int port;
    {
        ViewerServer server;
        port = server.Port();
    }
    Film film(kRegion);
    Warned warned;
    Display display({"127.0.0.1", std::to_string(port)}, "image", kRegion, warned.Sink());
    for (int i = 0; i < 100 && warned.count == 0; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    AddSamples(kRegion, &film);
    display.Show(kRegion, film);
    display.Finish();
    EXPECT_EQ(warned.count, 1);
}

// The viewer goes away in the middle of a message, and another is there later.
TEST(Display, SendsEverythingToAViewerThatComesLater) {
    Film film(kRegion);
    Warned warned;
    auto first = std::make_unique<ViewerServer>(1000);
    const int port = first->Port();
    Display display(ParseDisplayAddress(first->Address()), "image", kRegion, warned.Sink());
    AddSamples(kRegion, &film);
    for (int i = 0; i < 1000 && warned.count == 0; ++i) {
        display.Show(kRegion, film);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    EXPECT_EQ(warned.count, 1);
    first.reset();
    ViewerServer second(std::numeric_limits<size_t>::max(), true, port);
    AddSamples({{50, 50}, {60, 60}}, &film);
    display.Show({{50, 50}, {60, 60}}, film);
    std::this_thread::sleep_for(std::chrono::milliseconds(3500));
    display.Finish(60);
    ASSERT_EQ(second.Finish().size(), 1u);
    ExpectSame(Reassemble(second.Finish()[0]), film, {});
    EXPECT_EQ(warned.count, 1);
}

// A viewer that reads nothing holds up neither those who show nor the end.
TEST(Display, WaitsForNobody) {
    ViewerServer server(0, false);
    const PixelRect large = {{0, 0}, {1000, 700}};  // 14 MB: more than sockets keep unread
    Film film(large);
    Warned warned;
    {
        Display display(ParseDisplayAddress(server.Address()), "image", large, warned.Sink());
        for (int i = 0; i < 20; ++i) {
            display.Show(large, film);
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        display.Finish(0.2);
    }
    EXPECT_EQ(warned.count, 0);
}

}  // namespace
}  // namespace lull
