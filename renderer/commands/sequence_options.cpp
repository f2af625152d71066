#include "renderer/commands/sequence_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

namespace lull {

namespace {

constexpr double kMostFrames = 99999;

// Reads FROM:TO:FPS.
std::optional<Sequence> ParseSequence(const std::string& text) {
    Sequence sequence;
    const char* at = text.data();
    const char* const end = at + text.size();
    for (double* value : {&sequence.from, &sequence.to, &sequence.fps}) {
        if (value != &sequence.from && (at == end || *at++ != ':')) return {};
        const auto [next, error] = std::from_chars(at, end, *value);
        if (error != std::errc()) return {};
        at = next;
    }
    if (at != end && std::string(at, end) != "fps") return {};
    const auto& [from, to, fps] = sequence;
    const bool isValid = 0 <= from && from <= to && to <= 1e9 && 0 < fps &&
                         (to - from) * fps <= kMostFrames;  // false for NaN, too
    return isValid ? std::optional(sequence) : std::nullopt;
}

}  // namespace

int Sequence::Count() const {
    // 2 s at 24 fps are 48 frames, though 1/24 is not exact.
    return std::max(1, int(std::ceil((to - from) * fps - 1e-6)));
}

void AddSequenceOptions(CLI::App& app, std::optional<Sequence>* sequence) {
    CLI::Option* frame = app.get_option("--frame");
    app.add_option_function<std::string>(
           "--frames",
           [=](const std::string& text) {
               *sequence = ParseSequence(text);
               if (!*sequence)
                   throw CLI::ValidationError(text,
                                              "is not FROM:TO:FPS such as 0:2:24fps, with 0 "
                                              "<= FROM <= TO and at most 99999 frames");
           },
           "glTF: render the frames from FROM to TO seconds, as OUT.0001.exr, ...")
        ->group("Scene")
        ->type_name("FROM:TO:FPS")
        ->excludes(frame);
    for (const char* name : {"--animation", "--shutter"}) app.get_option(name)->remove_needs(frame);
}

std::string NumberedFile(const std::string& file, int number) {
    if (file.empty()) return file;
    const std::filesystem::path path = file;
    return std::filesystem::path(path)
        .replace_extension(fmt::format(".{:04}{}", number, path.extension().string()))
        .string();
}

}  // namespace lull
