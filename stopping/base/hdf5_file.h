// Reads and writes HDF5 files: the small part of the format that lull uses. Only hdf5_file.cpp
// includes the library, which allows one thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace lull {

enum class Hdf5Storage { Plain, Compressed };

// Represents a group of an open file; the first one is its root. Copies represent the same group,
// and the file is closed with the last of them. All functions throw std::runtime_error naming the
// failed operation; none of the messages names the file.
class Hdf5Group {
  public:
    // Opens a file for reading, or creates one (replacing an old one) for writing.
    static Hdf5Group Open(const std::string& path);
    static Hdf5Group Create(const std::string& path);
    // Creates a file in memory; Content() returns its bytes, valid until something is added.
    static Hdf5Group CreateInMemory();
    std::span<const std::byte> Content();
    void Flush();

    bool Has(const std::string& name) const;
    Hdf5Group Group(const std::string& name) const;
    Hdf5Group MakeGroup(const std::string& name);
    // Returns the names of the groups in this one, in alphabetical order.
    std::vector<std::string> Groups() const;

    // Read and write attributes. Strings may be of fixed or variable length and text encoding.
    bool HasAttribute(const std::string& name) const;
    int Int(const std::string& name) const;
    double Real(const std::string& name) const;  // floating-point numbers only
    std::string String(const std::string& name) const;
    std::vector<std::string> Strings(const std::string& name) const;
    void SetInt(const std::string& name, int value);
    void SetReal(const std::string& name, double value);
    void SetString(const std::string& name, const std::string& text);
    void SetStrings(const std::string& name, std::span<const std::string> texts);

    // Read and write arrays of T, one of float, double, int32_t and std::byte, row-major. Array()
    // checks the shape before it allocates memory.
    std::vector<int64_t> Shape(const std::string& path) const;
    template <typename T>
    std::vector<T> Array(const std::string& path, std::span<const int64_t> shape) const;
    template <typename T>
    void AddArray(const std::string& path, std::span<const int64_t> shape,
                  std::span<const T> values, Hdf5Storage storage = Hdf5Storage::Plain);

  private:
    using Id = std::shared_ptr<const int64_t>;
    explicit Hdf5Group(Id id) : id(std::move(id)) {}

    Id id;
};

}  // namespace lull
