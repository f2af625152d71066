// Parses durations and times of day, and estimates the time of the last steps.
#pragma once

#include <cstdint>
#include <ctime>
#include <string>

namespace lull {

// Returns the seconds, > 0, that "10", "500ms", "90s", "10m", "2h" or a sum such as "1h30m" stand
// for. Numbers can have fractions. Throws std::invalid_argument for anything else.
double ParseDuration(const std::string& text);

// Returns the first time after `now` at which clocks here show "HH:MM" or "HH:MM:SS", of 24 hours.
// Throws std::invalid_argument for anything else.
std::time_t NextTimeOfDay(const std::string& text, std::time_t now);

// Return the seconds to leave for the files of an image, twice their CPU time on an idle core; and
// for its denoiser on `threads` threads.
double SecondsToWrite(int64_t pixels);
double SecondsToDenoise(int64_t pixels, int threads);

}  // namespace lull
