#include "renderer/schedule/half_buffer.h"

namespace lull {

bool LooksAtHalf(const Rule& rule, const ScheduleOptions& schedule) {
    const std::unique_ptr<Criterion> criterion = MakeCriterion(rule);
    for (int spp = 0; spp < schedule.cap;) {
        spp = int(std::min<int64_t>(int64_t(spp) + schedule.passLength, schedule.cap));
        if (criterion->Need(spp) >= ViewNeed::MeanAndHalf) return true;
    }
    return false;
}

}  // namespace lull
