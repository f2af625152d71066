#include "renderer/lab/pages/collected_page.h"

#include "renderer/pages/html_page.h"

namespace lull {

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
