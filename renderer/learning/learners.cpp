#include "renderer/learning/learners.h"

#include <chrono>

#include "renderer/base/clocks.h"
#include "renderer/learning/learner_state.h"

namespace lull {

namespace {

constexpr uint32_t kTag = 0x37756c67;

// Adds the time until the end of its scope.
class Stopwatch {
  public:
    explicit Stopwatch(double* seconds) : seconds(seconds) {}
    ~Stopwatch() { *seconds += SecondsSince(start); }

  private:
    using Clock = std::chrono::steady_clock;
    double* seconds;
    const Clock::time_point start = Clock::now();
};

}  // namespace

Learners::Learners(const Scene& scene, const LearningOptions& options, int64_t pixels) {
    ForEachOptional(kinds, [&]<typename Kind>(std::optional<Kind>& kind) {
        if (Kind::IsWanted(scene, options)) kind.emplace(scene, options, pixels);
    });
    SetPaths();
}

int Learners::RoundEnd() const {
    int end = kNoRoundEnd;
    ForEachPresent(kinds, [&](const auto& kind) { end = std::min(end, kind.RoundEnd()); });
    return end;
}

void Learners::Begin(const Schedule& schedule) {
    ForEachPresent(kinds, [&](auto& kind) { kind.Begin(schedule); });
    SetPaths();
}

double Learners::Variance(const Film& film, const PixelRect& part) const {
    double variance = 1;
    ForEachPresent(kinds, [&](const auto& kind) { variance *= kind.Variance(film, part); });
    return variance;
}

SampleSpread* Learners::SpreadOf(Film* film, const PixelRect& tile) {
    SampleSpread* spread = nullptr;
    ForEachPresent(kinds, [&](auto& kind) {
        if (!spread) spread = kind.SpreadOf(film, tile);
    });
    return spread;
}

void Learners::EndRound(Film* film, const lull::RoundEnd& ended) {
    const Stopwatch stopwatch(&seconds);
    ForEachPresent(kinds, [&](auto& kind) { kind.EndRound(film, ended); });
    SetPaths();
}

void Learners::SetPaths() {
    paths = Estimator::Combined;
    records = {};
    ForEachPresent(kinds, [&](auto& kind) { kind.Apply(&paths, &records); });
}

GuideFigures Learners::Figures() const {
    GuideFigures figures;
    figures.seconds = seconds;
    ForEachPresent(kinds, [&](const auto& kind) { kind.Describe(&figures); });
    return figures;
}

std::vector<std::byte> Learners::Save() const {
    StateWriter writer;
    writer.Put(kTag);
    ForEachOptional(kinds, [&](const auto& kind) { writer.Put(uint8_t(kind.has_value())); });
    ForEachPresent(kinds, [&](const auto& kind) { kind.Put(&writer); });
    writer.Put(seconds);
    return std::move(writer.bytes);
}

void Learners::Take(std::span<const std::byte> bytes, const Film& film) {
    StateReader reader(bytes);
    Require(reader.Get<uint32_t>() == kTag, "what it has learned is damaged");
    ForEachOptional(kinds, [&](const auto& kind) {
        Require((reader.Get<uint8_t>() != 0) == kind.has_value(),
                "it has learned for another render");
    });
    ForEachPresent(kinds, [&](auto& kind) { kind.Get(&reader, film); });
    seconds = reader.Get<double>();
    reader.Finish();
    SetPaths();
}

}  // namespace lull
