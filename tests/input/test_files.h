// Gives input tests files of their own, and finds the shared scenes.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "renderer/base/error.h"
#include "renderer/input/pbrt_parser.h"

namespace lull {

// Makes a folder that lives as long as the object.
class TestFolder {
  public:
    TestFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "lull-XXXXXX").string();
        if (!mkdtemp(name.data())) throw Error("cannot make a folder for the test");
        folder = name;
    }
    ~TestFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
    }
    TestFolder(const TestFolder&) = delete;
    TestFolder& operator=(const TestFolder&) = delete;

    std::string Path(const std::string& name) const { return (folder / name).string(); }

    // Writes a file and returns its path.
    std::string Write(const std::string& name, std::string_view contents) const {
        std::filesystem::create_directories((folder / name).parent_path());
        // A new file, for some file systems wait for the disk when an old one is cut to nothing.
        std::filesystem::remove(folder / name);
        std::ofstream out(folder / name, std::ios::binary);
        out.write(contents.data(), std::streamsize(contents.size()));
        out.close();
        if (!out) throw Error("cannot write " + Path(name));
        return Path(name);
    }

    Description Parse(std::string_view text, Warnings* warnings = nullptr,
                      const ParseOptions& options = {}) const {
        Warnings ignored;
        return ParsePbrt(Write("scene.pbrt", text), options, warnings ? *warnings : ignored);
    }

    // Parses the text between WorldBegin and WorldEnd, on line 1.
    Description ParseWorld(std::string_view text, Warnings* warnings = nullptr) const {
        return Parse("WorldBegin " + std::string(text) + "\nWorldEnd\n", warnings);
    }

    // Returns the message of the Error that `text` gives, without the folder's name; "" for none.
    std::string ErrorOf(std::string_view text, const ParseOptions& options = {}) const {
        return MessageOf([&] { Parse(text, nullptr, options); });
    }

    template <typename Function>
    std::string MessageOf(const Function& function) const {
        try {
            function();
        } catch (const Error& error) {
            std::string message = error.what();
            const std::string prefix = folder.string() + "/";
            for (size_t at; (at = message.find(prefix)) != std::string::npos;)
                message.erase(at, prefix.size());
            return message;
        }
        return "";
    }

  private:
    std::filesystem::path folder;
};

// Returns the folder with the shared data; it need not be there.
inline std::filesystem::path SharedFolder() {
    const char* set = getenv("LULL_SHARED");
    return set && *set ? set : LULL_SHARED_DIR;
}

}  // namespace lull
