#include "renderer/embedding/stopper.h"

#include <dlfcn.h>
#include <tbb/task_arena.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "renderer/embedding/picture.h"
#include "stopping/base/parallel.h"
#include "stopping/base/state.h"
#include "stopping/rules/baselines.h"
#include "stopping/rules/rule_table.h"

namespace lull {

namespace {

constexpr uint32_t kStopperTag = 0x32504f53;  // "SOP2"
constexpr int kMostSpp = 1 << 24;
constexpr double kLeastCaution = 0.01, kMostCaution = 100;  // as those of `lull render`
constexpr int kBlockSide = 200;                             // of the blocks that people have judged

void CheckSettings(const lull_settings& s) {
    const auto isSide = [](int pixels) {
        return pixels >= kSmallestVotingSide && pixels <= kLargestSide;
    };
    const std::string range = std::to_string(kSmallestVotingSide) + " to " +
                              std::to_string(kLargestSide) + " pixels a side";
    Require(isSide(s.width) && isSide(s.height), "an image of " + std::to_string(s.width) + "x" +
                                                     std::to_string(s.height) +
                                                     " pixels; it must have " + range);
    Require(s.block == 0 || isSide(s.block),
            "blocks of " + std::to_string(s.block) + " pixels; they must have " + range);
    const auto isSpp = [](int spp) { return spp >= 0 && spp <= kMostSpp; };
    Require(isSpp(s.pass) && isSpp(s.cap), "pass is " + std::to_string(s.pass) + " and cap " +
                                               std::to_string(s.cap) + "; they must be from 0 to " +
                                               std::to_string(kMostSpp) + " spp");
    Require(!s.model || !s.rule, "model and rule are both given; one of them is needed");
    Require(s.caution == 0 || (s.caution >= kLeastCaution && s.caution <= kMostCaution),
            "caution must be from 0.01 to 100, or 0 for 1");
}

Rule MakeRule(const lull_settings& s, int blockCount) {
    const std::string text = s.rule    ? std::string(s.rule)
                             : s.model ? "learned:" + std::string(s.model)
                                       : std::string(kDefaultRule);
    // The HDF5 library, which reads the model, has one thread at a time.
    static std::mutex reading;
    const std::lock_guard lock(reading);
    return ParseRule(text, {.passSpp = s.pass,
                            .blockCount = blockCount,
                            .cap = s.cap,
                            .models = s.models ? s.models : InstalledModels(),
                            .caution = s.caution > 0 ? s.caution : 1,
                            .hasHalves = false});
}

// Returns the first spp from `spp` on at which a criterion checks a block; 0 if it never does.
int NextCheck(const Criterion& criterion, int spp) {
    constexpr int kHorizon = 10000;  // beyond any spacing of checks
    const int end =
        int(std::min<int64_t>(int64_t(spp) + kHorizon, std::numeric_limits<int>::max()));
    for (int s = spp; s < end; ++s)
        if (criterion.Need(s) != ViewNeed::Nothing) return s;
    return 0;
}

uint32_t Checksum(std::span<const std::byte> bytes) {
    return uint32_t(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::vector<std::byte> IdentityOf(const lull_settings& settings, const Rule& rule,
                                  const BlockGrid& grid) {
    StateWriter writer;
    writer.Put(kStopperTag);
    writer.Put(settings.pass);
    writer.Put(settings.cap);
    const std::string who = rule.text + " " + rule.checksum;
    writer.Put(uint32_t(who.size()));
    writer.PutAll(std::span(who));
    writer.PutAll(std::span(grid.blocks));
    return std::move(writer.bytes);
}

}  // namespace

Stopper::Stopper(const lull_settings& settings) {
    CheckSettings(settings);
    const int side = settings.block > 0 ? settings.block : kBlockSide;
    const auto along = [&](int pixels) { return (pixels + side - 1) / side; };
    const int count = along(settings.width) * along(settings.height);
    rule = std::make_shared<const Rule>(MakeRule(settings, count));
    grid = CutIntoBlocks(settings.width, settings.height, side, rule->smallestSide);
    identity = IdentityOf(settings, *rule, grid);
    const auto first = MakeState(0).criterion;
    firstCheck = NextCheck(*first, 1);
    needsHalf = firstCheck > 0 && first->Need(firstCheck) >= ViewNeed::MeanAndHalf;
    for (int i = 0; i < count; ++i) states.push_back(MakeState(i));
    locks = std::vector<std::mutex>(states.size());
}

lull_rect Stopper::RectOf(int block) const {
    Require(block >= 0 && block < int(grid.blocks.size()),
            "there is no block " + std::to_string(block) + "; the image has blocks 0 to " +
                std::to_string(grid.blocks.size() - 1));
    const BlockRect& rect = grid.blocks[size_t(block)];
    return {rect.x, rect.y, rect.width, rect.height};
}

Stopper::BlockState Stopper::MakeState(int block) const {
    if (grid.leaders[size_t(block)] != block) return {};
    const BlockRect& rect = grid.blocks[size_t(block)];
    const BlockRect& last = grid.blocks.back();
    const double pixels = double(last.x + last.width) * (last.y + last.height);
    BlockState state{.criterion =
                         MakeCriterion(rule, {block, rect.width * double(rect.height) / pixels})};
    state.answer.next_spp = firstCheck;
    state.answer.probability = rule->trend.kind == RuleTrend::Probability ? 1 : -1;
    state.answer.masked_noise = -1;
    state.answer.votes_needed = rule->trend.votes;
    return state;
}

std::vector<std::unique_lock<std::mutex>> Stopper::LockAll() const {
    return {locks.begin(), locks.end()};  // always in the same order
}

bool Stopper::Done() const {
    const auto all = LockAll();
    return std::ranges::all_of(
        states, [](const BlockState& s) { return !s.criterion || s.answer.stop == 1; });
}

lull_answer Stopper::Answer(int block) const {
    RectOf(block);
    const size_t leader = size_t(grid.leaders[size_t(block)]);
    const std::lock_guard lock(locks[leader]);
    return states[leader].answer;
}

std::vector<lull_answer> Stopper::Observe(const lull_image& picture, int spp) {
    const BlockRect& last = grid.blocks.back();
    CheckPicture(picture, last.x + last.width, last.y + last.height, needsHalf);
    const auto all = LockAll();
    Require(spp > 0, "an image needs samples: spp must be above 0");
    for (const BlockState& state : states)
        Require(!state.criterion || state.answer.stop || spp > state.answer.spp,
                "spp must increase: an image at " + std::to_string(spp) + " spp after one at " +
                    std::to_string(state.answer.spp));
    PictureValues values;
    for (int i = 0; i < int(states.size()); ++i)
        if (states[size_t(i)].criterion) values.Add(CheckValues(i, picture, RectOf(i), spp));
    // The rest of an image once blocks have stopped may be its brightest part.
    if (std::ranges::none_of(states, [](const BlockState& s) { return s.answer.stop == 1; })) {
        const std::string fault = FaultOfExposure(values);
        Require(fault.empty(), fault);
    }
    NoteChannels(picture);
    // Isolated: this thread has all locks, and must not take up a task that waits for one.
    tbb::this_task_arena::isolate([&] {
        ForEachIndex(int(states.size()), [&](int i) {
            if (states[size_t(i)].criterion) Check(i, picture, RectOf(i), spp);
        });
    });
    std::vector<lull_answer> answers;
    for (const int leader : grid.leaders) answers.push_back(states[size_t(leader)].answer);
    return answers;
}

lull_answer Stopper::ObserveBlock(int block, const lull_image& picture, int spp) {
    const lull_rect rect = RectOf(block);
    CheckPicture(picture, rect.width, rect.height, needsHalf);
    if (grid.leaders[size_t(block)] != block) return Answer(block);
    const std::lock_guard lock(locks[size_t(block)]);
    const lull_answer& answer = states[size_t(block)].answer;
    Require(spp > 0, "an image needs samples: spp must be above 0");
    Require(answer.stop || spp > answer.spp, "spp must increase: block " + std::to_string(block) +
                                                 " was shown at " + std::to_string(answer.spp) +
                                                 " spp, and now at " + std::to_string(spp));
    const lull_rect whole{0, 0, rect.width, rect.height};
    CheckValues(block, picture, whole, spp);
    NoteChannels(picture);
    Check(block, picture, whole, spp);
    return answer;
}

const char* Stopper::Warning() const {
    const std::lock_guard lock(warningLock);
    warning = spacingWarning + (spacingWarning.empty() || channelWarning.empty() ? "" : "; ") +
              channelWarning;
    return warning.c_str();
}

void Stopper::NoteChannels(const lull_image& picture) {
    if (!HasFourthChannel(picture)) return;
    const std::lock_guard lock(warningLock);
    channelWarning =
        "pixels seem to have a fourth channel (pixel_stride), and R, G and B are used without it; "
        "show the image over its background";
}

void Stopper::NoteSpacing(BlockState* state) {
    const std::string pictures = state->spacing.Note(state->answer);
    if (pictures.empty()) return;
    const std::lock_guard lock(warningLock);
    if (!spacingWarning.empty()) return;  // the first is enough
    spacingWarning =
        "images at " + pictures +
        " spp lie too far apart for this rule, which compares them: the last was not checked, "
        "and none will be while steps are so large; show images every 20 or 40 spp, or at most "
        "1.5 times the spp of the one before";
}

// Returns the values of a block's mean; none if no check is due.
PictureValues Stopper::CheckValues(int block, const lull_image& picture, const lull_rect& part,
                                   int spp) const {
    const BlockState& state = states[size_t(block)];
    if (state.answer.stop || state.criterion->Need(spp) == ViewNeed::Nothing) return {};
    const PictureValues values = ValuesOf(picture, picture.mean, part);
    std::string fault = FaultOfValues(values);
    if (fault.empty() && picture.half) fault = FaultOfValues(ValuesOf(picture, picture.half, part));
    // One sample may be all of the half.
    if (fault.empty() && spp > 1 && HasMeanAsHalf(picture, part))
        fault = "the half buffer equals the mean; pass the mean of a fixed half of the samples";
    Require(fault.empty(), "block " + std::to_string(block) + ": " + fault);
    return values;
}

void Stopper::Check(int block, const lull_image& picture, const lull_rect& part, int spp) {
    BlockState& state = states[size_t(block)];
    lull_answer& answer = state.answer;
    answer.checked = 0;
    if (answer.stop) return;
    std::vector<float> mean, half;
    const ViewNeed need = state.criterion->Need(spp);
    if (need != ViewNeed::Nothing) {
        mean = ReadPixels(picture, picture.mean, part);
        if (picture.half) half = ReadPixels(picture, picture.half, part);
    }
    const BlockView view{part.width, part.height, spp, mean, half};
    const Decision decision = state.criterion->Observe(view);
    answer.stop = decision.stop;
    answer.checked = decision.checked;
    answer.spp = spp;
    answer.votes = decision.votes;
    answer.value = decision.value;
    answer.threshold = decision.threshold;
    if (rule->trend.kind == RuleTrend::Probability) answer.probability = decision.value;
    if (!half.empty()) answer.masked_noise = VisibleNoise(view);
    answer.next_spp = answer.stop || spp == std::numeric_limits<int>::max()
                          ? 0
                          : NextCheck(*state.criterion, spp + 1);
    NoteSpacing(&state);
}

// The state begins with its identity and ends with a checksum.
std::vector<std::byte> Stopper::Save() const {
    const auto all = LockAll();
    StateWriter writer;
    writer.bytes = identity;
    for (const BlockState& state : states) {
        if (!state.criterion) continue;
        const std::vector<std::byte> own = state.criterion->Save();
        writer.Put(state.answer);
        writer.Put(uint32_t(own.size()));
        writer.PutAll(std::span(own));
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
    std::vector<BlockState> restored;
    for (int i = 0; i < int(states.size()); ++i) {
        restored.push_back(MakeState(i));
        if (!restored.back().criterion) continue;
        restored.back().answer = reader.Get<lull_answer>();
        std::vector<std::byte> own(std::min<size_t>(reader.Get<uint32_t>(), reader.Left()));
        reader.GetAll(std::span(own));
        restored.back().criterion->Restore(own);
    }
    reader.Finish();
    const auto all = LockAll();
    states = std::move(restored);
}

std::string InstalledModels() {
    const char* set = std::getenv("LULL_MODELS");
    if (set && *set) return set;
    Dl_info library;
    if (!dladdr(reinterpret_cast<const void*>(&InstalledModels), &library) || !library.dli_fname)
        return LULL_MODELS_FROM_LIBRARY;
    // Links to the library may lie elsewhere.
    std::error_code ignored;
    std::filesystem::path file = std::filesystem::canonical(library.dli_fname, ignored);
    if (ignored) file = library.dli_fname;
    return (file.parent_path() / LULL_MODELS_FROM_LIBRARY).lexically_normal().string();
}

}  // namespace lull
