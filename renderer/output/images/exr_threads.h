// OpenEXR compresses strips of a file on threads of its own, which the whole program shares.
#pragma once

namespace lull {

// Starts a thread a processor, once, and returns how many there are.
int UseExrThreads();

}  // namespace lull
