// Trains networks on samples as the paper did: binary cross-entropy, RMSprop, dropout.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "stopping/lab/recordings/labelled_blocks.h"
#include "stopping/lab/training/network_gradient.h"

namespace lull {

struct TrainingOptions {
    std::vector<int> units = {512, 128, 32};  // of LSTM layers
    double dropout = 0.4;                     // share of each LSTM layer's inputs, in [0, 1)
    double learningRate = 1e-3;               // > 0
    int batch = 64;                           // samples, > 0
    int epochs = 30;                          // > 0
    uint64_t seed = 0;
    // Lets each viewpoint count the same, however many blocks of it there are.
    bool balanceViewpoints = false;
    // Weights noisy and noiseless samples as the paper does. Without, all count the same.
    bool balanceClasses = true;
};

struct TrainingProgress {
    int epoch = 0, epochs = 0;  // finished, and in all
    int64_t samples = 0;        // trained on so far, each once an epoch
    int64_t allSamples = 0;     // at the end
    // Of the epoch under way, or of the last one where it has just ended: the mean loss, and the
    // area under the curve of the answers given while training (with dropout).
    double loss = 0, auc = 0.5;
};

// Trains a network step by step. The weights depend on nothing but samples, options and the kind
// of processor: not on threads (see RunWithThreads()) and interruptions.
//
// With balanceClasses the loss of noisy samples is weighted by the share of those that are not, and
// the other way round, so that both classes count the same; with balanceViewpoints as well the same
// holds within each viewpoint.
class Trainer {
  public:
    // The samples must outlive the trainer. Throws std::invalid_argument if an option is out of
    // range or the samples are not of both classes.
    Trainer(const TrainingSamples& samples, const TrainingOptions& options);

    bool IsDone() const { return step == stepsPerEpoch * options.epochs; }
    // Trains on the next batch. Throws std::runtime_error if the loss is no longer finite.
    void Step();
    TrainingProgress Progress() const;
    Network Result() const { return MakeNetwork(weights); }

    // Return and set all that steps have changed. Restore() throws std::runtime_error if `state`
    // was saved by a training with other samples or options, or is damaged.
    std::vector<std::byte> Save() const;
    void Restore(std::span<const std::byte> state);

  private:
    // A part of a batch. Its size is fixed, as sums depend on it; threads share the parts.
    struct Chunk {
        SampleBatch<float> batch;
        BatchResult<float> result;
    };

    void StartEpoch();
    void FillChunk(int chunk, int begin, int end, int batchSize);
    uint32_t Fingerprint() const;

    const TrainingSamples& samples;
    TrainingOptions options;
    int64_t stepsPerEpoch;
    std::vector<float> sampleWeights;
    NetworkWeights<float> weights;
    RmsProp optimizer;
    std::vector<NetworkWeights<float>> gradients;  // of the chunks of a batch
    std::vector<Chunk> chunks;

    int64_t step = 0;
    std::vector<uint32_t> order;  // of the samples in the epoch under way
    double lossSum = 0;           // over the samples of the epoch
    std::vector<float> answers;   // to them, and their labels
    std::vector<char> labels;
};

// Stores the states of trainings in a file, to continue from there.

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
