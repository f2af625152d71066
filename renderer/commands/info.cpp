// `lull info`: says what is in a scene.
#include "renderer/commands/command.h"
namespace lull {
void AddInfoCommand(CLI::App&, Command*) {}
}  // namespace lull
