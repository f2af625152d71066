// Reads OpenEXR files: scan lines and tiles (at full size). Several parts are read as one, of their
// channels: a part that has names of others gets its view, or its own name, before them. Left out
// are deep parts, and those of another window than the picture's.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "renderer/formats/formats.h"
#include "renderer/image/image_io.h"

namespace lull {

bool IsExr(std::span<const std::byte> bytes);

// An EXR of which only the header has been read.
class ExrFile {
  public:
    // The bytes must outlive it. Throws std::runtime_error, or exceptions of OpenEXR, with the
    // reason: no EXR, deep data, or channels of fewer pixels than others.
    explicit ExrFile(std::span<const std::byte> bytes);
    ~ExrFile();

    // Returns an image without channels.
    ExrImage Header() const;
    // Lists the channels as SortChannels() does.
    const std::vector<std::string>& Channels() const { return channels; }
    // Takes these channels alone, in this order. Those that the file lacks are read as 0.
    void Choose(std::vector<std::string> names) { channels = std::move(names); }
    bool IsHalf(const std::string& channel) const;
    // As ImageFile::Chromaticities(); nothing for the primaries of Rec. 709.
    std::optional<std::array<float, 8>> Chromaticities() const;
    // Read the first `count` channels side by side, as halves, if all are, or as floats; integers
    // become 0 to 1. Read() takes the data window, ReadDisplayed() the display window, 0 where the
    // file has no data. Throw as the constructor does.
    void Read(TexelType type, size_t count, void* texels);
    void ReadDisplayed(TexelType type, size_t count, void* texels);

  private:
    void ReadRows(TexelType type, size_t count, int first, int last, char* texels);

    struct Parts;
    std::unique_ptr<Parts> parts;
    std::vector<std::string> channels;
};

// Opens an EXR as a picture, its display window, with the channels that PictureChannels() chooses,
// halves where all are. As OpenPng() otherwise.
std::unique_ptr<ImageFile> OpenExr(std::span<const std::byte> bytes);

// OpenEXR compresses strips of a file on threads of its own, which the whole program shares:
// starts a thread per processor, once, and returns their number.
int UseExrThreads();

}  // namespace lull
