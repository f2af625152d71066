// Builds the images of a study in which observers mark visible noise.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "renderer/lab/viewpoints/picture_folder.h"
#include "renderer/lab/viewpoints/recorded_viewpoint.h"
#include "renderer/schedule/schedule.h"
#include "stopping/rules/rule.h"

namespace lull {

// Keeps how a block looks on a display at a ladder of samples per pixel, for people to judge.

// The pixels of a block as a display shows them: 8-bit sRGB, R, G, B, row by row.
using DisplayPixels = std::vector<uint8_t>;

// Returns the spp of a ladder whose steps are as near to `ratio` (> 1) as whole passes allow:
// increasing multiples of `pass` from `pass` on, and `cap` as the last.
std::vector<int> LadderByRatio(int pass, int cap, double ratio);

// Returns such a ladder with `count` (>= 2) levels, or fewer if there are not that many passes.
std::vector<int> LadderByCount(int pass, int cap, int count);

// Continues to the last level and keeps a picture at each; `pictures`, which must outlive it,
// receives them in the order of the levels. Shows all passes to `companion` too, if any.
class PictureLadder final : public Criterion {
  public:
    PictureLadder(std::vector<int> levels, std::unique_ptr<Criterion> companion,
                  std::vector<DisplayPixels>* pictures);

    ViewNeed Need(int spp) const override;
    Decision Observe(const BlockView& view) override;
    std::vector<std::byte> Save() const override;
    void Restore(std::span<const std::byte> state) override;

  private:
    bool IsLevel(int spp) const;

    std::vector<int> levels;
    std::unique_ptr<Criterion> companion;
    std::vector<DisplayPixels>* pictures;
};

struct StudyBlock {
    PixelRect pixels;                     // of the image
    std::vector<DisplayPixels> pictures;  // one for each level
};

// One viewpoint: its blocks, row by row, at every level of a ladder, the last of which is the
// reference.
struct Study {
    std::string viewpoint;  // its name in thresholds files
    int width = 0, height = 0;
    std::vector<int> levels = {};  // spp, increasing, at least two
    std::vector<StudyBlock> blocks = {};
    std::map<std::string, std::string> provenance = {};  // of the pictures
};

// Returns 16 hexadecimal digits that tell studies apart: a hash of names, levels, positions and all
// pictures. Answers to one study say nothing about another.
std::string StudyId(const Study&);

// Returns the RMS of a block's difference in lightness (0 to 100) from the reference at a level.
double NoiseOf(const StudyBlock&, size_t level);

// Makes a study of the pictures of another renderer: of those nearest to the levels of a ladder of
// `count` levels or, where count is 0, of steps of `ratio`. Throws Error.
Study MakeStudy(const PictureFolder&, int blockSize, int count, double ratio);

// Makes the pictures of a study by rendering them.

// Returns a study without its pictures. Blocks are within `region`, which becomes the image.
Study BeginStudy(const std::string& viewpoint, const PixelRect& region, std::vector<int> levels,
                 const std::vector<Block>& blocks, const RenderIdentity&);

// Renders all blocks to the cap, the study's last level, and fills in their pictures; records the
// same samples for learning in `viewpoint`, unless that is null. Starts from film and state of an
// interrupted render of the same study, if any. The options have no rule.
RenderResult RenderStudy(RenderOptions, Study*, ViewpointRecording* viewpoint);

}  // namespace lull
