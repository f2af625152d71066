// The samples per pixel at which a rule checks a block.
#pragma once

namespace lull {

// A rule checks a block at first, first + every, first + 2 every, ... spp; or, where pictures come
// at any spp, at whatever comes `every` spp or more after the last check.
struct Checks {
    int first = 1;      // the least spp of a check, > 0
    int every = 1;      // spp from one to the next, > 0
    double growth = 1;  // of the spp from one to the next, at the least
    bool any = false;   // pictures come at any spp

    // Returns whether a check is due at `spp` > 0, after one at `last` spp; 0: there was none.
    bool AreDue(int spp, int last = 0) const {
        if (spp < first || spp < growth * last) return false;
        return any ? last == 0 || spp - last >= every : (spp - first) % every == 0;
    }
};

}  // namespace lull
