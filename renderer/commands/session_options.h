// Lets commands render: a session that prints on stderr what there is to say.
#pragma once

#include "renderer/commands/command.h"
#include "renderer/commands/render_settings.h"

namespace lull {

// Returns the options of a session, without a rule and without a checkpoint, that can be
// interrupted, and that the ranks of the job share; null: it has none. `adaptive`: blocks stop by
// themselves, as is to be seen of the progress. The job must outlive it.
SessionOptions MakeSessionOptions(const RenderSettings&, SamplerKind, bool adaptive, Job*);

// Lets the job put errors and warnings as the settings want them; to be called first of all.
void SetWording(const RenderSettings&, Job*);

// Says that a render was interrupted, and what goes on from where.
ExitCode SayInterrupted(const RenderSettings&, const std::string& checkpoint);

}  // namespace lull
