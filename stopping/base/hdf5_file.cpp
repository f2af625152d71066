#include "stopping/base/hdf5_file.h"

#include <hdf5.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <type_traits>

#include "stopping/base/input_file.h"

namespace lull {

namespace {

constexpr std::string_view kSignature("GCOL\1\0\0\0", 8);  // with the version
constexpr size_t kHeaderBytes = 16, kChunkBytes = size_t(1) << 20;

template <typename T>
T Load(std::span<const char> bytes, size_t at) {
    T value;
    std::memcpy(&value, &bytes[at], sizeof(T));
    return value;
}

void CheckHeap(std::span<const char> bytes) {
    for (size_t at = kHeaderBytes; at + kHeaderBytes <= bytes.size();) {
        const bool isFreeSpace = Load<uint16_t>(bytes, at) == 0;
        const auto size = Load<uint64_t>(bytes, at + 8);
        const size_t rest = bytes.size() - at;
        // The size of free space includes its header.
        if (isFreeSpace && size >= kHeaderBytes && size <= rest)
            at += size;
        else if (!isFreeSpace && size <= rest)
            at += kHeaderBytes + (size + 7) / 8 * 8;
        else
            throw std::runtime_error("cannot read its texts: a heap of them is damaged");
    }
}

// Throws std::runtime_error if an object in a global heap of the file, where texts of variable
// length are kept, has no end: up to version 1.14 the library searches behind it for ever. Heaps
// are found by their signature ("HDF5 File Format Specification", III.E), lengths have 8 bytes.
void CheckGlobalHeaps(std::FILE* file) {
    if (std::fseek(file, 0, SEEK_END) != 0) return;
    const long end = std::ftell(file);
    std::vector<char> bytes;
    const auto read = [&](long start, uint64_t most) -> std::span<const char> {
        bytes.resize(size_t(std::min(most, uint64_t(end - start))));
        if (std::fseek(file, start, SEEK_SET) != 0) return {};
        return {bytes.data(), std::fread(bytes.data(), 1, bytes.size(), file)};
    };
    for (long start = 0; end - start >= long(kHeaderBytes);) {
        const std::span<const char> chunk = read(start, kChunkBytes);
        if (chunk.size() < kHeaderBytes) return;
        const size_t found = std::string_view(chunk.data(), chunk.size()).find(kSignature);
        if (found == std::string_view::npos) {
            start += long(chunk.size() - kSignature.size() + 1);  // one may lie across the end
        } else if (found > 0) {
            start += long(found);  // the heap begins the next chunk
        } else {
            CheckHeap(read(start, Load<uint64_t>(chunk, 8)));
            start += long(kSignature.size());
        }
    }
}

static_assert(std::is_same_v<hid_t, int64_t>);

using Close = herr_t (*)(hid_t);

[[noreturn]] void Fail(const std::string& what) { throw std::runtime_error("cannot " + what); }

void Check(herr_t status, const std::string& what) {
    if (status < 0) Fail(what);
}

// Owns an identifier, which is negative if the call that returns it has failed.
class Handle {
  public:
    Handle(hid_t id, Close close, const std::string& what) : id(id), close(close) {
        if (id < 0) Fail(what);
    }
    ~Handle() { close(id); }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    operator hid_t() const { return id; }

  private:
    hid_t id;
    Close close;
};

// How to make a file, a group or a data set without its times, as the same content gives the same
// bytes then. HDF5 2 keeps them of files and groups, too.
class Timeless : public Handle {
  public:
    Timeless(hid_t kind, const std::string& what) : Handle(H5Pcreate(kind), H5Pclose, what) {
        Check(H5Pset_obj_track_times(*this, false), what);
    }
};

std::shared_ptr<const int64_t> Share(hid_t id, Close close, const std::string& what) {
    if (id < 0) Fail(what);
    return {new int64_t(id), [close](const int64_t* owned) {
                close(*owned);
                delete owned;
            }};
}

void BeQuiet() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

std::vector<int64_t> ShapeOf(hid_t space) {
    const int rank = H5Sget_simple_extent_ndims(space);
    std::vector<hsize_t> shape(size_t(std::max(0, rank)));
    if (rank > 0) H5Sget_simple_extent_dims(space, shape.data(), nullptr);
    return {shape.begin(), shape.end()};
}

// Fails if a file declares an array larger than deflate could make of the whole file: no memory is
// allocated for data that cannot be there.
void CheckSize(hid_t data, size_t count, size_t elementSize, const std::string& what) {
    constexpr double kMostCompressed = 1100;
    const Handle file(H5Iget_file_id(data), H5Fclose, what);
    hsize_t size = 0;
    Check(H5Fget_filesize(file, &size), what);
    if (double(count) * double(elementSize) > kMostCompressed * double(size))
        Fail(what + ": it is damaged, and would be larger than the file");
}

size_t Count(hid_t space) {
    return size_t(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space)));
}

