#include "renderer/lab/pages/bench_page.h"

#include "renderer/lab/pages/comparison_page.h"

namespace lull {

std::string MakeBenchPage(const std::string& title, const Provenance& provenance,
                          const std::vector<BenchPoint>& points,
                          const std::vector<std::string>& samplers, const RgbImage& reference,
                          const DisplayModel& display, const std::vector<std::string>& notes) {
    Json page = {{"kind", "bench"},
                 {"title", title},
                 {"cap", provenance.schedule.cap},
                 {"width", reference.width},
                 {"height", reference.height},
                 {"provenance", ProvenanceJson(provenance)},
                 {"viewing", ViewingJson(display)},
                 {"blocks", Json::array()},
                 {"notes", notes}};
    page["provenance"].erase("criterion");
    page["provenance"].erase("modelChecksum");
    page["provenance"]["sampler"] = samplers;
    page["images"].push_back({{"name", "reference"},
                              {"label", "reference"},
                              {"src", PictureUri(reference)},
                              {"blocks", Json::array()}});
    NotePictureScale(reference.width, reference.height, &page);
    Json list = Json::array();
    for (const BenchPoint& point : points) {
        Json json = FiguresJson(point.figures);
        json["rule"] = point.rule;
        json["setting"] = point.setting;
        json["sampler"] = point.sampler;
        if (point.spp > 0) json["spp"] = point.spp;
        json["seconds"] = point.seconds;
        json["sharesReference"] = point.sharesReference;
        list.push_back(std::move(json));
    }
    page["bench"] = {{"samplers", samplers}, {"points", std::move(list)}};
    return FillPage("comparison.html", {{"data", JsonForScript(page)}});
}

}  // namespace lull
