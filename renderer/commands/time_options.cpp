#include "renderer/commands/time_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "renderer/base/clocks.h"
#include "renderer/commands/command.h"
#include "renderer/progress/forecast.h"

namespace lull {

namespace {

// Makes a validator of a function that throws.
template <typename Parse>
std::function<std::string(const std::string&)> CheckBy(const Parse& parse) {
    return [parse](const std::string& text) -> std::string {
        try {
            parse(text);
            return "";
        } catch (const std::invalid_argument& e) {
            return e.what();
        }
    };
}

}  // namespace

std::string ClockOptions::Text() const {
    return !time.empty() ? time : !until.empty() ? "until " + until : "";
}

void AddClockOptions(CLI::App& app, ClockOptions* options) {
    auto* time = app.add_option("--time", options->time,
                                "End after this wall-clock time, e.g. 90s, 10m or 1h30m")
                     ->group(kCommonOptions)
                     ->check(CheckBy([](const std::string& text) { ParseDuration(text); }))
                     ->type_name("TIME");
    app.add_option("--until", options->until, "End at this local time")
        ->group("Interruption")
        ->check(CheckBy([](const std::string& text) { NextTimeOfDay(text, 0); }))
        ->type_name("HH:MM")
        ->excludes(time);
}

std::function<double()> StartClock(const ClockOptions& options) {
    if (!options.time.empty()) {
        // Of the steady clock, as nobody sets that; of `until`, the one that people look at.
        using Clock = std::chrono::steady_clock;
        return [end = ParseDuration(options.time), start = Clock::now()] {
            return end - SecondsSince(start);
        };
    }
    if (options.until.empty()) return {};
    using Clock = std::chrono::system_clock;
    const auto end =
        Clock::from_time_t(NextTimeOfDay(options.until, Clock::to_time_t(Clock::now())));
    return [end] { return std::chrono::duration<double>(end - Clock::now()).count(); };
}

ProgressListener WarnOfFirstSamples(int64_t pixels, const Messages& messages,
                                    ProgressListener listener) {
    return [=, hasWarned = false](const RenderProgress& p) mutable {
        listener(p);
        constexpr int64_t kShare = 20;  // of the samples, from which their speed is taken
        if (hasWarned || !p.secondsLeft || p.samples >= pixels || p.samples < pixels / kShare)
            return;
        const double needed = p.seconds / double(p.samples) * double(pixels - p.samples);
        const double left = std::max(*p.secondsLeft, 0.);
        if (needed < 1.1 * left || needed < left + 1) return;
        hasWarned = true;
        messages.Warn(fmt::format(
            "the first sample of every pixel ends in about {}, but {} are left; a smaller "
            "--resolution takes less",
            FormatDuration(needed), FormatDuration(left)));
    };
}

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