// The library's names of the C++ type T. (They are variables, set when it starts.)
template <typename T>
struct ElementType {
    static constexpr bool kIsReal = std::is_floating_point_v<T>;
    static constexpr H5T_class_t kClass = kIsReal ? H5T_FLOAT : H5T_INTEGER;
    static constexpr const char* kName = kIsReal ? "floating-point numbers" : "integers";

    static hid_t File() {
        if constexpr (kIsReal) return sizeof(T) == 4 ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
        return sizeof(T) == 4 ? H5T_STD_I32LE : H5T_STD_U8LE;
    }
    static hid_t Memory() {
        if constexpr (kIsReal) return sizeof(T) == 4 ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE;
        return sizeof(T) == 4 ? H5T_NATIVE_INT32 : H5T_NATIVE_UINT8;
    }
};

void WriteAttribute(hid_t object, const std::string& name, hid_t type, hid_t space,
                    const void* data) {
    const std::string what = "write attribute '" + name + "'";
    const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose, what);
    Check(H5Awrite(attribute, type, data), what);
}

template <typename T>
void WriteScalar(hid_t object, const std::string& name, T value) {
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "make a scalar");
    WriteAttribute(object, name, ElementType<T>::Memory(), space, &value);
}

template <typename T>
T ReadScalar(hid_t object, const std::string& name, const char* kind) {
    const std::string what = "read attribute '" + name + "', which must be " + kind;
    const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, what);
    const Handle type(H5Aget_type(attribute), H5Tclose, what);
    const Handle space(H5Aget_space(attribute), H5Sclose, what);
    if (H5Tget_class(type) != ElementType<T>::kClass || Count(space) != 1) Fail(what);
    T value = 0;
    Check(H5Aread(attribute, ElementType<T>::Memory(), &value), what);
    return value;
}

}  // namespace

Hdf5Group Hdf5Group::Open(const std::string& path) {
    BeQuiet();
    // The library does not say why it cannot.
    if (const std::string reason = ReasonNotToRead(path); !reason.empty())
        Fail("open it: " + reason);
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                               std::fclose);
    if (!file) Fail(std::string("open it: ") + std::strerror(errno));
    CheckGlobalHeaps(file.get());
    return Hdf5Group(
        Share(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "open it as HDF5"));
}

Hdf5Group Hdf5Group::Create(const std::string& path) {
    BeQuiet();
    const Timeless options(H5P_FILE_CREATE, "create it");
    return Hdf5Group(
        Share(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, options, H5P_DEFAULT), H5Fclose, "create it"));
}

Hdf5Group Hdf5Group::CreateInMemory() {
    BeQuiet();
    const std::string what = "make a file in memory";
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, what);
    Check(H5Pset_fapl_core(access, size_t(1) << 20, false), what);
    const Timeless options(H5P_FILE_CREATE, what);
    return Hdf5Group(Share(H5Fcreate("memory", H5F_ACC_TRUNC, options, access), H5Fclose, what));
}

std::span<const std::byte> Hdf5Group::Content() {
    Flush();
    const ssize_t size = H5Fget_file_image(*id, nullptr, 0);
    void* handle = nullptr;  // points to the driver's pointer
    if (size < 0 || H5Fget_vfd_handle(*id, H5P_DEFAULT, &handle) < 0) Fail("read a file in memory");
    return {*static_cast<const std::byte**>(handle), static_cast<size_t>(size)};
}

