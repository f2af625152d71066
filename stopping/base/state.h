// Serialises the state of a criterion, or other data, to bytes of this machine and back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace lull {

class StateWriter {
  public:
    template <typename T>
    void Put(const T& value) {
        PutAll(std::span<const T>(&value, 1));
    }
    template <typename T>
    void PutAll(std::span<const T> values) {
        static_assert(std::is_trivially_copyable_v<T>);
        if (values.empty()) return;
        const size_t size = bytes.size();
        bytes.resize(size + values.size_bytes());
        std::memcpy(&bytes[size], values.data(), values.size_bytes());
    }
    // Writes the number of values before them.
    template <typename T>
    void PutVector(const std::vector<T>& values) {
        Put(uint64_t(values.size()));
        PutAll(std::span(values));
    }

    std::vector<std::byte> bytes;
};

// Reads the values of a StateWriter in the same order. All calls throw std::runtime_error if the
// bytes end too early; `what` names them in the message.
class StateReader {
  public:
    explicit StateReader(std::span<const std::byte> bytes, const char* what = "the saved state")
        : rest(bytes), what(what) {}

    template <typename T>
    T Get() {
        if constexpr (std::is_same_v<T, bool>) return Get<uint8_t>() != 0;  // damaged bytes as well
        T value;
        GetAll(std::span<T>(&value, 1));
        return value;
    }
    template <typename T>
    void GetAll(std::span<T> values) {
        static_assert(std::is_trivially_copyable_v<T>);
        if (rest.size() < values.size_bytes())
            throw std::runtime_error(std::string(what) + " is cut short");
        if (!values.empty()) std::memcpy(values.data(), rest.data(), values.size_bytes());
        rest = rest.subspan(values.size_bytes());
    }
    // Reads a vector of PutVector(). Throws std::runtime_error(damaged), before allocating memory,
    // for more values than the bytes can hold.
    template <typename T>
    std::vector<T> GetVector(const char* damaged) {
        const auto size = Get<uint64_t>();
        if (size > rest.size() / sizeof(T)) throw std::runtime_error(damaged);
        std::vector<T> values(size);
        GetAll(std::span(values));
        return values;
    }
    size_t Left() const { return rest.size(); }
    // Checks that nothing is left.
    void Finish() const {
        if (!rest.empty()) throw std::runtime_error(std::string(what) + " is longer than expected");
    }
    // Checks that the next value is `tag`, which tells different kinds of states apart.
    void Expect(uint32_t tag) {
        if (Get<uint32_t>() != tag)
            throw std::runtime_error(std::string(what) + " is of another kind");
    }

  private:
    std::span<const std::byte> rest;
    const char* what;
};

}  // namespace lull
