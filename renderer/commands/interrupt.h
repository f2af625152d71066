// Lets a render end early but in order.
#pragma once

namespace lull {

// From now on the first SIGINT, SIGTERM or SIGHUP makes Interrupted() true, and a second one ends
// the program at once with exit code 130; not so a second SIGHUP, as a terminal that is closed
// sends several. Where SIGHUP is ignored, as by nohup, it stays so.
void CatchInterrupts();
bool Interrupted();

}  // namespace lull
