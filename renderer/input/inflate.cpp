#include "renderer/input/inflate.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace lull {
namespace {

// Bounds the growth: meshes pack to a tenth at best, a run of zeros to a thousandth.
constexpr size_t kMostExpansion = 200;
constexpr size_t kAlwaysAllowed = size_t(64) << 20;

class Stream {
  public:
    Stream() { isOpen = inflateInit2(&z, 15 + 16) == Z_OK; }  // 16: expects a gzip header
    ~Stream() {
        if (isOpen) inflateEnd(&z);
    }
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;

    z_stream z{};
    bool isOpen;
};

void Grow(FileContents* contents, size_t used, size_t size) {
    auto larger = std::make_unique_for_overwrite<char[]>(size);
    if (used > 0) std::memcpy(larger.get(), contents->bytes.get(), used);
    contents->bytes = std::move(larger);
    contents->size = size;
}

}  // namespace

FileContents Inflated(FileContents packed, const FileLoc& loc) {
    if (!packed.View().starts_with("\x1f\x8b")) return packed;
    Stream stream;
    if (!stream.isOpen) throw Error(loc, "no memory to unpack it");
    const size_t limit = std::max(kAlwaysAllowed, kMostExpansion * packed.size);
    FileContents result;
    Grow(&result, 0, std::min(limit, std::max<size_t>(4 * packed.size, 4096)));
    size_t read = 0, written = 0;
    for (;;) {
        if (written == result.size) {
            if (written >= limit)
                throw Error(loc, "unpacks to more than " + std::to_string(limit) +
                                     " bytes; unpack it by hand if it is right");
            Grow(&result, written, std::min(limit, 2 * result.size));
        }
        // zlib counts in 32 bits.
        const size_t in = std::min<size_t>(packed.size - read, 1u << 30);
        const size_t out = std::min<size_t>(result.size - written, 1u << 30);
        stream.z.next_in = reinterpret_cast<Bytef*>(packed.bytes.get() + read);
        stream.z.avail_in = uInt(in);
        stream.z.next_out = reinterpret_cast<Bytef*>(result.bytes.get() + written);
        stream.z.avail_out = uInt(out);
        const int status = inflate(&stream.z, Z_NO_FLUSH);
        read += in - stream.z.avail_in;
        written += out - stream.z.avail_out;
        if (status == Z_STREAM_END) {
            // Files joined together are one file.
            const bool more = packed.View().substr(read).starts_with("\x1f\x8b");
            if (!more || inflateReset(&stream.z) != Z_OK) break;
        } else if (status != Z_OK || (read == packed.size && stream.z.avail_out > 0)) {
            throw Error(loc, "the gzip'd data are damaged or cut short");
        }
    }
    result.size = written;
    return result;
}

}  // namespace lull
