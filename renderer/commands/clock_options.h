// Lets a render end by the clock.
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <string>

namespace lull {

struct ClockOptions {
    std::string time, until;  // as given; both empty: no clock

    // Says it in words, for headers; empty where there is none.
    std::string Text() const;
};

// Adds --time and --until, of which there can be one.
void AddClockOptions(CLI::App& app, ClockOptions* options);

// Starts the clock: returns what says how many seconds are left; empty where none is set.
std::function<double()> StartClock(const ClockOptions&);

}  // namespace lull