void Hdf5Group::Flush() { Check(H5Fflush(*id, H5F_SCOPE_GLOBAL), "write it to the end"); }

bool Hdf5Group::Has(const std::string& name) const {
    return H5Lexists(*id, name.c_str(), H5P_DEFAULT) > 0;
}

Hdf5Group Hdf5Group::Group(const std::string& name) const {
    return Hdf5Group(
        Share(H5Gopen2(*id, name.c_str(), H5P_DEFAULT), H5Gclose, "find the group '" + name + "'"));
}

Hdf5Group Hdf5Group::MakeGroup(const std::string& name) {
    const std::string what = "make the group '" + name + "'";
    const Timeless options(H5P_GROUP_CREATE, what);
    return Hdf5Group(
        Share(H5Gcreate2(*id, name.c_str(), H5P_DEFAULT, options, H5P_DEFAULT), H5Gclose, what));
}

std::vector<std::string> Hdf5Group::Groups() const {
    std::vector<std::string> names;
    const auto visit = [](hid_t, const char* name, const H5L_info_t*, void* data) -> herr_t {
        static_cast<std::vector<std::string>*>(data)->push_back(name);
        return 0;
    };
    Check(H5Literate(*id, H5_INDEX_NAME, H5_ITER_INC, nullptr, visit, &names), "list the groups");
    std::erase_if(names, [&](const std::string& name) {
        const hid_t group = H5Gopen2(*id, name.c_str(), H5P_DEFAULT);
        if (group >= 0) H5Gclose(group);
        return group < 0;
    });
    return names;
}

bool Hdf5Group::HasAttribute(const std::string& name) const {
    return H5Aexists(*id, name.c_str()) > 0;
}

int Hdf5Group::Int(const std::string& name) const {
    return ReadScalar<int>(*id, name, "an integer");
}

double Hdf5Group::Real(const std::string& name) const {
    return ReadScalar<double>(*id, name, "a real number");
}

std::vector<std::string> Hdf5Group::Strings(const std::string& name) const {
    const std::string what = "read attribute '" + name + "', which must be text";
    const Handle attribute(H5Aopen(*id, name.c_str(), H5P_DEFAULT), H5Aclose, what);
    const Handle type(H5Aget_type(attribute), H5Tclose, what);
    const Handle space(H5Aget_space(attribute), H5Sclose, what);
    if (H5Tget_class(type) != H5T_STRING) Fail(what);
    std::vector<std::string> strings(Count(space));
    if (strings.empty()) return strings;

    if (H5Tis_variable_str(type) > 0) {
        std::vector<char*> texts(strings.size(), nullptr);
        Check(H5Aread(attribute, type, texts.data()), what);
        for (size_t i = 0; i < texts.size(); ++i)
            if (texts[i]) strings[i] = texts[i];
        H5Dvlen_reclaim(type, space, H5P_DEFAULT, texts.data());
    } else {
        const size_t size = H5Tget_size(type);
        std::vector<char> texts(strings.size() * size);
        Check(H5Aread(attribute, type, texts.data()), what);
        for (size_t i = 0; i < strings.size(); ++i)
            strings[i].assign(&texts[i * size], strnlen(&texts[i * size], size));
    }
    return strings;
}

std::string Hdf5Group::String(const std::string& name) const {
    const std::vector<std::string> strings = Strings(name);
    if (strings.size() != 1) Fail("read attribute '" + name + "', which must be one text");
    return strings[0];
}

void Hdf5Group::SetInt(const std::string& name, int value) { WriteScalar(*id, name, value); }

void Hdf5Group::SetReal(const std::string& name, double value) { WriteScalar(*id, name, value); }

void Hdf5Group::SetString(const std::string& name, const std::string& text) {
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "make a scalar");
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "make a text type");
    Check(H5Tset_size(type, H5T_VARIABLE), "make a text type");
    const char* pointer = text.c_str();
    WriteAttribute(*id, name, type, space, &pointer);
}

