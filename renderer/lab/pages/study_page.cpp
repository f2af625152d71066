#include "renderer/lab/pages/study_page.h"

#include <fmt/format.h>

#include <sstream>

#include "renderer/base/error.h"
#include "renderer/files/file_contents.h"
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

}  // namespace lull
