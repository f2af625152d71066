#include "stopping/lab/training/training_checkpoint.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "stopping/base/checksum.h"
#include "stopping/base/state.h"

namespace lull {

namespace {

constexpr uint32_t checkpointTag = 0x3143524c;  // "LRC1"

}  // namespace

void TrainingCheckpoint::Read() try {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("there is no checkpoint to resume from");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    StateReader reader(CheckSeal(std::as_bytes(std::span(text))));
    reader.Expect(checkpointTag);
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
        throw CheckpointError(path + ": " + error.what());
    }
}

bool TrainingCheckpoint::IsDue() const {
    return !path.empty() && Clock::now() > written + interval;
}

void TrainingCheckpoint::Write() {
    if (path.empty()) return;
    StateWriter writer;
    writer.Put(checkpointTag);
    for (const std::vector<std::byte>& state : states) writer.PutVector(state);
    Seal(&writer.bytes);
    try {
        write(path, writer.bytes);
    } catch (const std::runtime_error& error) {
        throw CheckpointError(error.what());
    }
    written = Clock::now();
}

void TrainingCheckpoint::Remove() {
    states.clear();
    if (!path.empty()) std::filesystem::remove(path);
}

}  // namespace lull
