// Loads the module of OpenImageIO.
#pragma once

namespace lull {

// Returns a function of the module by its name. The first call loads the module, which takes 0.2 s.
// Throws std::runtime_error if it cannot be loaded: `purpose` is the beginning of the message.
void* ModuleFunction(const char* name, const char* purpose);

}  // namespace lull
