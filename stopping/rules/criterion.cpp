#include "stopping/rules/criterion.h"

#include <stdexcept>

namespace lull {

void Criterion::Restore(std::span<const std::byte> state) {
    if (!state.empty())
        throw std::runtime_error("the saved state belongs to another stopping rule");
}

}  // namespace lull
