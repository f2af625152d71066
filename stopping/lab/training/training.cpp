#include "stopping/lab/training/training.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <numeric>
#include <stdexcept>

#include "stopping/base/input_file.h"
#include "stopping/base/parallel.h"
#include "stopping/base/state.h"
#include "stopping/lab/evaluation/evaluation.h"

namespace lull {

namespace {

constexpr uint32_t kCheckpointTag = 0x3143524c;  // "LRC1"

}  // namespace

void TrainingCheckpoint::Read() try {
    if (const std::string reason = ReasonNotToRead(path); !reason.empty())
        throw std::runtime_error("there is no checkpoint to resume from: " + reason);
    std::ifstream file = OpenInput(path);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    StateReader reader(CheckSeal(std::as_bytes(std::span(text))));
    reader.Expect(kCheckpointTag);
    while (reader.Left() > 0) {
        const uint64_t size = reader.Get<uint64_t>();
        if (size > reader.Left()) throw std::runtime_error("the checkpoint is cut short");
        reader.GetAll(std::span(states.emplace_back(size)));
    }
} catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
}

void TrainingCheckpoint::Set(size_t training, std::vector<std::byte> state) {
    states.resize(std::max(states.size(), training + 1));
    states[training] = std::move(state);
}

void TrainingCheckpoint::Restore(size_t training, Trainer* trainer) const {
    if (training >= states.size()) return;
    try {
        trainer->Restore(states[training]);
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(path + ": " + error.what());
    }
}

bool TrainingCheckpoint::IsDue() const {
    return !path.empty() && Clock::now() > written + interval;
}

void TrainingCheckpoint::Write() {
    if (path.empty()) return;
    StateWriter writer;
    writer.Put(kCheckpointTag);
    for (const std::vector<std::byte>& state : states) writer.PutVector(state);
    Seal(&writer.bytes);
    write(path, writer.bytes);
    written = Clock::now();
}

void TrainingCheckpoint::Remove() {
    states.clear();
    if (!path.empty()) std::filesystem::remove(path);
}

namespace {

constexpr int kChunkSize = 32;                // samples: enough for fast products of matrices
constexpr uint32_t kTrainerTag = 0x314e5254;  // "TRN1"
// Tell random numbers of different purposes apart.
constexpr uint64_t kOrderTag = 2, kDropoutTag = 3;

std::vector<float> ClassWeights(const TrainingSamples& samples, double noisyShare) {
    std::vector<float> weights;
    for (char noisy : samples.noisy) weights.push_back(float(noisy ? 1 - noisyShare : noisyShare));
    return weights;
}

// Gives each viewpoint the same sum of weights, and each class within it if they are balanced;
// their mean is 1/2, as it is of class weights if there are as many samples of both.
std::vector<float> ViewpointWeights(const TrainingSamples& samples, bool balanceClasses) {
    auto group = [&](size_t i) {
        return std::pair(samples.viewpoint[i], balanceClasses ? samples.noisy[i] : char(0));
    };
    std::map<std::pair<int, char>, int> counts;
    for (size_t i = 0; i < samples.Count(); ++i) ++counts[group(i)];
    const double sum = double(samples.Count()) / 2 / double(counts.size());
    std::vector<float> weights;
    for (size_t i = 0; i < samples.Count(); ++i) weights.push_back(float(sum / counts[group(i)]));
    return weights;
}

std::vector<float> SampleWeights(const TrainingSamples& samples, const TrainingOptions& options,
                                 double noisyShare) {
    if (options.balanceViewpoints) return ViewpointWeights(samples, options.balanceClasses);
    return ClassWeights(samples, options.balanceClasses ? noisyShare : 0.5);
}

void Check(bool isRight, const char* message) {
    if (!isRight) throw std::invalid_argument(message);
}

}  // namespace

Trainer::Trainer(const TrainingSamples& samples, const TrainingOptions& options)
    : samples(samples),
      options(options),
      weights(InitialWeights(InputCount(samples.settings), options.units, options.seed)),
      optimizer{.rate = float(options.learningRate), .meanSquares = ZerosLike(weights)} {
    Check(options.batch > 0 && options.epochs > 0, "batch and epochs must be above 0");
    Check(options.dropout >= 0 && options.dropout < 1, "dropout must be in [0, 1)");
    Check(options.learningRate > 0 && std::isfinite(options.learningRate),
          "the learning rate must be above 0");
    const size_t count = samples.Count();
    const double noisy = double(std::count(samples.noisy.begin(), samples.noisy.end(), char(1)));
    Check(count > 0, "there are no samples to train on");
    Check(noisy > 0 && noisy < double(count),
          "the samples to train on are all noisy or all noiseless; there is nothing to learn");
    sampleWeights = SampleWeights(samples, options, noisy / double(count));
    stepsPerEpoch = int64_t(count + size_t(options.batch) - 1) / options.batch;
    const size_t most = (std::min(count, size_t(options.batch)) + kChunkSize - 1) / kChunkSize;
    gradients.assign(most, optimizer.meanSquares);
    chunks.resize(most);
    StartEpoch();
}

void Trainer::StartEpoch() {
    order.resize(samples.Count());
    std::iota(order.begin(), order.end(), 0u);
    CounterRandom random(options.seed, {kOrderTag, uint64_t(step / stepsPerEpoch)});
    for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.Below(i)]);
}

