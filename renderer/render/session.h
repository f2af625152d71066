// Runs a render as a user configures it: Render() with its film, checkpoints, clock, viewer
// and other ranks. Messages go to callbacks.
//
//     Session session(scene, region, options);
//     session.Resume();
//     const RenderResult result = session.Run();
#pragma once

#include <string>

#include "renderer/render/provenance.h"
#include "renderer/render/render.h"

namespace lull {

// Checkpoint files: the complete state of a render, to continue it to the same bits.

// Writes film and state to an HDF5 file, whole or not at all. Throws Error.
void WriteCheckpoint(const std::string& path, const RenderIdentity&, const RenderState&,
                     const Film&);

// Settings that may differ from the checkpoint's: none, or the settings that decide when blocks
// stop, which are the rule, with its model, and the cap.
enum class MayDiffer { Nothing, Stops };

// Fills the film, which has no samples yet, and returns the state. Layers that the film has must be
// in the checkpoint; others there are left out. Throws Error if the file cannot be read, is
// damaged, or was written by another render: the message names the difference.
//
// With a larger cap blocks at the old cap continue. With another rule all do; the state then has
// neither criteria nor decisions: each starts again, at the sample count of its block.
RenderState ReadCheckpoint(const std::string& path, const RenderIdentity&, Film*,
                           MayDiffer = MayDiffer::Nothing);

// Location of the checkpoint of a render.
struct CheckpointOptions {
    std::string file;        // empty: none
    double interval = 60;    // seconds
    bool resume = false;     // continues from the file, if it exists
    bool isKept = false;     // also when every block has stopped
    bool isImplied = false;  // named by the command, which resumes without being told to
    MayDiffer mayDiffer = MayDiffer::Nothing;
};

// Returns the film of a scene: with the spreads that light paths need.
FilmOptions FilmFor(const Scene&, FilmOptions);

// Returns the bytes a pixel of such layers, with what is made of them in the end.
int64_t BytesOfLayers(const LayerOptions&);

// Throws Error where the memory cannot hold such a film, the planes of its light paths, what the
// denoiser and files make of its layers in the end, and `more` bytes a pixel.
void CheckFilmFits(const PixelRect& region, const FilmOptions&, int64_t more = 0);

struct SessionOptions {
    RenderOptions render;
    Estimator estimator = Estimator::Combined;
    FilmOptions film;  // with the half where there are features
    // Whether the film gets a first look (film_picture.h) before the samples; not on several ranks.
    bool firstLook = false;
    CheckpointOptions checkpoint;
    // Settings that decide the pixels, for checkpoints and for ranks, which have to agree on them.
    RenderIdentity identity;
    // Returns the seconds until the files of the image are due. Can be empty.
    std::function<double()> clock;
    // Waits until all ranks are about to render `what`. Can be empty.
    std::function<void(const std::string& what)> agree;
};

// Render(), or a function that prepares and calls it.
using RenderFunction = std::function<RenderResult(const RenderOptions&)>;

class Session {
  public:
    // The scene must outlive it.
    Session(const Scene&, const PixelRect& region, SessionOptions);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    // Restores the checkpoint, if it is to be resumed. Throws as ReadCheckpoint().
    void Resume();
    // Before that: calls `show` with the film and the progress, every `seconds`, with no thread at
    // work; called at all ranks, of which the first is shown.
    void Preview(double seconds, std::function<void(const RenderResult&)> show);
    // Renders, once. Of several ranks, the first has the image. Throws as Render() does.
    RenderResult Run(const RenderFunction& render = Render);

    // Returns whether this is the first or only rank, which has to do with files.
    bool Leads() const;
    Film& GetFilm() { return film; }
    const RenderOptions& Options() const { return options.render; }

  private:
    void SetClock();
    void KeepCheckpoints();

    const Scene& scene;
    const PixelRect region;
    SessionOptions options;
    Film film;
    std::optional<RenderState> interrupted;
    std::unique_ptr<LightRounds> lightRounds;
};

}  // namespace lull
