// Decides on all blocks of an image, behind the C interface; lull/lull.h describes the
// functions. Can be used by several threads at once.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "lull/lull.h"
#include "renderer/embedding/picture.h"
#include "stopping/rules/rule.h"
#include "stopping/rules/thresholds.h"
#include "stopping/signals/lightness.h"

namespace lull {

class Stopper {
  public:
    // Throws std::invalid_argument for bad settings and std::runtime_error for bad files.
    explicit Stopper(const lull_settings& settings);

    const BlockGrid& Grid() const { return grid; }
    // Returns where a block lies. Throws std::invalid_argument if there is no such block.
    lull_rect RectOf(int block) const;
    bool NeedsHalf() const { return needsHalf; }
    bool Done() const;

    // Throw std::invalid_argument, before anything has changed, for an image that does not fit the
    // settings or the block, for values that no image has (ImageValues) where they would be
    // looked at, and for an spp that is not above the block's last.
    std::vector<lull_answer> Observe(const lull_image& picture, int spp);
    lull_answer ObserveBlock(int block, const lull_image& picture, int spp);
    lull_answer Answer(int block) const;
    // Returns a warning about the images shown, valid until the next call; "" if there is none.
    const char* Warning() const;

    std::vector<std::byte> Save() const;
    // Throws std::runtime_error if the state is damaged or belongs to other settings.
    void Restore(std::span<const std::byte> state);

  private:
    struct BlockState {
        std::unique_ptr<Criterion> criterion;  // null for a block that follows another
        lull_answer answer = {};
        PictureSpacing spacing = {};
    };

    BlockState MakeState(int block) const;
    std::vector<std::unique_lock<std::mutex>> LockAll() const;
    PictureValues CheckValues(int block, const lull_image& picture, const lull_rect& part,
                              int spp) const;
    void Check(int block, const lull_image& picture, const lull_rect& part, int spp);
    void NoteChannels(const lull_image& picture);
    void NoteSpacing(BlockState* state);

    std::shared_ptr<const Rule> rule;
    BlockGrid grid;
    std::vector<std::byte> identity;  // of its saved states
    int firstCheck = 0;               // the least spp that is checked; 0: none
    bool needsHalf = false;
    std::vector<BlockState> states;
    mutable std::vector<std::mutex> locks;  // one for each block
    mutable std::mutex warningLock;
    std::string spacingWarning, channelWarning;
    mutable std::string warning;  // as it was last handed out
};

// Finds the installed models from within a library that may have been moved.

// Returns the folder of installed models: $LULL_MODELS if that is set and not empty, else the one
// relative to this library as installed.
std::string InstalledModels();

}  // namespace lull
