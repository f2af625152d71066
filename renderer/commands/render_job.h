// Renders as commands do: the scene is loaded, checked and compiled, and rendered by a session that
// prints its messages on stderr and continues from its checkpoint.
//
//     RenderJob render(settings, ranks);
//     render.CheckFiles({{"-o", output}});
//     render.Compile();
//     Session session(*render.scene, render.input.region, render.MakeSessionOptions(false));
//     const RenderResult result = render.Run(&session);
//     if (const auto code = render.End(result.cancelled)) return *code;
//     ...  // writes the results
//     render.RemoveCheckpoint();
#pragma once

#include <optional>

#include "renderer/commands/command.h"
#include "renderer/commands/render_settings.h"
#include "renderer/files/outputs.h"
#include "renderer/render/block_denoiser.h"

namespace lull {

class RenderJob {
  public:
    // Loads the scene. The job of ranks, which share the render and of which the first prints and
    // has to do with files, must outlive it; null: there are none. Throws Error, also where the
    // memory cannot hold the film, with its half or without.
    RenderJob(const RenderSettings&, MpiJob* ranks, bool withHalf = true);
    RenderJob(const RenderJob&) = delete;
    RenderJob& operator=(const RenderJob&) = delete;

    // Returns whether this is the first rank.
    bool Leads() const;
    // There, throws Error where a result or the checkpoint would replace another or an input, of
    // which those of the scene are known, or could not be written now. Takes the checkpoint for
    // this process alone.
    void CheckFiles(std::vector<NamedFile> outputs, std::vector<NamedFile> inputs = {});
    // There, takes the results, of which `output` is one, for this process alone. Throws Error if
    // another process has them.
    void LockResults(const std::string& output);
    // Locks the checkpoint of the settings, which have changed, instead. Throws Error if another
    // process has it.
    void LockCheckpoint();
    // Lets rules read denoised blocks during the render.
    void DenoiseBlocks();
    // Warns where blocks are denoised from samples whose halves depend on each other.
    void CheckSampler() const;
    // Reads a stopping rule that was given with `option`. Throws Error.
    Rule ReadRule(const std::string& option, const std::string& rule) const;
    // Compiles the scene, and sets the sampler, where the user names none, and the provenance; the
    // rule is left to be filled in.
    void Compile();
    // Returns the identity that checkpoints and ranks must share, from the provenance.
    RenderIdentity Identity() const;
    // Returns the options of a session with the checkpoint of the settings, without a rule, that
    // can be interrupted and that the ranks share. `adaptive`: blocks stop by themselves, as the
    // progress shows.
    SessionOptions MakeSessionOptions(bool adaptive) const;
    // Takes up the checkpoint, and renders until the end or an interruption.
    RenderResult Run(Session*, const RenderFunction& render = Render) const;
    // Lets the ranks go after the last render. Returns the exit code where nothing is to be
    // written: at all ranks but the first, and after an interruption, of which it says so.
    std::optional<ExitCode> End(bool isInterrupted) const;
    // To be called when the results are written, unless it is to be kept.
    void RemoveCheckpoint() const;

    RenderSettings settings;
    MpiJob* const ranks;
    SceneInput input;
    std::unique_ptr<const Scene> scene;  // null before Compile()
    Provenance provenance;
    std::shared_ptr<BlockDenoiser> denoiser;  // null: blocks are not denoised

  private:
    std::optional<FileLock> checkpointLock, resultLock;
};

// Lets errors and warnings be JSON where all there is to say is; to be called first of all.
void SetWording(const RenderSettings&, MpiJob* ranks);

// RenderJob::MakeSessionOptions() without a checkpoint; the ranks may be null.
SessionOptions MakeSessionOptions(const RenderSettings&, bool adaptive, MpiJob* ranks);

}  // namespace lull
