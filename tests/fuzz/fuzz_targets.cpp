#include "tests/fuzz/fuzz_targets.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <stdexcept>

#include "renderer/image/image_io.h"
#include "renderer/input/gltf_loader.h"
#include "renderer/input/pbrt_parser.h"
#include "renderer/input/ply_loader.h"
#include "renderer/lab/pages/comparison_page.h"
#include "renderer/render/session.h"
#include "renderer/scene/cameras/lens_system.h"
#include "renderer/scene/geometry/shape_table.h"
#include "renderer/scene/materials/basic.h"
#include "renderer/scene/media/medium_table.h"
#include "renderer/vision/visible_difference.h"
#include "stopping/base/input_file.h"
#include "stopping/lab/evaluation/answer_scores.h"
#include "stopping/lab/observers/observers.h"
#include "stopping/lab/recordings/recording.h"
#include "stopping/lab/training/training.h"
#include "stopping/network/model_file.h"
#include "stopping/rules/rule.h"
#include "stopping/rules/rule_table.h"
#include "stopping/rules/thresholds.h"
#include "tests/renderer/files/test_files.h"

namespace lull {

namespace {

// Writes the bytes to a file, always the same one, and returns its path.
std::string WriteInput(std::span<const char> bytes) {
    static const TemporaryDirectory directory;
    return directory.Write("input", {bytes.data(), bytes.size()});
}

// Returns whether `read` takes its input; it may refuse that by this exception alone.
template <typename Refusal, typename Read>
bool Takes(const Read& read) {
    try {
        read();
        return true;
    } catch (const Refusal&) {
        return false;
    }
}

void FuzzPbrt(std::span<const char> bytes) {
    const std::string path = WriteInput(bytes);
    Warnings warnings;
    Takes<Error>([&] { ParsePbrt(path, warnings); });
}

// Reads bytes as a scene for pbrt-v4, whatever they are, and compiles its materials.
void FuzzPbrt4(std::span<const char> bytes) {
    const std::string path = WriteInput(bytes);
    Warnings warnings({}, true);
    Takes<Error>([&] {
        const Description d = ParsePbrt(path, warnings, PbrtVersion::V4);
        const TextureTable textures(d, warnings);
        const MaterialTable materials(d, textures, warnings);
        const ShapeTable shapes(d, textures, warnings);
    });
}

void FuzzGltf(std::span<const char> bytes) {
    const std::string path = WriteInput(bytes);
    Warnings warnings;
    for (const GltfOptions& options :
         {GltfOptions{}, GltfOptions{.frame = 0.5, .shutter = 0.5, .variant = "0"}})
        Takes<Error>([&] { ParseGltf(path, options, warnings); });
}

void FuzzPly(std::span<const char> bytes) {
    const std::string path = WriteInput(bytes);
    Warnings warnings;
    Takes<Error>([&] { LoadPly(path, warnings); });
}

void FuzzBsdf(std::span<const char> bytes) {
    const std::string path = WriteInput(bytes);
    Takes<Error>([&] { LoadFourierTable(path); });
}

void FuzzLens(std::span<const char> bytes) {
    const std::string path = WriteInput(bytes);
    Takes<Error>([&] { LoadLens(path, {}); });
}

// Reads bytes as an image of the format that has this signature.
void FuzzImage(std::span<const char> bytes, std::string_view signature) {
    std::string image(bytes.begin(), bytes.end());
    image.replace(0, signature.size(), signature);
    Takes<Error>([&] { ReadImage("input", "", std::as_bytes(std::span(image))); });
    const std::string path = WriteInput(image);
    Takes<Error>([&] { ReadExr(path); });
}

void FuzzPng(std::span<const char> bytes) { FuzzImage(bytes, "\x89PNG\r\n\x1a\n"); }
void FuzzExr(std::span<const char> bytes) { FuzzImage(bytes, "\x76\x2f\x31\x01"); }

// Compiles the parameters of a scene, without the acceleration structure.
void FuzzScene(std::span<const char> bytes) {
    const std::string path = WriteInput(bytes);
    Warnings warnings({}, true);
    Takes<Error>([&] {
        const Description d = ParsePbrt(path, warnings);
        const TextureTable textures(d, warnings);
        const MaterialTable materials(d, textures, warnings);
        const ShapeTable shapes(d, textures, warnings);
        const MediumTable media(d, warnings);
    });
}

void FuzzModel(std::span<const char> bytes) {
    const std::string path = WriteInput(bytes);
    Takes<std::runtime_error>([&] { ReadModel(path); });
}

// The part of a model file that lull itself parses, in a file that the HDF5 library has no trouble
// with.
void FuzzKerasConfig(std::span<const char> bytes) {
    for (const char* version : {"", "2.2.4", "2.11.0"})
        Takes<std::runtime_error>([&] { ParseKerasConfig({bytes.begin(), bytes.end()}, version); });
}

// Thresholds are written as they were read, but for the ends of lines.
void FuzzThresholds(std::span<const char> bytes) {
    std::istringstream in(std::string(bytes.begin(), bytes.end()));
    std::vector<ThresholdsRow> rows;
    if (!Takes<std::runtime_error>([&] { rows = ReadThresholds(in, "input"); })) return;
    std::stringstream copy;
    WriteThresholds(copy, rows);
    const std::vector<ThresholdsRow> again = ReadThresholds(copy, "copy");
    bool same = again.size() == rows.size();
    for (size_t i = 0; same && i < rows.size(); ++i)
        same = again[i].name == rows[i].name && again[i].spp == rows[i].spp;
    if (!same) throw std::logic_error("thresholds change when written and read again");
}

// Answers that can be read can be collected and written.
void FuzzAnswers(std::span<const char> bytes) {
    ObserverAnswers answers;
    if (!Takes<std::runtime_error>([&] { answers = ParseAnswers({bytes.data(), bytes.size()}); }))
        return;
    answers.file = "input";
    ObserverAnswers other = answers;
    other.observer += " the second";
    other.session += "2";
    const Collected collected = CollectObservers({answers, other}, {});
    std::ostringstream out;
    WriteThresholds(out, ThresholdsOf(collected));
}

// An answer that can be read is possible.
void FuzzSingleAnswers(std::span<const char> bytes) {
    std::istringstream in(std::string(bytes.begin(), bytes.end()));
    std::vector<SingleAnswer> answers;
    if (!Takes<std::runtime_error>([&] { answers = ReadSingleAnswers(in, "input"); })) return;
    if (answers.empty()) throw std::logic_error("a file without answers was taken");
    for (const SingleAnswer& answer : answers)
        if (answer.block < 0 || answer.spp < 1 || answer.line < 2)
            throw std::logic_error("an answer that cannot be was taken");
}

// A display is written so that it is read as the same.
void FuzzDisplay(std::span<const char> bytes) {
    DisplayModel display;
    if (!Takes<Error>([&] { display = ParseDisplay({bytes.data(), bytes.size()}); })) return;
    const DisplayModel again = ParseDisplay(NameOf(display));
    if (again.peak != display.peak || again.pixelsPerDegree != display.pixelsPerDegree ||
        again.ambient != display.ambient)
        throw std::logic_error("a display changes when written and read again");
}

// Most findings are in the HDF5 library, as with `model`.
void FuzzDataset(std::span<const char> bytes) {
    const std::string path = WriteInput(bytes);
    Takes<std::runtime_error>([&] { ReadDataset(path); });
}

// Writes bytes with the checksum that belongs to them, and returns the path.
std::string WriteSealed(std::span<const char> bytes) {
    std::vector<std::byte> sealed(bytes.size());
    std::ranges::copy(std::as_bytes(bytes), sealed.begin());
    Seal(&sealed);
    return WriteInput({reinterpret_cast<const char*>(sealed.data()), sealed.size()});
}

// What is behind the checksum of a file; most of what is found is in the HDF5 library.
void FuzzCheckpoint(std::span<const char> bytes) {
    const std::string path = WriteSealed(bytes);
    Film film({{0, 0}, {4, 4}}, {.grid = {4, 4}});
    Takes<std::runtime_error>([&] { ReadCheckpoint(path, {}, &film); });
}

void FuzzStudyPage(std::span<const char> bytes) {
    const std::string path = WriteInput(bytes);
    Takes<Error>([&] { ReadStudyPage(path); });
}

void FuzzTrainingCheckpoint(std::span<const char> bytes) {
    const std::string path = WriteSealed(bytes);
    Takes<std::runtime_error>([&] { TrainingCheckpoint(path, 1, {}).Read(); });
}

// The states of rules in a checkpoint; the first byte says of which.
void FuzzCriterionState(std::span<const char> bytes) {
    static const std::array<Rule, 4> rules = {ParseRule("entropy:0.5"), ParseRule("lnoise:0.5"),
                                              ParseRule("dammertz:0.02"), ParseRule("fixed:100")};
    if (bytes.empty()) return;
    const auto criterion = MakeCriterion(rules[size_t(bytes[0]) % rules.size()]);
    Takes<std::runtime_error>([&] { criterion->Restore(std::as_bytes(bytes.subspan(1))); });
}

}  // namespace

std::vector<NamedFuzzTarget> FuzzTargets() {
    return {{"pbrt", FuzzPbrt},
            {"pbrt4", FuzzPbrt4},
            {"gltf", FuzzGltf},
            {"ply", FuzzPly},
            {"bsdf", FuzzBsdf},
            {"lens", FuzzLens},
            {"png", FuzzPng},
            {"exr", FuzzExr},
            {"scene", FuzzScene},
            {"model", FuzzModel},
            {"keras_config", FuzzKerasConfig},
            {"thresholds", FuzzThresholds},
            {"answers", FuzzAnswers},
            {"single_answers", FuzzSingleAnswers},
            {"display", FuzzDisplay},
            {"dataset", FuzzDataset},
            {"checkpoint", FuzzCheckpoint},
            {"study_page", FuzzStudyPage},
            {"training_checkpoint", FuzzTrainingCheckpoint},
            {"criterion_state", FuzzCriterionState}};
}

}  // namespace lull
