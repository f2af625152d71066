// OpenEXR compresses strips of a file on threads of its own, which the whole program shares.
#pragma once

namespace lull {

// Starts a thread per processor, once, and returns their number.
int UseExrThreads();

}  // namespace lull