void Trainer::FillChunk(int chunk, int begin, int end, int batchSize) {
    SampleBatch<float>& batch = chunks[size_t(chunk)].batch;
    const int count = end - begin, steps = samples.settings.k;
    const int inputs = samples.windowSize / steps;
    batch.count = count;
    batch.steps = steps;
    batch.inputs.resize(inputs, count * steps);
    batch.targets.resize(count);
    batch.weights.resize(count);
    for (int s = 0; s < count; ++s) {
        const size_t sample = order[size_t(begin + s)];
        const float* window = &samples.windows[sample * size_t(samples.windowSize)];
        for (int t = 0; t < steps; ++t)
            for (int i = 0; i < inputs; ++i)
                batch.inputs(i, t * count + s) = window[t * inputs + i];
        batch.targets[s] = samples.noisy[sample];
        batch.weights[s] = sampleWeights[sample] / float(batchSize);
    }

    batch.masks.resize(options.dropout > 0 ? weights.lstm.size() : 0);
    const float kept = float(1 / (1 - options.dropout));
    for (size_t layer = 0; layer < batch.masks.size(); ++layer) {
        CounterRandom random(options.seed, {kDropoutTag, uint64_t(step), uint64_t(chunk), layer});
        batch.masks[layer] = Eigen::MatrixXf::NullaryExpr(
            weights.lstm[layer].kernel.cols(), count,
            [&] { return random.Uniform() < options.dropout ? 0.f : kept; });
    }
}

void Trainer::Step() {
    const int64_t place = step % stepsPerEpoch;
    if (place == 0) {
        StartEpoch();
        lossSum = 0;
        answers.clear();
        labels.clear();
    }
    const int begin = int(place) * options.batch;
    const int end = std::min(begin + options.batch, int(samples.Count()));
    const int used = (end - begin + kChunkSize - 1) / kChunkSize;
    ForEachIndex(used, [&](int i) {
        FillChunk(i, begin + i * kChunkSize, std::min(begin + (i + 1) * kChunkSize, end),
                  end - begin);
        for (std::span<float> span : gradients[size_t(i)].Spans())
            std::fill(span.begin(), span.end(), 0.f);
        chunks[size_t(i)].result =
            AddGradient(weights, chunks[size_t(i)].batch, &gradients[size_t(i)]);
    });
    optimizer.Step(std::span(gradients).first(size_t(used)), &weights);
    ++step;

    for (const Chunk& chunk : std::span(chunks).first(size_t(used))) {
        lossSum += chunk.result.loss * (end - begin);
        for (int s = 0; s < chunk.batch.count; ++s) {
            answers.push_back(chunk.result.probabilities[s]);
            labels.push_back(chunk.batch.targets[s] > 0);
        }
    }
    if (!std::isfinite(lossSum) || std::any_of(answers.end() - (end - begin), answers.end(),
                                               [](float p) { return !std::isfinite(p); }))
        throw std::runtime_error("the training has diverged; a lower learning rate could help");
}

TrainingProgress Trainer::Progress() const {
    const int64_t count = int64_t(samples.Count());
    TrainingProgress progress{
        .epoch = int(step / stepsPerEpoch),
        .epochs = options.epochs,
        .samples = step / stepsPerEpoch * count + step % stepsPerEpoch * options.batch,
        .allSamples = count * options.epochs};
    if (answers.empty()) return progress;
    progress.loss = lossSum / double(answers.size());
    progress.auc = AreaUnderRoc(answers, labels);
    return progress;
}

uint32_t Trainer::Fingerprint() const {
    StateWriter writer;
    auto put = [&](const auto& values) {
        writer.Put(uint64_t(values.size()));
        writer.PutAll(std::span(values));
    };
    put(options.units);
    writer.Put(options.dropout);
    writer.Put(options.learningRate);
    writer.Put(options.batch);
    writer.Put(options.epochs);
    writer.Put(options.seed);
    writer.Put(options.balanceViewpoints);
    writer.Put(options.balanceClasses);
    const std::string features =
        FeatureNames(samples.settings.features) + (samples.settings.takesMean ? ":mean" : ":");
    put(features);
    put(samples.noisy);
    put(samples.windows);
    return uint32_t(
        crc32_z(0, reinterpret_cast<const Bytef*>(writer.bytes.data()), writer.bytes.size()));
}

std::vector<std::byte> Trainer::Save() const {
    StateWriter writer;
    writer.Put(kTrainerTag);
    writer.Put(Fingerprint());
    writer.Put(step);
    writer.Put(lossSum);
    writer.Put(uint64_t(answers.size()));
    writer.PutAll(std::span(answers));
    writer.PutAll(std::span(labels));
    for (std::span<const float> span : weights.Spans()) writer.PutAll(span);
    for (std::span<const float> span : optimizer.meanSquares.Spans()) writer.PutAll(span);
    return std::move(writer.bytes);
}

void Trainer::Restore(std::span<const std::byte> state) {
    StateReader reader(state);
    reader.Expect(kTrainerTag);
    if (reader.Get<uint32_t>() != Fingerprint())
        throw std::runtime_error("the saved training had other samples or options");
    step = reader.Get<int64_t>();
    lossSum = reader.Get<double>();
    const uint64_t count = reader.Get<uint64_t>();
    if (step < 0 || step > stepsPerEpoch * options.epochs || !std::isfinite(lossSum) ||
        count > samples.Count())
        throw std::runtime_error("the saved training is damaged");
    answers.resize(count);
    labels.resize(count);
    reader.GetAll(std::span(answers));
    reader.GetAll(std::span(labels));
    for (std::span<float> span : weights.Spans()) reader.GetAll(span);
    for (std::span<float> span : optimizer.meanSquares.Spans()) reader.GetAll(span);
    reader.Finish();
    StartEpoch();
}

}  // namespace lull
