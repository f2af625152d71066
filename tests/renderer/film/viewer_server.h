// Stands in for the viewer tev: listens, records received packets, and assembles the image.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <thread>
#include <vector>

namespace lull {

// Listens on a free port of this machine. Records one connection after the other.
class ViewerServer {
  public:
    // `limit`: closes each connection after so many bytes. `reads`: whether it reads at all.
    explicit ViewerServer(size_t limit = std::numeric_limits<size_t>::max(), bool reads = true,
                          int port = 0)
        : limit(limit), reads(reads), listener(socket(AF_INET, SOCK_STREAM, 0)) {
        const int yes = 1;
        setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        sockaddr_in address = {};
        address.sin_family = AF_INET;
        address.sin_port = htons(uint16_t(port));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof address;
        EXPECT_EQ(bind(listener, reinterpret_cast<sockaddr*>(&address), size), 0);
        EXPECT_EQ(listen(listener, 4), 0);
        getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size);
        this->port = ntohs(address.sin_port);
        EXPECT_EQ(pipe(wake), 0);
        thread = std::thread([this] { Serve(); });
    }
    ~ViewerServer() {
        Finish();
        close(listener);
        close(wake[0]);
        close(wake[1]);
    }

    std::string Address() const { return "127.0.0.1:" + std::to_string(port); }
    int Port() const { return port; }

    // Waits for the connection under way to end, and returns the bytes of each.
    const std::vector<std::string>& Finish() {
        if (thread.joinable()) {
            EXPECT_EQ(write(wake[1], "x", 1), 1);
            thread.join();
        }
        return connections;
    }

  private:
    void Serve() {
        for (;;) {
            pollfd wanted[2] = {{listener, POLLIN, 0}, {wake[0], POLLIN, 0}};
            poll(wanted, 2, -1);
            if (!(wanted[0].revents & POLLIN)) return;
            const int peer = accept(listener, nullptr, nullptr);
            Take(peer);
            close(peer);
        }
    }
    void Take(int peer) {
        std::string& bytes = connections.emplace_back();
        if (!reads) {
            char ended;
            EXPECT_EQ(read(wake[0], &ended, 1), 1);
            EXPECT_EQ(write(wake[1], "x", 1), 1);
            return;
        }
        std::vector<char> buffer(1 << 16);
        while (bytes.size() < limit) {
            const ssize_t got =
                read(peer, buffer.data(), std::min(buffer.size(), limit - bytes.size()));
            if (got <= 0) return;
            bytes.append(buffer.data(), size_t(got));
        }
    }

    const size_t limit;
    const bool reads;
    const int listener;
    int port = 0;
    int wake[2];
    std::vector<std::string> connections;
    std::thread thread;
};

// An image as the messages make it.
struct ViewedImage {
    std::string name;
    int width = 0, height = 0, updates = 0;
    std::map<std::string, std::vector<float>> channels;  // row-major
};

// Reads numbers and texts, and says when there are none left.
class MessageReader {
  public:
    explicit MessageReader(const std::string& bytes) : bytes(bytes) {}
    template <typename T>
    T Get() {
        T value = {};
        if (at + sizeof(T) > bytes.size()) {
            ADD_FAILURE() << "a message ends too early";
            at = bytes.size();
            return value;
        }
        std::memcpy(&value, bytes.data() + at, sizeof(T));
        at += sizeof(T);
        return value;
    }
    std::string Text() {
        const size_t end = bytes.find('\0', at);
        if (end == std::string::npos) {
            ADD_FAILURE() << "a text does not end";
            return "";
        }
        const std::string text = bytes.substr(at, end - at);
        at = end + 1;
        return text;
    }
    bool AtEnd() const { return at >= bytes.size(); }
    size_t Place() const { return at; }

  private:
    const std::string& bytes;
    size_t at = 0;
};

// Follows the messages of one connection as tev does, and checks all that can be checked.
inline ViewedImage Reassemble(const std::string& bytes) {
    ViewedImage image;
    MessageReader reader(bytes);
    while (!reader.AtEnd() && !testing::Test::HasFailure()) {
        const size_t begin = reader.Place();
        const uint32_t length = reader.Get<uint32_t>();
        const int kind = reader.Get<uint8_t>();
        const int grabsFocus = reader.Get<uint8_t>();
        const std::string name = reader.Text();
        if (kind == 4) {
            EXPECT_EQ(begin, 0u) << "images are made once";
            EXPECT_EQ(grabsFocus, 1);
            image.name = name;
            image.width = reader.Get<int32_t>();
            image.height = reader.Get<int32_t>();
            for (int left = reader.Get<int32_t>(); left > 0; --left)
                image.channels[reader.Text()].resize(size_t(image.width) * size_t(image.height));
        } else if (kind == 6) {
            ++image.updates;
            EXPECT_EQ(grabsFocus, 0);
            EXPECT_EQ(name, image.name);
            const int count = reader.Get<int32_t>();
            std::vector<std::string> names;
            for (int c = 0; c < count; ++c) names.push_back(reader.Text());
            const int x = reader.Get<int32_t>(), y = reader.Get<int32_t>();
            const int width = reader.Get<int32_t>(), height = reader.Get<int32_t>();
            EXPECT_GE(std::min(x, y), 0);
            EXPECT_GE(std::min(width, height), 1);
            EXPECT_LE(x + width, image.width);
            EXPECT_LE(y + height, image.height);
            std::vector<int64_t> offsets, strides;
            for (int c = 0; c < count; ++c) offsets.push_back(reader.Get<int64_t>());
            for (int c = 0; c < count; ++c) strides.push_back(reader.Get<int64_t>());
            std::vector<float> values(size_t(width) * size_t(height) * size_t(count));
            for (float& v : values) v = reader.Get<float>();
            for (int c = 0; c < count && !testing::Test::HasFailure(); ++c)
                for (int i = 0; i < width * height; ++i)
                    image.channels.at(names[size_t(
                        c)])[size_t(y + i / width) * size_t(image.width) + size_t(x + i % width)] =
                        values.at(size_t(offsets[size_t(c)] + i * strides[size_t(c)]));
        } else {
            ADD_FAILURE() << "a message of kind " << kind;
        }
        EXPECT_EQ(reader.Place() - begin, length);
    }
    return image;
}

}  // namespace lull
