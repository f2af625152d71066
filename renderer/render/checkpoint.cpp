#include "renderer/render/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include "renderer/files/file_io.h"
#include "renderer/render/executor_internal.h"
#include "stopping/base/hdf5_file.h"
#include "stopping/base/input_file.h"
#include "stopping/base/state.h"

namespace lull {

namespace {

constexpr std::string_view kFormat = "lull checkpoint 6";
constexpr std::array<std::string_view, 5> kOlderFormats = {"lull checkpoint 1", "lull checkpoint 2",
                                                           "lull checkpoint 3", "lull checkpoint 4",
                                                           "lull checkpoint 5"};

std::string GroupName(size_t block) { return fmt::format("block_{:05}", block); }

template <typename Visit>
void ForEachValue(BlockResult& result, const Visit& visit) {
    Block& block = result.block;
    for (Vec2i* corner : {&block.pixels.min, &block.pixels.max}) {
        visit(corner->x());
        visit(corner->y());
    }
    visit(block.spp);
    visit(block.stopped);
    visit(block.stoppedByVote);
    visit(result.seconds);
    visit(result.criterionSeconds);
}

template <typename Visit>
void ForEachValue(BlockDecision& record, const Visit& visit) {
    visit(record.spp);
    visit(record.decision.stop);
    visit(record.decision.value);
    visit(record.decision.threshold);
    visit(record.decision.votes);
    double noise = record.networkNoise.value_or(-1);  // negative: none
    visit(noise);
    if (noise >= 0) record.networkNoise = noise;
}

std::vector<std::byte> PackBooks(BlockResult result) {
    StateWriter writer;
    const auto put = [&](const auto& value) { writer.Put(value); };
    ForEachValue(result, put);
    writer.Put(uint32_t(result.decisions.size()));
    for (BlockDecision& record : result.decisions) ForEachValue(record, put);
    return std::move(writer.bytes);
}

BlockResult UnpackBooks(std::span<const std::byte> bytes) {
    StateReader reader(bytes);
    const auto get = [&]<typename T>(T& value) { value = reader.Get<T>(); };
    BlockResult result;
    ForEachValue(result, get);
    for (uint32_t left = reader.Get<uint32_t>(); left > 0; --left) {
        BlockDecision& record = result.decisions.emplace_back();
        record.decision.checked = true;
        ForEachValue(record, get);
    }
    reader.Finish();
    return result;
}

void AddBytes(Hdf5Group& group, const std::string& name, std::span<const std::byte> bytes) {
    group.AddArray<std::byte>(name, std::array{int64_t(bytes.size())}, bytes);
}

std::vector<std::byte> BytesOf(const Hdf5Group& group, const std::string& name) {
    return group.Array<std::byte>(name, group.Shape(name));
}

void WritePlanes(Hdf5Group group, const PixelRect& rect, const Film& film) {
    Film::ForEachPlane(film, rect, [&](const char* name, const auto& plane, const PixelRect& part) {
        StateWriter writer;
        plane.Put(part, &writer);
        AddBytes(group, name, writer.bytes);
    });
}

void ReadPlanes(const Hdf5Group& group, const PixelRect& rect, Film* film) {
    const PixelRect& all = film->Region();
    if ((rect.min.array() < all.min.array()).any() || (rect.max.array() > all.max.array()).any() ||
        (rect.min.array() >= rect.max.array()).any())
        throw Error("it has pixels outside the image");
    Film::ForEachPlane(*film, rect, [&](const char* name, auto& plane, const PixelRect& part) {
        const auto bytes = group.Array<std::byte>(name, std::array{plane.Bytes(part)});
        StateReader reader(bytes);
        plane.Get(part, &reader);
    });
    if (MostSamples(rect, *film) < 0) throw Error("it has impossible counts of samples");
}

BdptShares SharesIn(const Hdf5Group& root) {
    const std::vector<float> shares = root.Array<float>("shares", std::array<int64_t, 1>{2});
    if (!(shares[0] >= 0 && shares[0] <= 1 && shares[1] > 0 && shares[1] <= 1))
        throw Error("its shares of light paths are damaged");
    return {.lightPaths = shares[0], .connections = shares[1]};
}

void CheckFormat(const Hdf5Group& root) {
    const std::string format = root.HasAttribute("format") ? root.String("format") : "";
    if (std::ranges::find(kOlderFormats, format) != kOlderFormats.end())
        throw Error(
            "it was written by an older lull; go on with that one, or remove the file to start "
            "again");
    if (format != kFormat) throw Error("it is not a checkpoint of this version of lull");
}

std::vector<std::string> Lines(const RenderIdentity& identity) {
    std::vector<std::string> lines;
    for (const auto& [key, value] : identity) lines.push_back(key + "=" + value);
    return lines;
}

RenderIdentity ParseIdentity(const std::vector<std::string>& lines) {
    RenderIdentity identity;
    for (const std::string& line : lines) {
        const size_t equals = std::min(line.find('='), line.size());
        identity[line.substr(0, equals)] = line.substr(std::min(equals + 1, line.size()));
    }
    return identity;
}

std::string ValueIn(const RenderIdentity& identity, const std::string& key) {
    const auto at = identity.find(key);
    if (at != identity.end()) return at->second;
    return key == "integrator" ? "path" : "none";
}

int CapIn(const RenderIdentity& identity) {
    return identity.contains("cap") ? std::atoi(identity.at("cap").c_str()) : 0;
}

void CheckIdentity(const RenderIdentity& found, const RenderIdentity& wanted, MayDiffer what) {
    constexpr std::array kStops = {"stop", "model", "cap"};
    RenderIdentity all = wanted;
    all.insert(found.begin(), found.end());
    for (const auto& [key, value] : all)
        if (what == MayDiffer::Stops && std::ranges::find(kStops, key) != kStops.end())
            continue;
        else if (found.contains(key) != wanted.contains(key) || ValueIn(found, key) != value)
            throw Error(
                "it belongs to a render with another {} ({} there, {} here); go on with the same, "
                "or remove the file to start again",
                key, ValueIn(found, key), ValueIn(wanted, key));
}

void CheckPlanes(const RenderIdentity& found, const Film& film) {
    for (const auto& [name, identity] : PlanesOf(film)) {
        const auto at = found.find(name);
        if (at == found.end())
            throw Error(
                "it was written without the {}, needed here; go on with the AOVs, light groups and "
                "denoiser that it was begun with, or remove the file to start again",
                name);
        if (at->second != identity)
            throw Error(
                "its {} is {}, and here {}; go on with the same, or remove the file to start again",
                name, at->second, identity);
    }
}

// Lets blocks go on that stopped by another rule, or at a smaller cap.
void GoOnTo(const RenderIdentity& wanted, const RenderIdentity& found, RenderState* state) {
    const int cap = CapIn(wanted);
    const bool isNewRule = ValueIn(wanted, "stop") != ValueIn(found, "stop") ||
                           ValueIn(wanted, "model") != ValueIn(found, "model");
    for (BlockResult& result : state->blocks) {
        Block& block = result.block;
        if (block.spp > cap)
            throw Error(
                "it has blocks of {} spp, more than the cap of {}; give a larger --max-spp, or "
                "remove the file to start again",
                block.spp, cap);
        if (isNewRule) {
            result.decisions.clear();
            block.stopped = block.stoppedByVote = false;
        } else if (!block.stoppedByVote && block.spp < cap) {
            block.stopped = false;
        }
    }
    if (isNewRule) state->criteria.clear();
}

}  // namespace

void WriteCheckpoint(const std::string& path, const RenderIdentity& identity,
                     const RenderState& state, const Film& film) try {
    Hdf5Group root = Hdf5Group::CreateInMemory();
    root.SetString("format", std::string(kFormat));
    root.SetStrings("identity", Lines(identity));
    root.SetStrings("planes", Lines(PlanesOf(film)));
    root.AddArray<double>("seconds", std::array<int64_t, 1>{1}, std::array{state.seconds});
    if (state.shares)
        root.AddArray<float>("shares", std::array<int64_t, 1>{2},
                             std::array{state.shares->lightPaths, state.shares->connections});
    for (size_t i = 0; i < state.blocks.size(); ++i) {
        Hdf5Group group = root.MakeGroup(GroupName(i));
        AddBytes(group, "books", PackBooks(state.blocks[i]));
        AddBytes(group, "criterion", state.criteria[i]);
        const PixelRect& rect = state.blocks[i].block.pixels;
        if (MostSamples(rect, film) > 0) WritePlanes(group.MakeGroup("pixels"), rect, film);
    }
    const std::span<const std::byte> content = root.Content();
    const std::string seal = SealOf(content);
    AtomicFile file(path);
    file.WriteAt(0, content);
    file.WriteAt(int64_t(content.size()), std::as_bytes(std::span(seal)));
    file.Commit();
} catch (const Error&) {
    throw;
} catch (const std::runtime_error& e) {
    throw Error(path + ": " + e.what());
}

RenderState ReadCheckpoint(const std::string& path, const RenderIdentity& identity, Film* film,
                           MayDiffer mayDiffer) try {
    CheckSeal(path);
    const Hdf5Group root = Hdf5Group::Open(path);
    CheckFormat(root);
    const RenderIdentity found = ParseIdentity(root.Strings("identity"));
    CheckIdentity(found, identity, mayDiffer);
    CheckPlanes(ParseIdentity(root.Strings("planes")), *film);
    RenderState state;
    state.seconds = root.Array<double>("seconds", std::array<int64_t, 1>{1})[0];
    if (root.Has("shares")) state.shares = SharesIn(root);
    for (size_t i = 0; root.Has(GroupName(i)); ++i) {
        const Hdf5Group group = root.Group(GroupName(i));
        state.blocks.push_back(UnpackBooks(BytesOf(group, "books")));
        state.criteria.push_back(BytesOf(group, "criterion"));
        if (group.Has("pixels"))
            ReadPlanes(group.Group("pixels"), state.blocks.back().block.pixels, film);
    }
    if (mayDiffer == MayDiffer::Stops) GoOnTo(identity, found, &state);
    return state;
} catch (const std::runtime_error& e) {
    throw Error(path + ": " + e.what());
}

}  // namespace lull
