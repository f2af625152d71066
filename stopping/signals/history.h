// Remembers those states of a block that later ones are compared with.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "stopping/base/state.h"

namespace lull {

// Numbers of a block at some spp.
template <typename Real>
struct BlockState {
    int spp = 0;
    std::vector<Real> values = {};
};

// States by increasing spp, all with as many values. The caller of Add() discards old ones.
template <typename Real>
class History {
  public:
    // Adds a state. Throws std::invalid_argument unless its spp are above those of all others and
    // its values are finite and as many as theirs.
    void Add(BlockState<Real> state) {
        if (state.spp < 1 || !Follows(state))
            throw std::invalid_argument("states of a block must come with increasing spp");
        if (!IsFinite(state) ||
            (!states.empty() && states.back().values.size() != state.values.size()))
            throw std::invalid_argument(
                "the values of a block's state are not finite or not as many as before");
        states.push_back(std::move(state));
    }

    // Forgets all states below an spp.
    void ForgetBelow(int64_t spp) {
        std::erase_if(states, [&](const BlockState<Real>& s) { return s.spp < spp; });
    }

    // To be called after each Add(). Keeps states a step apart, eight an octave, down to the spp of
    // the last one / depth: near enough to any spp in between, and few however many samples there
    // are. Which are kept depends only on the spp at which they were added.
    void Thin(double depth) {
        const size_t count = states.size();
        if (count > 2 && !IsStep(states[count - 3].spp, states[count - 2].spp))
            states.erase(states.end() - 2);
        size_t old = 0;
        while (old + 2 < states.size() && states[old + 1].spp <= states.back().spp / depth) ++old;
        states.erase(states.begin(), states.begin() + ptrdiff_t(old));
    }

    const std::vector<BlockState<Real>>& States() const { return states; }  // the oldest first

    // Returns the state at an spp; null if there is none.
    const BlockState<Real>* At(int spp) const {
        const auto it = std::ranges::lower_bound(states, spp, {}, &BlockState<Real>::spp);
        return it != states.end() && it->spp == spp ? &*it : nullptr;
    }

    // Returns the state before the last that is nearest to `spp` by its ratio, within a factor of
    // `tolerance`; null if there is none.
    const BlockState<Real>* Nearest(double spp, double tolerance) const {
        const BlockState<Real>* best = nullptr;
        double least = std::log(tolerance);
        for (size_t i = 0; i + 1 < states.size(); ++i) {
            const double distance = std::abs(std::log(states[i].spp / spp));
            if (distance > least) continue;
            least = distance;
            best = &states[i];
        }
        return best;
    }

    // Write and read all states. Restore() throws std::runtime_error if they are damaged or do not
    // have `count` values each.
    void Save(StateWriter* writer) const {
        writer->Put(uint32_t(states.size()));
        for (const BlockState<Real>& state : states) {
            writer->Put(int32_t(state.spp));
            writer->PutAll(std::span(state.values));
        }
    }
    void Restore(StateReader* reader, size_t count) {
        states.clear();
        for (uint32_t left = reader->Get<uint32_t>(); left > 0; --left) {
            BlockState<Real> state{.spp = reader->Get<int32_t>(),
                                   .values = std::vector<Real>(count)};
            reader->GetAll(std::span(state.values));
            if (state.spp < 1 || !Follows(state) || !IsFinite(state))
                throw std::runtime_error("the saved states of a block are damaged");
            states.push_back(std::move(state));
        }
    }

    // Returns whether both lie far enough apart to be kept.
    static bool IsStep(int from, int to) { return 11 * double(to) >= 12 * double(from); }

  private:
    bool Follows(const BlockState<Real>& state) const {
        return states.empty() || state.spp > states.back().spp;
    }
    static bool IsFinite(const BlockState<Real>& state) {
        return std::ranges::all_of(state.values, [](Real v) { return std::isfinite(v); });
    }

    std::vector<BlockState<Real>> states;
};

}  // namespace lull
