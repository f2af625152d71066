#include "renderer/lab/pages/comparison_page.h"

#include <fmt/format.h>

#include "renderer/base/error.h"
#include "renderer/files/file_io.h"
#include "renderer/image/image_io.h"
#include "renderer/pages/html_page.h"
#include "stopping/base/parallel.h"

namespace lull {

namespace {

// JSON has no infinity and no NaN: both become null.
Json Number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

// Infinite and unknown figures are null.
Json FiguresJson(const ErrorFigures& f) {
    return {{"rmse", Number(f.rmse)},
            {"relMse", Number(f.relMse)},
            {"rmseLightness", Number(f.rmseLightness)},
            {"psnr", Number(f.psnr)},
            {"ssim", Number(f.ssim)},
            {"flip", Number(f.flip)},
            {"visibleDifference", Number(f.visibleDifference)}};
}

Json CostJson(const TotalCost& cost) {
    return {{"samples", cost.samples},
            {"seconds", cost.seconds},
            {"ruleSeconds", cost.ruleSeconds},
            {"estimated", cost.isEstimated}};
}

Json ViewingJson(const DisplayModel& display) {
    return {{"name", NameOf(display)},
            {"pixelsPerDegree", display.pixelsPerDegree},
            {"threshold", kVisibilityThreshold}};
}

// Returns the share of `whole` that `part` saves, null where there is nothing to save from.
Json Saved(double part, double whole) { return whole > 0 ? Json(1 - part / whole) : Json(nullptr); }

Json ImageJson(const Comparison& comparison, const ComparedImage& image) {
    Json json = {{"name", image.name},
                 {"label", image.rule.empty() ? image.name : image.name + " (" + image.rule + ")"},
                 {"rule", image.rule}};
    if (image.isDisplay) json["display"] = true;
    if (image.wallSeconds) json["wallSeconds"] = *image.wallSeconds;
    if (image.figures) {
        json["figures"] = FiguresJson(*image.figures);
        json["visibleBlocks"] = CountVisibleBlocks(image);
        if (!image.eyes.empty())
            json["eyes"] = {{"left", FiguresJson(image.eyes[0])},
                            {"right", FiguresJson(image.eyes[1])}};
    }
    if (image.seams)
        json["seams"] = {{"border", image.seams->border},
                         {"inside", image.seams->inside},
                         {"ratio", Number(image.seams->Ratio())}};
    if (!image.costs.empty()) {
        const TotalCost cost = SumCosts(comparison, image);
        json["cost"] = CostJson(cost);
        if (comparison.cap > 0) {
            const TotalCost atCap = CostAtCap(comparison);
            json["saved"] = {{"samples", Saved(double(cost.samples), double(atCap.samples))},
                             {"seconds", Saved(cost.seconds + cost.ruleSeconds, atCap.seconds)},
                             {"estimated", cost.isEstimated || atCap.isEstimated}};
        }
    }
    json["blocks"] = Json::array();
    for (size_t i = 0; i < comparison.blocks.size(); ++i) {
        Json block =
            i < image.blockFigures.size() ? FiguresJson(image.blockFigures[i]) : Json::object();
        if (i < image.costs.size()) {
            const BlockCost& cost = image.costs[i];
            block["spp"] = cost.spp;
            block["seconds"] = cost.seconds;
            block["ruleSeconds"] = cost.ruleSeconds;
            block["estimated"] = cost.isEstimated;
        }
        json["blocks"].push_back(std::move(block));
    }
    return json;
}

Json AgainstHuman(const Comparison& comparison) {
    const ComparedImage *automatic = comparison.Find("automatic"),
                        *human = comparison.Find("human");
    if (!automatic || !human || automatic->costs.empty() || human->costs.empty()) return nullptr;
    int earlier = 0, later = 0;
    double distance = 0;
    Json differences = Json::array();
    for (size_t i = 0; i < automatic->costs.size(); ++i) {
        const int difference = automatic->costs[i].spp - human->costs[i].spp;
        earlier += difference < 0;
        later += difference > 0;
        distance += std::abs(difference);
        differences.push_back(difference);
    }
    const TotalCost a = SumCosts(comparison, *automatic), h = SumCosts(comparison, *human);
    return {{"earlier", earlier},
            {"later", later},
            {"meanDistance", distance / double(std::max<size_t>(1, automatic->costs.size()))},
            {"spp", differences},
            {"savedSamples", Saved(double(a.samples), double(h.samples))},
            {"savedSeconds", Saved(a.seconds + a.ruleSeconds, h.seconds)}};
}

Json VerificationJson(const ComparisonReport& report, const Verification& v) {
    Json json = {
        {"threads", v.threads},       {"wallSeconds", v.wallSeconds},
        {"seconds", v.seconds},       {"ruleSeconds", v.ruleSeconds},
        {"samePixels", v.samePixels}, {"ruleShare", v.ruleSeconds / (v.seconds + v.ruleSeconds)}};
    const TotalCost taken = SumCosts(report.comparison, report.comparison.images.front());
    const TotalCost atCap = CostAtCap(report.comparison);
    // Scale the seconds of this very run, as others may have had another share of the machine.
    const double capSeconds = v.seconds * atCap.seconds / taken.seconds;
    const double savedSamples = 1 - double(taken.samples) / double(atCap.samples);
    const double savedWall = 1 - v.wallSeconds / (capSeconds / v.threads);
    json["wallSecondsToCap"] = capSeconds / v.threads;
    json["savedWall"] = savedWall;
    json["kept"] = savedSamples > 0 ? Json(savedWall / savedSamples) : Json(nullptr);
    return json;
}

Json ErrorCurvesJson(const ComparisonReport& report) {
    Json points = Json::array();
    for (const CurvePoint& point : report.curvePoints) {
        Json json = FiguresJson(point.figures);
        json["rule"] = point.rule;
        json["setting"] = point.setting;
        json["spp"] = point.spp;
        json["seconds"] = point.seconds;
        json["ruleSeconds"] = point.ruleSeconds;
        points.push_back(std::move(json));
    }
    return {{"sharesReference", report.curvesShareReference}, {"points", std::move(points)}};
}

// Maps visible differences to [0, 1), the threshold to 1/2.
std::vector<float> OnScale(std::vector<float> differences) {
    for (float& v : differences) v = v / (v + float(kVisibilityThreshold));
    return differences;
}

}  // namespace

TotalCost CostAtCap(const Comparison& comparison) {
    TotalCost total;
    for (size_t i = 0; i < comparison.blocks.size(); ++i) {
        // Take the block's seconds from the image that has most of them.
        const BlockCost* most = nullptr;
        for (const ComparedImage& image : comparison.images)
            if (i < image.costs.size() && image.costs[i].seconds > 0 &&
                (!most || image.costs[i].spp > most->spp))
                most = &image.costs[i];
        total.samples += comparison.blocks[i].Area() * comparison.cap;
        if (!most) continue;
        total.seconds += most->seconds / most->spp * comparison.cap;
        total.isEstimated |= most->spp != comparison.cap || most->isEstimated;
    }
    return total;
}

Json ComparisonJson(const ComparisonReport& report) {
    const Comparison& comparison = report.comparison;
    Json json = {{"kind", "compare"},
                 {"title", report.title},
                 {"cap", comparison.cap},
                 {"width", comparison.region.Width()},
                 {"height", comparison.region.Height()}};
    if (comparison.eyeWidth > 0) json["eyeWidth"] = comparison.eyeWidth;
    if (comparison.hasReference) json["viewing"] = ViewingJson(comparison.display);
    json["reference"] = comparison.hasReference ? Json(comparison.images.back().name) : Json();
    if (report.provenance) json["provenance"] = ProvenanceJson(*report.provenance);
    if (comparison.cap > 0) json["atCap"] = CostJson(CostAtCap(comparison));
    json["againstHuman"] = AgainstHuman(comparison);
    if (report.estimates)
        json["estimates"] = {{"blocks", report.estimates->blocks},
                             {"total", report.estimates->total},
                             {"worst", report.estimates->worst}};
    if (!report.curvePoints.empty()) json["errorCurves"] = ErrorCurvesJson(report);
    json["verifications"] = Json::array();
    for (const Verification& verification : report.verifications)
        json["verifications"].push_back(VerificationJson(report, verification));
    json["images"] = Json::array();
    for (const ComparedImage& image : comparison.images)
        json["images"].push_back(ImageJson(comparison, image));
    json["blocks"] = Json::array();
    for (size_t i = 0; i < comparison.blocks.size(); ++i) {
        Json block = RectJson(comparison.Local(i));
        if (i < report.decisions.size() && !report.decisions[i].decisions.empty())
            block["decisions"] = DecisionsJson(report.decisions[i].decisions);
        if (i < report.histories.size()) block["curves"] = CurvesJson(report.histories[i].curves);
        json["blocks"].push_back(std::move(block));
    }
    json["warnings"] = report.warnings;
    json["notes"] = report.notes;
    return json;
}

std::string MakeComparisonPage(const ComparisonReport& report) {
    Json page = ComparisonJson(report);
    for (size_t i = 0; i < report.comparison.images.size(); ++i) {
        const ComparedImage& image = report.comparison.images[i];
        page["images"][i]["src"] = PictureUri(image.image);
        if (!image.flip.empty())
            page["images"][i]["flipSrc"] =
                MapUri(image.flip, image.image.width, image.image.height);
        if (!image.visibleDifference.empty())
            page["images"][i]["visibleDifferenceSrc"] =
                MapUri(OnScale(image.visibleDifference), image.image.width, image.image.height);
    }
    NotePictureScale(report.comparison.region.Width(), report.comparison.region.Height(), &page);
    return FillPage("page.html", {{"data", JsonForScript(page)},
                                  {"report.css", std::string(EmbeddedFile("comparison.css"))},
                                  {"report.js", std::string(EmbeddedFile("comparison.js"))}});
}

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

std::string PicturesScript(const Study& study, size_t i) {
    const StudyBlock& block = study.blocks[i];
    Json list = Json::array();
    for (const DisplayPixels& picture : block.pictures)
        list.push_back(Base64(EncodePng(picture, block.pixels.Width(), block.pixels.Height())));
    return fmt::format("<script type=\"application/json\" id=\"pictures-{}\">{}</script>\n", i,
                       JsonForScript(list));
}

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
