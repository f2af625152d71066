// Lets a render end early but in order.
#pragma once

namespace lull {

// From now on the first SIGINT or SIGTERM makes Interrupted() true, and a second one ends the
// program at once with exit code 130.
void CatchInterrupts();
bool Interrupted();

}  // namespace lull
