#include "renderer/lab/commands/study_options.h"

#include <CLI/CLI.hpp>

#include "renderer/commands/command.h"
#include "renderer/lab/commands/lab_options.h"
#include "renderer/lab/viewpoints/recorded_viewpoint.h"

namespace lull::study {

namespace {

// Those with an effect on a study of another renderer's pictures, and on the collection of answers.
constexpr const char* kOptionsOfPictures[] = {
    "--images", "--name",    "--levels",  "--block", "--threads",
    "--output", "--repeats", "--catches", "--quiet", "--json-progress"};
constexpr const char* kOptionsOfAnswers[] = {"--collect", "--study", "--output",
                                             "--report",  "--quiet", "--json-progress"};

constexpr const char* kFooter =
    R"(Makes a page on which observers mark visible noise, and collects their answers.

The scene is rendered to the cap once, and each block stored at a ladder of sample counts, each level
a quarter above the last. STUDY.html opens from disk in any browser, without a network connection; an
observer ends with a small file of answers. An interrupted render leaves STUDY.html.checkpoint, from
which the same command continues. The noise is that of `lull record`, by pbrt-v3's estimator and random
sampler, unless --sampler and --estimator are given.

Image and reference are side by side: observers point where they differ, and the block gets one level
better, until both look the same (Buisine et al. 2021). Start levels differ between observers, some
blocks are asked twice, and some show the reference on both sides, to detect inattentive observers.
Observers cannot begin in a window that is too small for both pictures.

--collect writes, in one folder:
  HUMAN.csv             mean thresholds over observers, in the format of the published ones
  HUMAN.details.csv     of each block: the spread over observers
  HUMAN.observers.csv   of each observer: consistency, checks failed, display, distance, who was left
                        out or is in doubt, and why
  HUMAN.answers.csv     single answers with observer and adjustment (track), for `lull evaluate
                        --answers`
Damaged, foreign and contradictory files are named and left out.

Examples:
  lull study scene.pbrt -o study.html --record data.h5
  lull study scene.pbrt -o study.html --resolution 800x800 --cap 2000
  lull study --images pictures/ --name kitchen-view0 -o study.html
  lull study --collect answers/*.json -o human.csv --study study.html --report collected.html
  lull train data.h5 --human human.csv -o model.h5

Exit codes: 0 success, 1 input or environment error, 2 usage error, 130 interrupted.)";

void AddStudyOptions(CLI::App& app, StudySettings* s) {
    app.add_option("--repeats", s->repeats, "Ask this fraction of the blocks twice")
        ->check(Between(0.0, 1.0))
        ->type_name("X")
        ->capture_default_str();
    app.add_option("--catches", s->catches, "Check observers in this fraction of the blocks")
        ->check(Between(0.0, 0.5))
        ->type_name("X")
        ->capture_default_str();
}

[[noreturn]] void Refuse(const std::string& message) {
    throw CLI::ValidationError("study", message);
}

}  // namespace

void AddOptions(CLI::App& app, Options* s) {
    AddRenderSettings(app, &s->render);
    app.get_option("SCENE")->required(false);
    app.add_option("--images", s->images,
                   "Read images of another renderer, with the spp in their file names")
        ->type_name("DIR");
    app.add_option("--collect", s->collect, "Collect these files of answers")
        ->type_name("ANSWERS.json ...");
    app.add_option("-o,--output", s->output, "The page to make, or the thresholds to write")
        ->group(kCommonOptions)
        ->type_name("STUDY.html|HUMAN.csv");
    app.add_option("--name", s->name, "Name the viewpoint, as in thresholds files [the scene's]")
        ->check(CheckViewpointName);
    app.add_option("--levels", s->levels,
                   "Set the number of sample counts per block [each 1.25 times the last]")
        ->check(Between(2, 200))
        ->type_name("N");
    app.add_option("--record", s->record,
                   "Record the block histories of the render in this data set")
        ->type_name("DATA.h5");
    AddCheckpointInterval(app, &s->render.checkpoint);
    AddStudyOptions(app, &s->study);
    app.add_option("--study", s->studyPage, "With --collect: take only answers to this study")
        ->type_name("STUDY.html");
    app.add_option("--report", s->report, "Write a page of the answers, with --collect")
        ->group(kCommonOptions)
        ->type_name("PAGE.html");
    app.footer(kFooter);
}

void CheckOptions(const CLI::App& app, const Options& s) {
    if (s.output.empty()) throw CLI::ValidationError("--output", "is required");
    const bool hasScene = !s.render.scene.file.empty();
    if (int(hasScene) + int(!s.images.empty()) + int(!s.collect.empty()) != 1)
        Refuse("a SCENE is needed, or --images, or --collect; one of them");
    if (s.collect.empty() && !s.output.ends_with(".html"))
        Refuse("-o " + s.output + ": a study is a page, STUDY.html");
    if (!s.collect.empty() && !s.output.ends_with(".csv"))
        Refuse("-o " + s.output + ": collected thresholds are a table, HUMAN.csv");
    if (!s.record.empty() && !hasScene) Refuse("--record needs a SCENE, which is rendered");
    if (s.collect.empty() && !(s.report.empty() && s.studyPage.empty()))
        Refuse("--report and --study need --collect");
    if (!s.report.empty() && !s.report.ends_with(".html"))
        Refuse("--report " + s.report + ": the report is a page, PAGE.html");
    if (!s.images.empty()) AllowOnly(app, kOptionsOfPictures, "with --images");
    if (!s.collect.empty()) AllowOnly(app, kOptionsOfAnswers, "with --collect");
}

}  // namespace lull::study
