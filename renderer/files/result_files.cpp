#include "renderer/files/result_files.h"

#include <fmt/core.h>
#include <stdlib.h>

#include <filesystem>

#include "renderer/base/error.h"
#include "renderer/files/file_io.h"
#include "stopping/base/parallel.h"

namespace lull {

namespace {

namespace fs = std::filesystem;

// Makes a folder of a new name; "" where that cannot be done.
std::string MakeNewFolder() {
    std::error_code error;
    const fs::path parent = fs::temp_directory_path(error);
    std::string folder = (error ? fs::path("/tmp") : parent) / "lull-XXXXXX";
    return mkdtemp(folder.data()) ? folder : "";
}

void Append(const std::string& text, const char* separator, std::string* list) {
    *list += (list->empty() ? "" : separator) + text;
}

}  // namespace

void ResultFiles::Write(const std::string& path, const Writer& write) { WriteAll({{path, write}}); }

void ResultFiles::WriteAll(const std::vector<File>& files) {
    std::vector<std::optional<std::string>> failed(files.size());
    ForEachIndex(int(files.size()), [&](int i) {
        try {
            files[size_t(i)].write(files[size_t(i)].path);
        } catch (const Error& e) {
            failed[size_t(i)] = e.what();
        }
    });
    for (size_t i = 0; i < files.size(); ++i) Note(files[i], failed[i]);
}

// Keeps the name of a file that was written, or writes it elsewhere.
void ResultFiles::Note(const File& file, const std::optional<std::string>& failure) {
    if (!failure) return names.push_back(file.path);
    Append(*failure, "; ", &failures);
    if (rescue == Rescue::None) return;
    const bool isRescued = WriteElsewhere(file.path, file.write);
    Append(fmt::format("\"{}\"", file.path), ", ", isRescued ? &rescued : &lost);
}

void ResultFiles::WriteText(const std::string& path, const std::string& text) {
    Write(path, [&](const std::string& file) { WriteFileAtomically(file, text); });
}

bool ResultFiles::WriteElsewhere(const std::string& path, const Writer& write) try {
    if (folder.empty()) folder = MakeNewFolder();
    if (folder.empty()) return false;
    const std::string other = fs::path(folder) / fs::path(path).filename();
    write(other);
    names.push_back(other);
    return true;
} catch (const Error&) {
    std::error_code error;
    if (fs::remove(folder, error)) folder.clear();  // it is empty
    return false;
}

void ResultFiles::RemoveOld(const std::string& path) {
    std::error_code error;
    if (fs::is_regular_file(path, error)) fs::remove(path, error);
}

void ResultFiles::Check() const {
    if (failures.empty()) return;
    std::string text = failures;
    if (!rescued.empty()) text += fmt::format("; in {1} instead: {0}", rescued, folder);
    if (!lost.empty()) text += fmt::format("; lost: {}", lost);
    throw Error(text);
}

}  // namespace lull
