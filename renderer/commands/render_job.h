// Renders as commands do: the scene is loaded, checked and compiled, and rendered by a session that
// prints its messages on stderr and continues from its checkpoint.
//
//     RenderJob render(settings, ranks);
//     render.CheckFiles({{"-o", output}});
//     render.Compile();
//     Session session(*render.scene, render.region, render.MakeSessionOptions(false));
//     const RenderResult result = render.Run(&session);
//     if (const auto code = render.End(result.cancelled)) return *code;
//     ...  // writes the results
//     render.RemoveCheckpoint();
#pragma once

#include <optional>

#include "renderer/commands/command.h"
#include "renderer/commands/render_settings.h"
#include "renderer/files/outputs.h"
#include "renderer/render/film_picture.h"

namespace lull {

class RenderJob {
  public:
    // Loads the scene. The job of ranks, which share the render and of which the first prints and
    // has to do with files, must outlive it; null: there are none. Throws Error, also where the
    // memory cannot hold the film, with its half or without.
    RenderJob(const RenderSettings&, MpiJob* ranks, bool withHalf = true);
    RenderJob(const RenderJob&) = delete;
    RenderJob& operator=(const RenderJob&) = delete;

    bool Leads() const;
    // There, throws Error where a result or the checkpoint would replace another or an input, or
    // could not be written now. Takes the checkpoint for this process alone.
    void CheckFiles(std::vector<NamedFile> outputs, std::vector<NamedFile> inputs = {});
    // There, takes the results, of which `output` is one, for this process alone. Throws Error if
    // another process has them.
    void LockResults(const std::string& output);
    void DenoiseBlocks();
    // Warns where blocks are denoised from samples whose halves depend on each other.
    void CheckSampler() const;
    // Reads a stopping rule that was given with `option`, which the Error that a bad one is names;
    // with the caution of the settings, unless there is another.
    Rule ReadRule(const std::string& option, const std::string& rule,
                  std::optional<double> caution = {}) const;
    // Compiles the scene, and sets the sampler, if none is named, and the provenance but the rule.
    void Compile();
    // Returns the identity that checkpoints and ranks must share, from the provenance.
    RenderIdentity Identity() const;
    // Returns the options of an interruptible session without a rule; where it is shared, with the
    // checkpoint and all ranks. `adaptive`: blocks stop by themselves, as the progress shows.
    SessionOptions MakeSessionOptions(bool adaptive, bool isShared = true) const;
    // Takes up the checkpoint, and renders until the end or an interruption.
    RenderResult Run(Session*, const RenderFunction& render = Render) const;
    // Lets the ranks go after the last render. Returns the exit code where nothing is to be
    // written: at all ranks but the first, and after an interruption, of which it says so.
    std::optional<ExitCode> End(bool isInterrupted) const;
    // To be called when the results are written, unless it is to be kept.
    void RemoveCheckpoint() const;

    RenderSettings settings;
    MpiJob* const ranks;
    // The scene as it was read, its film as the options change it, and the crop of that.
    Warnings warnings;  // printed as they occur
    Description description;
    FilmSettings filmSettings;
    PixelRect region;
    std::unique_ptr<const Scene> scene;  // null before Compile()
    Provenance provenance;
    std::shared_ptr<BlockDenoiser> denoiser;  // null: blocks are not denoised

  private:
    std::optional<FileLock> checkpointLock, resultLock;
};

// Returns the options of a render that resumes from the file without being told to.
CheckpointOptions ResumeIfThere(const std::string& file, double interval);

// Returns exclusive access to a checkpoint. Throws Error if another process has it.
FileLock LockCheckpointFile(const std::string& file);

// Returns how to continue a render that has ended early: by which command, if it has a checkpoint.
std::string HowToGoOn(const CheckpointOptions&);

// From now on the first SIGINT, SIGTERM or SIGHUP makes Interrupted() true, and a second one ends
// the program at once with exit code 130; not so a second SIGHUP, as a terminal that is closed
// sends several. Where SIGHUP is ignored, as by nohup, it stays so.
void CatchInterrupts();
bool Interrupted();

// Lets errors and warnings be JSON where all there is to say is; to be called first of all.
void SetWording(const RenderSettings&, MpiJob* ranks);

}  // namespace lull
