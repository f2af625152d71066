// Trains networks, one after the other, for the commands that do.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <optional>

#include "renderer/commands/train_options.h"
#include "stopping/learning/block_split.h"
#include "stopping/learning/evaluation.h"

namespace lull {

// Keeps the states of the trainings of one command, finished ones first, in a file.
class TrainingCheckpoint {
  public:
    // An empty path stands for no file; `interval` seconds are between two writings of it.
    TrainingCheckpoint(const std::string& path, double interval) : path(path), interval(interval) {}

    void Read();  // throws Error or std::runtime_error
    void Set(size_t training, std::vector<std::byte> state);
    const std::vector<std::byte>* Find(size_t training) const;
    bool IsDue() const;
    void Write();
    // Forgets all trainings, and removes the file.
    void Remove();
    const std::string& Path() const { return path; }

  private:
    using Clock = std::chrono::steady_clock;

    std::string path;
    std::chrono::duration<double> interval;
    std::vector<std::vector<std::byte>> states;
    Clock::time_point written = Clock::now();
};

// Is told of a training; one that an earlier run has finished is not begun. None may be empty.
struct TrainingEvents {
    std::function<void(const TrainingSamples&, const TrainingProgress&)> begin;
    std::function<void(const Trainer&)> step;
    std::function<void(const TrainingProgress&)> end;
};

// Returns the splits that the options ask for; with --cross-validate and -o, that of the model
// comes last, without a name. Throws Error.
std::vector<BlockSplit> MakeSplits(const TrainOptions&, std::span<const JudgedBlock>);

// Throws Error if n or the spacing of votes is no multiple of the recordings' pass.
void CheckSpacing(const ModelSettings& settings, int passSpp);

// Trains a network, or goes on with training number `index` of the checkpoint. Nothing if it was
// interrupted: the checkpoint has it, but is not written. Throws as Trainer does, and Error.
std::optional<Network> TrainNetwork(const TrainOptions&, const BlockSplit&, size_t index,
                                    TrainingCheckpoint*, const TrainingEvents&);

// Adds what a network does to blocks.
void AddOutcomes(const Network& network, const ModelSettings& settings,
                 std::span<const JudgedBlock> blocks, std::vector<ViewpointOutcome>* viewpoints);

// Says what a network is trained on, and with which options; without the date, so that the same
// training gives the same text.
std::map<std::string, std::string> MakeRecord(const TrainOptions&, const BlockSplit&);

}  // namespace lull
