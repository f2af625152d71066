#include "renderer/film/display/tev_messages.h"

#include <bit>
#include <cstring>

namespace lull::tev {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they are");

enum class Kind : uint8_t { CreateImage = 4, UpdateImageV3 = 6 };

class Message {
  public:
    explicit Message(Kind kind) {
        Put(uint32_t(0));
        Put(kind);
    }
    template <typename T>
    void Put(const T& value) {
        PutAll(std::span(&value, 1));
    }
    template <typename T>
    void PutAll(std::span<T> values) {
        const auto more = std::as_bytes(values);
        bytes.insert(bytes.end(), more.begin(), more.end());
    }
    void Text(const std::string& text) {
        PutAll(std::span<const char>(text.c_str(), std::strlen(text.c_str()) + 1));
    }
    std::vector<std::byte> Finish() {
        const uint32_t size = uint32_t(bytes.size());
        std::memcpy(bytes.data(), &size, sizeof size);
        return std::move(bytes);
    }

  private:
    std::vector<std::byte> bytes;
};

}  // namespace

std::vector<std::byte> CreateImage(const std::string& name, int width, int height,
                                   std::span<const std::string> channels) {
    Message message(Kind::CreateImage);
    message.Put(uint8_t(1));  // come to the front
    message.Text(name);
    message.Put(int32_t(width));
    message.Put(int32_t(height));
    message.Put(int32_t(channels.size()));
    for (const std::string& channel : channels) message.Text(channel);
    return message.Finish();
}

std::vector<std::byte> UpdateImage(const std::string& name, std::span<const std::string> channels,
                                   int x, int y, int width, int height,
                                   std::span<const float> values) {
    Message message(Kind::UpdateImageV3);
    message.Put(uint8_t(0));  // stay where it is
    message.Text(name);
    message.Put(int32_t(channels.size()));
    for (const std::string& channel : channels) message.Text(channel);
    for (const int n : {x, y, width, height}) message.Put(int32_t(n));
    // Where each channel begins, and how far apart its values are.
    for (size_t c = 0; c < channels.size(); ++c) message.Put(int64_t(c));
    for (size_t c = 0; c < channels.size(); ++c) message.Put(int64_t(channels.size()));
    message.PutAll(values);
    return message.Finish();
}

}  // namespace lull::tev
