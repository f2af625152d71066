#include "renderer/lab/pages/study_page.h"

#include <fmt/format.h>

#include <sstream>

#include "renderer/base/error.h"
#include "renderer/files/file_io.h"
#include "renderer/image/image_io.h"
#include "renderer/pages/html_page.h"
#include "stopping/base/parallel.h"

namespace lull {

namespace {

constexpr const char* kFormat = "lull-study";
constexpr int kVersion = 1;
constexpr int kMostPixels = 1 << 20;  // a side

Error NotAStudy(const std::string& path) {
    return Error(path + ": not a page made by lull study, or damaged");
}

Json BlockJson(const StudyBlock& block) {
    Json json = RectJson(block.pixels);
    json["noise"] = Json::array();
    for (size_t level = 0; level < block.pictures.size(); ++level)
        json["noise"].push_back(float(NoiseOf(block, level)));
    return json;
}

Json DescribeStudy(const Study& study, const StudySettings& settings) {
    Json json = {{"format", kFormat},           {"version", kVersion},
                 {"id", StudyId(study)},        {"viewpoint", study.viewpoint},
                 {"repeats", settings.repeats}, {"catches", settings.catches},
                 {"width", study.width},        {"height", study.height},
                 {"levels", study.levels},      {"provenance", study.provenance},
                 {"blocks", Json::array()}};
    for (const StudyBlock& block : study.blocks) json["blocks"].push_back(BlockJson(block));
    return json;
}

// Returns the pictures of a block in base64, as the list that the page reads when it needs them.
std::string PicturesScript(const Study& study, size_t i) {
    const StudyBlock& block = study.blocks[i];
    Json list = Json::array();
    for (const DisplayPixels& picture : block.pictures)
        list.push_back(Base64(EncodePng(picture, block.pixels.Width(), block.pixels.Height())));
    return fmt::format("<script type=\"application/json\" id=\"pictures-{}\">{}</script>\n", i,
                       JsonForScript(list));
}

// Returns the contents of the page's <script> of that id; empty if it has none.
std::string_view ScriptText(std::string_view page, const std::string& id) {
    const std::string open = fmt::format("<script type=\"application/json\" id=\"{}\">", id);
    const size_t begin = page.find(open);
    if (begin == std::string_view::npos) return {};
    const size_t end = page.find("</script>", begin);
    if (end == std::string_view::npos) return {};
    return page.substr(begin + open.size(), end - begin - open.size());
}

std::string ReadWholeFile(const std::string& path) { return std::string(ReadFile(path).View()); }

}  // namespace

std::string MakeStudyPage(const Study& study, const StudySettings& settings) {
    std::vector<std::string> scripts(study.blocks.size());
    ForEachIndex(int(scripts.size()),
                 [&](int i) { scripts[size_t(i)] = PicturesScript(study, size_t(i)); });
    std::string pictures;
    for (const std::string& script : scripts) pictures += script;
    return FillPage("study.html", {{"study", JsonForScript(DescribeStudy(study, settings))},
                                   {"pictures", std::move(pictures)}});
}

Json ReadStudyPage(const std::string& path) try {
    const std::string page = ReadWholeFile(path);
    Json study = Json::parse(ScriptText(page, "study"));
    if (study.at("format") != kFormat || study.at("version") != kVersion)
        throw Error(path + ": is the page of another program or version");
    // JSON has numbers that no int can hold.
    const auto checkPixels = [&](const Json& pixels) {
        if (!pixels.is_number_integer() || pixels < 0 || pixels > kMostPixels)
            throw NotAStudy(path);
    };
    for (const char* key : {"width", "height"}) checkPixels(study.at(key));
    study.at("id").get<std::string>();
    study["references"] = Json::array();
    for (size_t i = 0; i < study.at("blocks").size(); ++i) {
        for (const char* key : {"x", "y", "width", "height"})
            checkPixels(study.at("blocks").at(i).at(key));
        const Json pictures = Json::parse(ScriptText(page, fmt::format("pictures-{}", i)));
        study["references"].push_back("data:image/png;base64," +
                                      pictures.at(pictures.size() - 1).get<std::string>());
    }
    return study;
} catch (const Json::exception&) {
    throw NotAStudy(path);
}

namespace {

Json Number(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json ConsensusJson(const BlockConsensus& b) {
    return {{"mean", b.mean},
            {"lowest", b.lowest},
            {"highest", b.highest},
            {"deviation", Number(b.deviation)},
            {"octaves", Number(b.octaves)},
            {"answers", b.answers}};
}

Json ViewpointJson(const CollectedViewpoint& viewpoint, const Json& study) {
    Json json = {{"name", viewpoint.name},
                 {"observers", viewpoint.observers},
                 {"fewestAnswers", FewestAnswers(viewpoint)},
                 {"enoughAnswers", kEnoughAnswers},
                 {"levels", viewpoint.levels},
                 {"blocks", Json::array()}};
    for (const BlockConsensus& block : viewpoint.blocks)
        json["blocks"].push_back(ConsensusJson(block));
    if (study.is_null() || study.at("id") != viewpoint.study ||
        study.at("references").size() != viewpoint.blocks.size())
        return json;
    json["width"] = study.at("width");
    json["height"] = study.at("height");
    json["references"] = study.at("references");
    json["places"] = Json::array();
    for (const Json& block : study.at("blocks"))
        json["places"].push_back({{"x", block.at("x")},
                                  {"y", block.at("y")},
                                  {"width", block.at("width")},
                                  {"height", block.at("height")}});
    return json;
}

Json ObserverJson(const CheckedObserver& o) {
    return {{"file", o.answers.file},
            {"observer", o.answers.observer},
            {"viewpoint", o.answers.viewpoint},
            {"leftOut", o.leftOut},
            {"doubts", o.doubts},
            {"checks", o.checks},
            {"failed", o.failed},
            {"repeats", o.repeats},
            {"repeatOctaves", Number(o.repeatOctaves)},
            {"shiftOctaves", Number(o.shiftOctaves)},
            {"seconds", o.answers.seconds},
            {"gamma", Number(o.answers.gamma)},
            {"distanceCm", Number(o.answers.distanceCm)}};
}

}  // namespace

std::string MakeCollectedPage(const Collected& collected, const Json& study) {
    Json json = {
        {"viewpoints", Json::array()}, {"observers", Json::array()}, {"refused", Json::array()}};
    for (const CollectedViewpoint& viewpoint : collected.viewpoints)
        json["viewpoints"].push_back(ViewpointJson(viewpoint, study));
    for (const CheckedObserver& observer : collected.observers)
        json["observers"].push_back(ObserverJson(observer));
    for (const RefusedAnswers& refused : collected.refused)
        json["refused"].push_back({{"file", refused.file}, {"reason", refused.reason}});
    return FillPage("collected.html", {{"data", JsonForScript(json)}});
}

}  // namespace lull
