// Stores the states of trainings in a file, to continue from there.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "stopping/lab/training/training.h"

namespace lull {

// Writes bytes to a file, completely or not at all; throws the error.
using FileWriter = std::function<void(const std::string& path, std::span<const std::byte> bytes)>;

// The states of several trainings, by number, finished ones first.
class TrainingCheckpoint {
  public:
    // An empty path stands for no file; `interval` seconds are between two writings of it.
    TrainingCheckpoint(const std::string& path, double interval, FileWriter write)
        : path(path), interval(interval), write(std::move(write)) {}

    // Reads the file. Throws std::runtime_error.
    void Read();
    void Set(size_t training, std::vector<std::byte> state);
    // Restores a training to its saved state; leaves it unchanged where there is none. Throws
    // std::runtime_error if it is the state of another.
    void Restore(size_t training, Trainer* trainer) const;
    // Returns whether the next writing is due.
    bool IsDue() const;
    // Writes the file, if there is one. Throws as the writer does.
    void Write();
    // Discards all trainings, and removes the file.
    void Remove();
    const std::string& Path() const { return path; }

  private:
    using Clock = std::chrono::steady_clock;

    std::string path;
    std::chrono::duration<double> interval;
    FileWriter write;
    std::vector<std::vector<std::byte>> states;
    Clock::time_point written = Clock::now();
};

}  // namespace lull
