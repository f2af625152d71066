#include "renderer/render/half_buffer.h"

#include "renderer/base/error.h"

namespace lull {

bool LooksAtHalf(const Rule& rule, const ScheduleOptions& schedule) {
    const std::unique_ptr<Criterion> criterion = MakeCriterion(rule);
    for (int spp = 0; spp < schedule.cap;) {
        spp = int(std::min<int64_t>(int64_t(spp) + schedule.passLength, schedule.cap));
        if (criterion->Need(spp) >= ViewNeed::MeanAndHalf) return true;
    }
    return false;
}

bool KeepsHalf(HalfBuffer choice, const HalfUse& use) {
    const std::string user = !use.rule.empty() ? "the rule " + use.rule
                             : use.clock       ? "a clock"
                             : use.page        ? "a page with curves"
                             : use.denoiser    ? "a denoiser"
                                               : "";
    if (choice == HalfBuffer::Off && !user.empty())
        throw Error("--half-buffer off: " + user + " needs the mean of half of the samples");
    if (choice == HalfBuffer::Auto) return !user.empty() || use.checkpoint;
    return choice == HalfBuffer::On;
}

}  // namespace lull