// Writes one array of texts of the same length, padded with zeros, as Keras does through h5py.
void Hdf5Group::SetStrings(const std::string& name, std::span<const std::string> texts) {
    size_t size = 1;
    for (const std::string& text : texts) size = std::max(size, text.size());
    std::vector<char> padded(size * texts.size());
    for (size_t i = 0; i < texts.size(); ++i)
        std::copy(texts[i].begin(), texts[i].end(), padded.begin() + ptrdiff_t(i * size));
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "make a text type");
    Check(H5Tset_size(type, size), "make a text type");
    Check(H5Tset_strpad(type, H5T_STR_NULLPAD), "make a text type");
    const hsize_t count = texts.size();
    const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose, "make an array of texts");
    WriteAttribute(*id, name, type, space, padded.data());
}

std::vector<int64_t> Hdf5Group::Shape(const std::string& path) const {
    const std::string what = "find the array '" + path + "'";
    const Handle data(H5Dopen2(*id, path.c_str(), H5P_DEFAULT), H5Dclose, what);
    const Handle space(H5Dget_space(data), H5Sclose, what);
    return ShapeOf(space);
}

template <typename T>
std::vector<T> Hdf5Group::Array(const std::string& path, std::span<const int64_t> shape) const {
    const std::string what = "read the array '" + path + "'";
    const Handle data(H5Dopen2(*id, path.c_str(), H5P_DEFAULT), H5Dclose, what);
    const Handle space(H5Dget_space(data), H5Sclose, what);
    const Handle type(H5Dget_type(data), H5Tclose, what);
    if (!std::ranges::equal(ShapeOf(space), shape)) {
        std::string text;
        for (int64_t n : shape) text += (text.empty() ? "" : " x ") + std::to_string(n);
        Fail(what + ": it does not have the shape " + text);
    }
    if (H5Tget_class(type) != ElementType<T>::kClass)
        Fail(what + ": it holds no " + ElementType<T>::kName);
    CheckSize(data, Count(space), sizeof(T), what);
    std::vector<T> values(Count(space));
    Check(H5Dread(data, ElementType<T>::Memory(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
          what);
    return values;
}

template <typename T>
void Hdf5Group::AddArray(const std::string& path, std::span<const int64_t> shape,
                         std::span<const T> values, Hdf5Storage storage) {
    const std::string what = "write the array '" + path + "'";
    const std::vector<hsize_t> size(shape.begin(), shape.end());
    const Handle space(H5Screate_simple(int(size.size()), size.data(), nullptr), H5Sclose, what);
    if (Count(space) != values.size()) Fail(what + ": its values do not fill its shape");
    const Timeless options(H5P_DATASET_CREATE, what);
    if (storage == Hdf5Storage::Compressed && !values.empty()) {
        Check(H5Pset_chunk(options, int(size.size()), size.data()), what);
        Check(H5Pset_shuffle(options), what);
        Check(H5Pset_deflate(options, 9), what);
    }
    const Handle data(H5Dcreate2(*id, path.c_str(), ElementType<T>::File(), space, H5P_DEFAULT,
                                 options, H5P_DEFAULT),
                      H5Dclose, what);
    Check(H5Dwrite(data, ElementType<T>::Memory(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
          what);
}

template std::vector<float> Hdf5Group::Array(const std::string&, std::span<const int64_t>) const;
template std::vector<double> Hdf5Group::Array(const std::string&, std::span<const int64_t>) const;
template std::vector<int32_t> Hdf5Group::Array(const std::string&, std::span<const int64_t>) const;
template std::vector<std::byte> Hdf5Group::Array(const std::string&,
                                                 std::span<const int64_t>) const;
template void Hdf5Group::AddArray(const std::string&, std::span<const int64_t>,
                                  std::span<const float>, Hdf5Storage);
template void Hdf5Group::AddArray(const std::string&, std::span<const int64_t>,
                                  std::span<const double>, Hdf5Storage);
template void Hdf5Group::AddArray(const std::string&, std::span<const int64_t>,
                                  std::span<const int32_t>, Hdf5Storage);
template void Hdf5Group::AddArray(const std::string&, std::span<const int64_t>,
                                  std::span<const std::byte>, Hdf5Storage);

}  // namespace lull
