// Writes the results of long work so that one file that cannot be written does not cost the others,
// nor itself.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace lull {

// Treatment of a file that cannot be written: it goes elsewhere, or is left out.
enum class Rescue { Elsewhere, None };

class ResultFiles {
  public:
    using Writer = std::function<void(const std::string& path)>;

    ResultFiles(Rescue rescue = Rescue::Elsewhere) : rescue(rescue) {}

    // Calls write(path). Where that throws Error, calls it for a file of the same name in a new
    // folder where temporary files go ($TMPDIR, else /tmp). Check() tells of it.
    void Write(const std::string& path, const Writer& write);
    // Does so for several files at the same time, on all threads.
    struct File {
        std::string path;
        Writer write;
    };
    void WriteAll(const std::vector<File>&);
    void WriteText(const std::string& path, const std::string& text);

    // Removes the file that earlier work has left there, so that it is not taken for one of these.
    // Nothing else than a file is removed.
    static void RemoveOld(const std::string& path);

    // Returns the files that were written, wherever they are, in that order.
    const std::vector<std::string>& Names() const { return names; }
    // Throws Error if a file is not where it should be; it says why, and where it is.
    void Check() const;

  private:
    void Note(const File&, const std::optional<std::string>& failure);
    bool WriteElsewhere(const std::string& path, const Writer& write);

    Rescue rescue;
    std::vector<std::string> names;
    std::string folder;  // empty: there was no need for one
    std::string failures, rescued, lost;
};

}  // namespace lull
