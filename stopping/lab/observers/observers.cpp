#include "stopping/lab/observers/observers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <stdexcept>

#include "stopping/base/input_file.h"

namespace lull {

namespace {

constexpr double kQuickSeconds = 0.4;  // an answer that takes less is doubtful
constexpr double kLooseOctaves = 1;    // and a deviation of one that is more
// Displays and viewing conditions beyond which thresholds may be others.
constexpr double kLeastGamma = 1.8, kMostGamma = 2.6, kMostZoomError = 0.06;
constexpr double kLeastPixelsPerDegree = 20, kMostPixelsPerDegree = 90;

template <typename ReasonOf>
void RefuseSome(std::vector<ObserverAnswers>* answers, std::vector<RefusedAnswers>* refused,
                const ReasonOf& reasonOf) {
    std::vector<ObserverAnswers> kept;
    for (ObserverAnswers& one : *answers) {
        const std::string reason = reasonOf(one);
        if (reason.empty())
            kept.push_back(std::move(one));
        else
            refused->push_back({one.file, reason});
    }
    *answers = std::move(kept);
}

// Chooses for each viewpoint the study that most files answer, the first of them in a tie.
std::map<std::string, std::string> ChooseStudies(const std::vector<ObserverAnswers>& answers) {
    std::map<std::string, std::map<std::string, int>> counts;
    for (const ObserverAnswers& one : answers) ++counts[one.viewpoint][one.study];
    std::map<std::string, std::string> chosen;
    for (const ObserverAnswers& one : answers) {
        std::string& best = chosen.emplace(one.viewpoint, one.study).first->second;
        if (counts[one.viewpoint][one.study] > counts[one.viewpoint][best]) best = one.study;
    }
    return chosen;
}

// Studies are told apart by a hash; a file whose head was changed by hand has the hash still.
void RefuseContradictions(std::vector<ObserverAnswers>* answers,
                          std::vector<RefusedAnswers>* refused) {
    std::map<std::string, const ObserverAnswers*> first;
    std::set<std::string> contradicting;
    for (const ObserverAnswers& one : *answers) {
        const ObserverAnswers* other = first.emplace(one.study, &one).first->second;
        if (other->levels != one.levels || other->thresholds.size() != one.thresholds.size() ||
            other->viewpoint != one.viewpoint)
            contradicting.insert(one.file);
    }
    RefuseSome(answers, refused, [&](const ObserverAnswers& one) -> std::string {
        return contradicting.contains(one.file)
                   ? "describes its study in another way than the files before"
                   : "";
    });
}

void RefuseOtherStudies(std::vector<ObserverAnswers>* answers, std::vector<RefusedAnswers>* refused,
                        const CollectOptions& options) {
    RefuseSome(answers, refused, [&](const ObserverAnswers& one) -> std::string {
        return options.study.empty() || one.study == options.study ? "" : "answers another study";
    });
    const std::map<std::string, std::string> chosen = ChooseStudies(*answers);
    RefuseSome(answers, refused, [&](const ObserverAnswers& one) -> std::string {
        return one.study == chosen.at(one.viewpoint)
                   ? ""
                   : "answers another study of '" + one.viewpoint +
                         "', with other pictures, than most files do";
    });
    RefuseContradictions(answers, refused);
}

void RefuseDoubles(std::vector<ObserverAnswers>* answers, std::vector<RefusedAnswers>* refused) {
    std::map<std::string, const ObserverAnswers*> sessions;
    std::map<std::string, std::string> contradicting;  // session to the other file
    for (const ObserverAnswers& one : *answers) {
        const ObserverAnswers* other = sessions.emplace(one.session, &one).first->second;
        if (!(*other == one)) contradicting.emplace(one.session, one.file);
    }
    RefuseSome(answers, refused, [&](const ObserverAnswers& one) -> std::string {
        return contradicting.contains(one.session)
                   ? "the same session has other answers in another file; which ones are right?"
                   : "";
    });
    std::map<std::string, std::string> seen;  // session to file
    RefuseSome(answers, refused, [&](const ObserverAnswers& one) -> std::string {
        const auto [first, isNew] = seen.emplace(one.session, one.file);
        return isNew ? "" : "is a copy of " + first->second;
    });
    // Nobody looks at a picture for the first time twice.
    using Person = std::pair<std::string, std::string>;
    std::map<Person, std::pair<std::string, std::string>> earliest;  // to (started, session)
    for (const ObserverAnswers& one : *answers) {
        const std::pair<std::string, std::string> when(one.started, one.session);
        const auto [at, isNew] = earliest.emplace(Person(one.viewpoint, one.observer), when);
        if (!isNew) at->second = std::min(at->second, when);
    }
    RefuseSome(answers, refused, [&](const ObserverAnswers& one) -> std::string {
        return earliest[Person(one.viewpoint, one.observer)].second == one.session
                   ? ""
                   : "'" + one.observer + "' has judged '" + one.viewpoint +
                         "' before; the first time counts";
    });
}

template <typename Add>
void AddDisplayDoubts(const ObserverAnswers& answers, const Add& add) {
    if (answers.tones == "not all") add("could not tell all tones of the display apart");
    if (answers.gamma && !(*answers.gamma >= kLeastGamma && *answers.gamma <= kMostGamma))
        add(fmt::format("had a display of gamma {:.2f}", *answers.gamma));
    if (answers.zoom && std::abs(*answers.zoom - 1) > kMostZoomError)
        add(fmt::format("saw the page at a zoom of {:.0f} %", 100 * *answers.zoom));
    if (const auto pixels = answers.pixelsPerDegree;
        pixels && !(*pixels >= kLeastPixelsPerDegree && *pixels <= kMostPixelsPerDegree))
        add(fmt::format("saw {:.0f} pixels a degree", *pixels));
}

std::string DoubtsOf(const CheckedObserver& judged, double secondsEach) {
    std::string doubts;
    const auto add = [&](const std::string& doubt) {
        doubts += (doubts.empty() ? "" : "; ") + doubt;
    };
    if (judged.failed > 0) add(fmt::format("failed {} of {} checks", judged.failed, judged.checks));
    if (secondsEach < kQuickSeconds) add(fmt::format("took only {:.2g} s an answer", secondsEach));
    // Two answers differ by the root of 2 more than one from the mean.
    if (judged.repeatOctaves && *judged.repeatOctaves > kLooseOctaves)
        add(fmt::format("asked twice, gave answers that differ by a factor of {:.1f}",
                        std::exp2(std::numbers::sqrt2 * *judged.repeatOctaves)));
    AddDisplayDoubts(judged.answers, add);
    return doubts;
}

CheckedObserver CheckObserver(ObserverAnswers answers, const CollectOptions& options) {
    CheckedObserver judged;
    double squares = 0;
    for (const BlockAnswer& answer : answers.answers) {
        if (answer.kind == AnswerKind::Catch) {
            ++judged.checks;
            judged.failed += answer.failed;
        } else if (answer.kind != AnswerKind::Asked) {
            const auto first = std::ranges::find_if(answers.answers, [&](const BlockAnswer& other) {
                return other.kind == AnswerKind::Asked && other.block == answer.block;
            });
            const double octaves = std::log2(answer.spp / first->spp);
            squares += octaves * octaves / 2;
            ++judged.repeats;
        }
    }
    if (judged.repeats > 0) judged.repeatOctaves = std::sqrt(squares / judged.repeats);
    if (judged.failed > options.mostFailed * judged.checks)
        judged.leftOut = "failed " + std::to_string(judged.failed) + " of " +
                         std::to_string(judged.checks) + " checks";
    else if (answers.isIdle)
        judged.leftOut = "pointed at nothing";
    const double secondsEach = answers.seconds / std::max(1, answers.given);
    if (judged.leftOut.empty() && secondsEach < options.leastSeconds)
        judged.leftOut =
            fmt::format("took {:.2g} s per answer, too short to compare images", secondsEach);
    judged.answers = std::move(answers);
    if (judged.leftOut.empty()) judged.doubts = DoubtsOf(judged, secondsEach);
    return judged;
}

std::optional<double> SampleDeviation(const std::vector<double>& values) {
    if (values.size() < 2) return {};
    double mean = 0, sum = 0;
    for (const double v : values) mean += v / double(values.size());
    for (const double v : values) sum += (v - mean) * (v - mean);
    return std::sqrt(sum / double(values.size() - 1));
}

BlockConsensus MakeConsensus(const std::vector<double>& spp) {
    BlockConsensus block;
    std::vector<double> logs;
    for (const double v : spp) {
        block.mean += v / double(spp.size());
        logs.push_back(std::log2(v));
    }
    block.lowest = *std::ranges::min_element(spp);
    block.highest = *std::ranges::max_element(spp);
    block.deviation = SampleDeviation(spp);
    block.octaves = SampleDeviation(logs);
    return block;
}

CollectedViewpoint MakeCollected(const std::vector<CheckedObserver*>& observers) {
    const ObserverAnswers& first = observers.front()->answers;
    CollectedViewpoint viewpoint{.name = first.viewpoint,
                                 .study = first.study,
                                 .levels = first.levels,
                                 .observers = int(observers.size()),
                                 .blocks = {}};
    std::vector<std::vector<double>> logs(first.thresholds.size());
    for (size_t i = 0; i < logs.size(); ++i) {
        std::vector<double> spp;
        for (const CheckedObserver* o : observers) {
            spp.push_back(o->answers.thresholds[i]);
            logs[i].push_back(std::log2(spp.back()));
        }
        viewpoint.blocks.push_back(MakeConsensus(spp));
    }
    for (const CheckedObserver* o : observers)
        for (const BlockAnswer& answer : o->answers.answers)
            if (answer.kind != AnswerKind::Catch) ++viewpoint.blocks[size_t(answer.block)].answers;
    for (size_t k = 0; k < observers.size(); ++k) {
        double shift = 0;
        for (const std::vector<double>& block : logs) {
            double mean = 0;
            for (const double v : block) mean += v / double(block.size());
            shift += (block[k] - mean) / double(logs.size());
        }
        observers[k]->shiftOctaves = shift;
    }
    return viewpoint;
}

}  // namespace

Collected CollectObservers(std::vector<ObserverAnswers> answers, const CollectOptions& options) {
    Collected collected;
    RefuseOtherStudies(&answers, &collected.refused, options);
    RefuseDoubles(&answers, &collected.refused);
    std::ranges::stable_sort(answers, {}, [](const ObserverAnswers& one) {
        return std::pair(one.viewpoint, one.observer);
    });
    for (ObserverAnswers& one : answers)
        collected.observers.push_back(CheckObserver(std::move(one), options));
    std::map<std::string, std::vector<CheckedObserver*>> counting;
    for (CheckedObserver& one : collected.observers)
        if (one.leftOut.empty()) counting[one.answers.viewpoint].push_back(&one);
    for (const auto& [name, observers] : counting)
        collected.viewpoints.push_back(MakeCollected(observers));
    return collected;
}

int FewestAnswers(const CollectedViewpoint& viewpoint) {
    int fewest = std::numeric_limits<int>::max();
    for (const BlockConsensus& block : viewpoint.blocks) fewest = std::min(fewest, block.answers);
    return fewest;
}

Collected CollectFiles(const std::vector<std::string>& files, const CollectOptions& options) {
    std::vector<ObserverAnswers> answers;
    std::vector<RefusedAnswers> unreadable;
    for (const std::string& file : files) try {
            answers.push_back(ReadAnswers(file));
        } catch (const std::runtime_error& e) {
            unreadable.push_back({file, e.what()});
        }
    Collected collected = CollectObservers(std::move(answers), options);
    collected.refused.insert(collected.refused.begin(), unreadable.begin(), unreadable.end());
    return collected;
}

std::vector<ThresholdsRow> ThresholdsOf(const Collected& collected) {
    std::vector<ThresholdsRow> rows;
    for (const CollectedViewpoint& viewpoint : collected.viewpoints) {
        ThresholdsRow& row = rows.emplace_back(ThresholdsRow{viewpoint.name, {}});
        for (const BlockConsensus& block : viewpoint.blocks)
            row.spp.push_back(int(std::lround(block.mean)));
    }
    return rows;
}

namespace {

std::string Field(const std::optional<double>& value) {
    return value ? fmt::format("{:.4g}", *value) : "";
}
std::string Field(const std::optional<int>& value) { return value ? std::to_string(*value) : ""; }

std::string ViewingFields(const ObserverAnswers& a) {
    const std::string window = a.windowWidth && a.windowHeight
                                   ? fmt::format("{}x{}", *a.windowWidth, *a.windowHeight)
                                   : "";
    return fmt::format("{},{},{},{},{},{},{}", Field(a.gamma), a.tones, Field(a.distanceCm),
                       Field(a.pixelsPerDegree), Field(a.zoom), Field(a.shown), window);
}

}  // namespace

std::string DetailsCsv(const Collected& collected) {
    std::string csv = "viewpoint,block,observers,mean,lowest,highest,deviation,octaves,answers\n";
    for (const CollectedViewpoint& v : collected.viewpoints)
        for (size_t i = 0; i < v.blocks.size(); ++i) {
            const BlockConsensus& b = v.blocks[i];
            csv += fmt::format("{},{},{},{:.6g},{:.6g},{:.6g},{},{},{}\n", CsvField(v.name), i,
                               v.observers, b.mean, b.lowest, b.highest, Field(b.deviation),
                               Field(b.octaves), b.answers);
        }
    return csv;
}

std::string ObserversCsv(const Collected& collected) {
    std::string csv =
        "file,viewpoint,observer,counts,reason,checks,failed,repeats,repeat_octaves,shift_octaves,"
        "seconds,gamma,tones,distance_cm,pixels_per_degree,zoom,display_pixels,window,doubts\n";
    for (const CheckedObserver& o : collected.observers)
        csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{:.0f},{},{}\n", CsvField(o.answers.file),
                           CsvField(o.answers.viewpoint), CsvField(o.answers.observer),
                           o.leftOut.empty() ? "yes" : "no", CsvField(o.leftOut), o.checks,
                           o.failed, o.repeats, Field(o.repeatOctaves), Field(o.shiftOctaves),
                           o.answers.seconds, ViewingFields(o.answers), CsvField(o.doubts));
    for (const RefusedAnswers& r : collected.refused)
        csv += fmt::format("{},,,no,{}{}\n", CsvField(r.file), CsvField(r.reason),
                           std::string(14, ','));
    return csv;
}

std::string SingleAnswersCsv(const Collected& collected, const std::string& viewpoint) {
    std::string rows;
    int track = 0;
    for (const CheckedObserver& o : collected.observers) {
        if (!o.leftOut.empty() || o.answers.viewpoint != viewpoint) continue;
        for (const BlockAnswer& answer : o.answers.answers) {
            track += !answer.single.empty();
            for (const NoiseAnswer& single : answer.single)
                rows += fmt::format("{},{},{},{},{}\n", answer.block, single.spp,
                                    single.seen ? 1 : 0, CsvField(o.answers.observer), track);
        }
    }
    return rows.empty() ? "" : "block,spp,noise_seen,observer,track\n" + rows;
}

}  // namespace lull
