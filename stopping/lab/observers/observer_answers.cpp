#include "stopping/lab/observers/observer_answers.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "stopping/base/input_file.h"

namespace lull {

namespace {

using Json = nlohmann::json;

constexpr const char* kAnswersFormat = "lull-judge-answers";
constexpr int kVersion = 1;
// Bounds on the contents of a damaged file.
constexpr size_t kMostBytes = size_t(1) << 26;
constexpr int kMostBlocks = 1 << 16, kMostLevels = 1000, kMostSpp = 1 << 24;
constexpr size_t kLongestText = 200;

[[noreturn]] void Refuse(const std::string& what) { throw std::runtime_error(what); }

const Json& Get(const Json& object, const char* key) {
    if (!object.is_object() || !object.contains(key))
        Refuse(std::string("'") + key + "' is missing");
    return object.at(key);
}

int GetInt(const Json& object, const char* key, int low, int high) {
    const Json& value = Get(object, key);
    if (!value.is_number_integer() || value < low || value > high)
        Refuse(std::string("'") + key + "' is " + value.dump() + ", not a whole number from " +
               std::to_string(low) + " to " + std::to_string(high));
    return value.get<int>();
}

double ToNumber(const Json& value, const char* key, double low, double high) {
    if (!value.is_number() || !(value.get<double>() >= low && value.get<double>() <= high))
        Refuse(std::string("'") + key + "' is " + value.dump() + ", which cannot be");
    return value.get<double>();
}

std::optional<double> GetOptional(const Json& object, const char* key) {
    if (!object.contains(key) || !object.at(key).is_number()) return {};
    return object.at(key).get<double>();
}

std::string GetWord(const Json& object, const char* key, std::initializer_list<const char*> words) {
    if (!object.contains(key) || !object.at(key).is_string()) return "";
    const std::string word = object.at(key).get<std::string>();
    return std::ranges::find(words, word) == words.end() ? "" : word;
}

std::optional<int> GetOptionalInt(const Json& value) {
    if (!value.is_number() || !(std::abs(value.get<double>()) <= kMostSpp)) return {};
    return int(value.get<double>());
}

void ReadDisplay(const Json& display, ObserverAnswers* result) {
    result->gamma = GetOptional(display, "gamma");
    result->distanceCm = GetOptional(display, "distanceCm");
    result->pixelsPerDegree = GetOptional(display, "pixelsPerDegree");
    result->zoom = GetOptional(display, "zoom");
    if (display.contains("shown")) result->shown = GetOptionalInt(display.at("shown"));
    result->tones = GetWord(display, "tones", {"all", "not all"});
    if (!display.contains("window") || !display.at("window").is_array() ||
        display.at("window").size() != 2)
        return;
    result->windowWidth = GetOptionalInt(display.at("window").at(0));
    result->windowHeight = GetOptionalInt(display.at("window").at(1));
}

std::string GetText(const Json& object, const char* key) {
    const Json& value = Get(object, key);
    if (!value.is_string()) Refuse(std::string("'") + key + "' is not a text");
    const std::string text = value.get<std::string>();
    const auto isControl = [](char c) { return uint8_t(c) < 0x20 || c == 0x7f; };
    if (text.empty() || text.size() > kLongestText || std::ranges::any_of(text, isControl))
        Refuse(std::string("'") + key + "' is empty, too long or not a name");
    return text;
}

const Json& GetArray(const Json& object, const char* key, size_t most) {
    const Json& value = Get(object, key);
    if (!value.is_array() || value.size() > most)
        Refuse(std::string("'") + key + "' is not a list, or too long");
    return value;
}

std::vector<int> ReadLevels(const Json& study) {
    std::vector<int> levels;
    for (const Json& level : GetArray(study, "levels", kMostLevels))
        levels.push_back(int(ToNumber(level, "levels", 1, kMostSpp)));
    if (levels.size() < 2 ||
        std::ranges::adjacent_find(levels, std::greater_equal<int>()) != levels.end())
        Refuse("'levels' do not increase");
    return levels;
}

AnswerKind ReadKind(const Json& answer) {
    const std::string kind = GetText(answer, "kind");
    if (kind == "asked") return AnswerKind::Asked;
    if (kind == "repeat") return AnswerKind::Repeat;
    if (kind == "catch") return AnswerKind::Catch;
    Refuse("an answer of the unknown kind '" + Printable(kind) + "'");
}

BlockAnswer ReadAnswer(const Json& json, const ObserverAnswers& head, int blocks) {
    BlockAnswer answer{.kind = ReadKind(json), .block = GetInt(json, "block", 0, blocks - 1)};
    if (answer.kind == AnswerKind::Catch) {
        const Json& failed = Get(json, "failed");
        if (!failed.is_boolean()) Refuse("'failed' is neither true nor false");
        answer.failed = failed.get<bool>();
    } else {
        const int top = int(head.levels.size()) - 1, level = GetInt(json, "level", 0, top);
        answer.spp = head.levels[size_t(level)];
        const int start = json.contains("start") ? GetInt(json, "start", 0, top) : level;
        for (int i = start; i < level; ++i)
            answer.single.push_back({.spp = head.levels[size_t(i)], .seen = true});
        // Whether there is noise in the reference nobody was asked.
        if (level < top) answer.single.push_back({.spp = head.levels[size_t(level)]});
    }
    return answer;
}

void CheckThresholds(const ObserverAnswers& answers) {
    std::vector<double> sums(answers.thresholds.size(), 0), counts(sums), asked(sums);
    for (const BlockAnswer& answer : answers.answers) {
        if (answer.kind == AnswerKind::Catch) continue;
        sums[size_t(answer.block)] += answer.spp;
        ++counts[size_t(answer.block)];
        asked[size_t(answer.block)] += answer.kind == AnswerKind::Asked;
    }
    for (size_t i = 0; i < sums.size(); ++i) {
        if (asked[i] != 1)
            Refuse("block " + std::to_string(i) +
                   (asked[i] == 0 ? " has no answer" : " is answered more than once"));
        if (std::abs(sums[i] / counts[i] - answers.thresholds[i]) > 1e-6 * answers.thresholds[i])
            Refuse("contradicts itself: the threshold of block " + std::to_string(i) +
                   " is not the mean of its answers");
    }
}

void ReadStudy(const Json& study, ObserverAnswers* result) {
    result->study = GetText(study, "id");
    result->viewpoint = GetText(study, "viewpoint");
    if (result->viewpoint.find_first_of(";/") != std::string::npos)
        Refuse("the viewpoint '" + Printable(result->viewpoint) + "' has a ; or / in its name");
    if (const std::string procedure = GetText(study, "procedure"); procedure != "adjust")
        Refuse("unknown procedure '" + Printable(procedure) + "'; adjust is known");
    result->levels = ReadLevels(study);
}

ObserverAnswers Read(const Json& json) {
    if (!json.is_object() || !json.contains("format") || json.at("format") != kAnswersFormat)
        Refuse("is not a file of answers saved by the page of lull study");
    if (GetInt(json, "version", 0, 1 << 20) != kVersion)
        Refuse("was saved by another version of the page");
    ObserverAnswers result;
    result.observer = GetText(json, "observer");
    result.session = GetText(json, "session");
    result.started = GetText(json, "started");
    if (!Get(json, "finished").is_string()) Refuse("the observer had not finished");
    result.seconds = ToNumber(Get(json, "seconds"), "seconds", 0, 1e9);

    const Json& study = Get(json, "study");
    ReadStudy(study, &result);
    const int blocks = GetInt(study, "blocks", 1, kMostBlocks);

    int64_t clicks = 0;
    for (const Json& entry : GetArray(json, "answers", 16 * size_t(kMostBlocks))) {
        result.answers.push_back(ReadAnswer(entry, result, blocks));
        clicks += GetInt(entry, "clicks", 0, 1 << 20);
    }
    result.isIdle = clicks == 0;
    result.given = int(std::min<int64_t>(clicks, kMostSpp));
    for (const Json& threshold : GetArray(json, "thresholds", kMostBlocks))
        result.thresholds.push_back(
            ToNumber(threshold, "thresholds", result.levels.front(), result.levels.back()));
    if (result.thresholds.size() != size_t(blocks))
        Refuse("has " + std::to_string(result.thresholds.size()) + " thresholds for " +
               std::to_string(blocks) + " blocks");
    CheckThresholds(result);
    if (json.contains("display") && json.at("display").is_object()) {
        ReadDisplay(json.at("display"), &result);
    }
    return result;
}

}  // namespace

bool ObserverAnswers::operator==(const ObserverAnswers& other) const {
    const auto isSame = [](const BlockAnswer& a, const BlockAnswer& b) {
        return a.kind == b.kind && a.block == b.block && a.spp == b.spp && a.failed == b.failed;
    };
    return observer == other.observer && session == other.session && study == other.study &&
           viewpoint == other.viewpoint && levels == other.levels &&
           thresholds == other.thresholds && std::ranges::equal(answers, other.answers, isSame);
}

ObserverAnswers ParseAnswers(std::string_view text) try {
    return Read(Json::parse(text));
} catch (const Json::parse_error&) {
    Refuse("is not JSON, or cut short");
} catch (const Json::exception& e) {
    Refuse(e.what());
}

ObserverAnswers ReadAnswers(const std::string& path) {
    if (const std::string reason = ReasonNotToRead(path); !reason.empty())
        Refuse("cannot be read: " + reason);
    std::ifstream file = OpenInput(path);
    const auto size = file.seekg(0, std::ios::end).tellg();
    if (!file || size < 0) Refuse("cannot be read");
    if (size_t(size) > kMostBytes) Refuse("is far too large for a file of answers");
    file.seekg(0);
    std::ostringstream text;
    text << file.rdbuf();
    if (!file) Refuse("cannot be read");
    ObserverAnswers answers = ParseAnswers(text.view());
    answers.file = path;
    return answers;
}

}  // namespace lull
