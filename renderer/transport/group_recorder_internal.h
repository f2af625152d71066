// Tells the light of groups apart, besides the first hit.
#pragma once

#include "renderer/transport/first_hit_internal.h"
#include "renderer/transport/group_radiance.h"

namespace lull {

class GroupRecorder : public FirstHitRecorder {
  public:
    GroupRecorder(const FirstHitRecorder& firstHit, GroupRadiance* groups)
        : FirstHitRecorder(firstHit), groups(groups) {}

    void FindLight(const Path& path, int index, const Rgb& L) { groups->Add(index, path.beta * L); }

  private:
    GroupRadiance* groups;
};

}  // namespace lull
