#include "renderer/render/provenance.h"

#include <fmt/format.h>

#include <filesystem>

namespace lull {

std::string SceneName(const std::string& file) {
    using std::filesystem::path;
    const path absolute = std::filesystem::absolute(file).lexically_normal();
    std::string name = absolute.stem().string();
    if (name == "scene" && absolute.has_parent_path() && absolute.parent_path().has_filename())
        name = absolute.parent_path().filename().string();
    for (char& c : name)
        if (c == ';' || c == '\n' || c == '\r') c = '_';
    return name.empty() ? "scene" : name;
}

std::vector<NamedProvenance> PartsOf(const Provenance& p) {
    const bool hasModel = !p.checksum.empty();
    std::vector<NamedProvenance> parts = {
        {nullptr, "renderer", "renderer", "lull"},
        // "version" is OpenEXR's own: a number.
        {"version", "rendererVersion", "version", p.version},
        {nullptr, nullptr, "scene", p.scene},
        {"seed", "seed", "seed", p.seed},
        {"sampler", "sampler", "sampler", NameOf(p.sampler)},
        {"estimator", "estimator", "estimator", NameOf(p.estimator)},
        {"stop", "criterion", "criterion", p.criterion},
        {"model", nullptr, nullptr, hasModel ? p.checksum : "none"},
        {nullptr, hasModel ? "modelChecksum" : nullptr, "modelChecksum", p.checksum},
        {"cap", nullptr, "cap", p.schedule.cap},
        {"pass", nullptr, "pass", p.schedule.passLength},
        {"block", nullptr, "blockSize", p.schedule.blockSize},
        {"maxdepth", nullptr, "maxDepth", p.maxDepth},
        {nullptr, nullptr, "threads", p.threads},
        {"substitute", nullptr, "substitute", p.substitute},
        {"resolution", nullptr, "resolution", p.resolution},
        {"crop", nullptr, "crop", p.crop}};
    if (!p.integrator.empty())
        parts.push_back({"integrator", "integrator", "integrator", p.integrator});
    if (!p.grades.empty()) parts.push_back({"grades", "judgedGrades", "judgedGrades", p.grades});
    if (!p.clock.empty()) parts.push_back({nullptr, "clock", "clock", p.clock});
    return parts;
}

std::string TextOf(const NamedProvenance& part) {
    struct Texts {
        std::string operator()(bool value) const { return value ? "yes" : "no"; }
        std::string operator()(int value) const { return std::to_string(value); }
        std::string operator()(uint64_t value) const { return std::to_string(value); }
        std::string operator()(const std::string& value) const { return value; }
        std::string operator()(const Vec2i& v) const { return fmt::format("{}x{}", v.x(), v.y()); }
        std::string operator()(const PixelRect& r) const {
            return fmt::format("{},{},{},{}", r.min.x(), r.max.x(), r.min.y(), r.max.y());
        }
    };
    return std::visit(Texts(), part.value);
}

RenderIdentity IdentityOf(const Provenance& provenance, const std::string& sceneHash) {
    RenderIdentity identity = {{"scene", sceneHash}};
    for (const NamedProvenance& part : PartsOf(provenance))
        if (part.identity) identity[part.identity] = TextOf(part);
    return identity;
}

std::string TextOf(const RenderIdentity& identity) {
    std::string text;
    for (const auto& [name, value] : identity) text += name + "=" + value + "\n";
    return text;
}

}  // namespace lull
