#include "stopping/embedding/stopper.h"

#include <tbb/task_arena.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "stopping/base/parallel.h"
#include "stopping/base/state.h"
#include "stopping/embedding/model_folder.h"
#include "stopping/embedding/picture.h"
#include "stopping/network/human_range.h"
#include "stopping/rules/lnoise.h"

namespace lull {

namespace {

constexpr uint32_t stopperTag = 0x31504f53;  // "SOP1"
constexpr int largestSide = 1 << 16;         // pixels
constexpr int blockSide = 200;               // of the blocks that people have judged

void Require(bool holds, const std::string& message) {
    if (!holds) throw std::invalid_argument(message);
}

void CheckSettings(const lull_settings& s) {
    const auto isSide = [](int pixels) {
        return pixels >= smallestVotingSide && pixels <= largestSide;
    };
    const std::string range = std::to_string(smallestVotingSide) + " to " +
                              std::to_string(largestSide) + " pixels a side";
    Require(isSide(s.width) && isSide(s.height), "a picture of " + std::to_string(s.width) + "x" +
                                                     std::to_string(s.height) +
                                                     " pixels; it must have " + range);
    Require(s.block == 0 || isSide(s.block),
            "blocks of " + std::to_string(s.block) + " pixels; they must have " + range);
    Require(s.pass >= 0 && s.cap >= 0, "pass and cap must not be negative");
    Require(!s.model || !s.rule, "model and rule are both given; one of them is needed");
    Require(std::isfinite(s.caution) && s.caution >= 0, "caution must be above 0");
}

CriterionFactory MakeFactory(const lull_settings& s, int blockCount) {
    const std::string rule = s.rule    ? std::string(s.rule)
                             : s.model ? "learned:" + std::string(s.model)
                                       : std::string(defaultRule);
    // The HDF5 library, which reads the model, has one thread at a time.
    static std::mutex reading;
    const std::lock_guard lock(reading);
    return MakeCriterionFactory(rule, {.passSpp = s.pass,
                                       .blockCount = blockCount,
                                       .cap = s.cap,
                                       .models = s.models ? s.models : InstalledModels(),
                                       .caution = s.caution > 0 ? s.caution : 1});
}

// Returns the first spp from `spp` on at which a criterion looks at a block; 0 if it never does.
int NextLook(const Criterion& criterion, int spp) {
    constexpr int horizon = 10000;  // beyond any spacing of looks
    const int end = int(std::min<int64_t>(int64_t(spp) + horizon, std::numeric_limits<int>::max()));
    for (int s = spp; s < end; ++s)
        if (criterion.Need(s) != ViewNeed::Nothing) return s;
    return 0;
}

uint32_t Checksum(std::span<const std::byte> bytes) {
    return uint32_t(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

// Says what a saved state belongs to.
std::vector<std::byte> IdentityOf(const lull_settings& settings, const CriterionFactory& factory,
                                  const BlockGrid& grid) {
    StateWriter writer;
    writer.Put(stopperTag);
    writer.Put(settings.pass);
    writer.Put(settings.cap);
    const std::string who = factory.rule + " " + factory.checksum;
    writer.Put(uint32_t(who.size()));
    writer.PutAll(std::span(who));
    writer.PutAll(std::span(grid.blocks));
    return std::move(writer.bytes);
}

}  // namespace

Stopper::Stopper(const lull_settings& settings) {
    CheckSettings(settings);
    const int side = settings.block > 0 ? settings.block : blockSide;
    grid = CutIntoBlocks(settings.width, settings.height, side);
    const int count = int(grid.blocks.size());
    factory = MakeFactory(settings, count);
    identity = IdentityOf(settings, factory, grid);
    const auto first = MakeJudge(0).criterion;
    firstLook = NextLook(*first, 1);
    needsHalf = firstLook > 0 && first->Need(firstLook) >= ViewNeed::MeanAndHalf;
    for (int i = 0; i < count; ++i) judges.push_back(MakeJudge(i));
    locks = std::vector<std::mutex>(judges.size());
}

const lull_rect& Stopper::RectOf(int block) const {
    Require(block >= 0 && block < int(grid.blocks.size()),
            "there is no block " + std::to_string(block) + "; the picture has blocks 0 to " +
                std::to_string(grid.blocks.size() - 1));
    return grid.blocks[size_t(block)];
}

Stopper::Judge Stopper::MakeJudge(int block) const {
    const lull_rect& rect = grid.blocks[size_t(block)];
    const lull_rect& last = grid.blocks.back();
    const double pixels = double(last.x + last.width) * (last.y + last.height);
    Judge judge{.criterion = factory.make({block, rect.width * double(rect.height) / pixels})};
    judge.answer.next_spp = firstLook;
    judge.answer.probability = factory.trend.kind == RuleTrend::Probability ? 1 : -1;
    judge.answer.visible_noise = -1;
    judge.answer.votes_needed = factory.trend.votes;
    return judge;
}

std::vector<std::unique_lock<std::mutex>> Stopper::LockAll() const {
    return {locks.begin(), locks.end()};  // always in the same order
}

bool Stopper::Done() const {
    const auto all = LockAll();
    return std::ranges::all_of(judges, [](const Judge& j) { return j.answer.stop == 1; });
}

lull_answer Stopper::Answer(int block) const {
    RectOf(block);
    const std::lock_guard lock(locks[size_t(block)]);
    return judges[size_t(block)].answer;
}

std::vector<lull_answer> Stopper::Observe(const lull_picture& picture, int spp) {
    const lull_rect& last = grid.blocks.back();
    CheckPicture(picture, last.x + last.width, last.y + last.height, needsHalf);
    const auto all = LockAll();
    Require(spp > 0, "a picture needs samples: spp must be above 0");
    for (const Judge& judge : judges)
        Require(judge.answer.stop || spp > judge.answer.spp,
                "spp must increase: a picture at " + std::to_string(spp) + " spp after one at " +
                    std::to_string(judge.answer.spp));
    PictureValues values;
    for (int i = 0; i < int(judges.size()); ++i)
        values.Add(CheckValues(i, picture, grid.blocks[size_t(i)], spp));
    // What is left of a picture once blocks have stopped may be its brightest part.
    if (std::ranges::none_of(judges, [](const Judge& j) { return j.answer.stop == 1; })) {
        const std::string fault = FaultOfExposure(values);
        Require(fault.empty(), fault);
    }
    // Isolated: this thread has all locks, and must not take up a task that waits for one.
    tbb::this_task_arena::isolate([&] {
        ForEachIndex(int(judges.size()),
                     [&](int i) { Look(i, picture, grid.blocks[size_t(i)], spp); });
    });
    std::vector<lull_answer> answers;
    for (const Judge& judge : judges) answers.push_back(judge.answer);
    return answers;
}

lull_answer Stopper::ObserveBlock(int block, const lull_picture& picture, int spp) {
    const lull_rect& rect = RectOf(block);
    CheckPicture(picture, rect.width, rect.height, needsHalf);
    const std::lock_guard lock(locks[size_t(block)]);
    const lull_answer& answer = judges[size_t(block)].answer;
    Require(spp > 0, "a picture needs samples: spp must be above 0");
    Require(answer.stop || spp > answer.spp, "spp must increase: block " + std::to_string(block) +
                                                 " was shown at " + std::to_string(answer.spp) +
                                                 " spp, and now at " + std::to_string(spp));
    const lull_rect whole{0, 0, rect.width, rect.height};
    CheckValues(block, picture, whole, spp);
    Look(block, picture, whole, spp);
    return answer;
}

// Returns the values of a block's mean; none if it is not going to be looked at.
PictureValues Stopper::CheckValues(int block, const lull_picture& picture, const lull_rect& part,
                                   int spp) const {
    const Judge& judge = judges[size_t(block)];
    if (judge.answer.stop || judge.criterion->Need(spp) == ViewNeed::Nothing) return {};
    const PictureValues values = ValuesOf(picture, picture.mean, part);
    std::string fault = FaultOfValues(values);
    if (fault.empty() && picture.half) fault = FaultOfValues(ValuesOf(picture, picture.half, part));
    Require(fault.empty(), "block " + std::to_string(block) + ": " + fault);
    return values;
}

void Stopper::Look(int block, const lull_picture& picture, const lull_rect& part, int spp) {
    Judge& judge = judges[size_t(block)];
    lull_answer& answer = judge.answer;
    answer.judged = 0;
    if (answer.stop) return;
    std::vector<float> mean, half;
    const ViewNeed need = judge.criterion->Need(spp);
    if (need != ViewNeed::Nothing) {
        mean = ReadPixels(picture, picture.mean, part);
        if (picture.half) half = ReadPixels(picture, picture.half, part);
    }
    const BlockView view{part.width, part.height, spp, mean, half};
    const Decision decision = judge.criterion->Observe(view);
    answer.stop = decision.stop;
    answer.judged = decision.judged;
    answer.spp = spp;
    answer.votes = decision.votes;
    answer.value = decision.value;
    answer.threshold = decision.threshold;
    if (factory.trend.kind == RuleTrend::Probability) answer.probability = decision.value;
    if (decision.visibleNoise || !half.empty())
        answer.visible_noise = decision.visibleNoise ? *decision.visibleNoise : VisibleNoise(view);
    answer.next_spp = answer.stop || spp == std::numeric_limits<int>::max()
                          ? 0
                          : NextLook(*judge.criterion, spp + 1);
    if (answer.stop && !factory.logRatios.empty()) {
        const HumanRange people = RangeOfPeople(spp, true, factory.logRatios);
        answer.people_low = people.low;
        answer.people_high = people.high.value_or(0);
    }
}

// The state begins with what it belongs to and ends with a checksum.
std::vector<std::byte> Stopper::Save() const {
    const auto all = LockAll();
    StateWriter writer;
    writer.bytes = identity;
    for (const Judge& judge : judges) {
        const std::vector<std::byte> state = judge.criterion->Save();
        writer.Put(judge.answer);
        writer.Put(uint32_t(state.size()));
        writer.PutAll(std::span(state));
    }
    writer.Put(Checksum(writer.bytes));
    return std::move(writer.bytes);
}

void Stopper::Restore(std::span<const std::byte> state) {
    const size_t end = state.size() - std::min(state.size(), sizeof(uint32_t));
    if (StateReader(state.subspan(end)).Get<uint32_t>() != Checksum(state.first(end)))
        throw std::runtime_error("the saved state of a stopper is damaged");
    if (end < identity.size() || !std::ranges::equal(state.first(identity.size()), identity))
        throw std::runtime_error("the saved state belongs to a stopper with other settings");
    StateReader reader(state.subspan(identity.size(), end - identity.size()));
    std::vector<Judge> restored;
    for (int i = 0; i < int(judges.size()); ++i) {
        restored.push_back(MakeJudge(i));
        restored.back().answer = reader.Get<lull_answer>();
        std::vector<std::byte> own(std::min<size_t>(reader.Get<uint32_t>(), reader.Left()));
        reader.GetAll(std::span(own));
        restored.back().criterion->Restore(own);
    }
    reader.Finish();
    const auto all = LockAll();
    judges = std::move(restored);
}

}  // namespace lull
