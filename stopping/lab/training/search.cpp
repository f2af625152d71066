#include "stopping/lab/training/search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "stopping/base/checksum.h"
#include "stopping/base/csv.h"
#include "stopping/base/state.h"
#include "stopping/features/model_inputs.h"

namespace lull {

namespace {

constexpr uint32_t searchTag = 0x31484353;  // "SCH1"

// Lists the numbers of a result in the order of the tables.
struct Figure {
    const char* column;
    const char* title;
    double SearchResult::*value;
    double scale;  // to what tables for people show
    int digits;
};
constexpr std::array<Figure, 7> figures = {
    {{"auc_left_out", "AUC left out", &SearchResult::testAuc, 100, 1},
     {"accuracy_left_out", "accuracy left out", &SearchResult::testAccuracy, 100, 1},
     {"auc_training", "AUC training", &SearchResult::trainingAuc, 100, 1},
     {"accuracy_training", "accuracy training", &SearchResult::trainingAccuracy, 100, 1},
     {"critical_error_2", "critical error at 2 %", &SearchResult::criticalError, 100, 1},
     {"early", "early", &SearchResult::early, 100, 0},
     {"late", "late", &SearchResult::late, 100, 0}}};

std::string Text(double value, int digits) {
    if (!std::isfinite(value)) return "";
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

// Returns how many windows a recording gives.
double WindowCount(const JudgedBlock& block, const ModelSettings& settings) {
    const int end = block.recording->Count() > 0 ? block.recording->spp.back() : 0;
    const int steps = end < block.passSpp ? 0 : (end - block.passSpp) / settings.n + 1;
    return std::max(0, steps - settings.k + 1);
}

double WindowCount(std::span<const JudgedBlock> blocks, const ModelSettings& settings) {
    double count = 0;
    for (const JudgedBlock& block : blocks) count += WindowCount(block, settings);
    return count;
}

// Returns how many weights a window is multiplied with.
double ProductCount(const ModelSettings& settings, const TrainingOptions& training) {
    double inputs = InputCount(settings), products = 0;
    for (const int units : training.units) {
        products += settings.k * 4.0 * units * (inputs + units);
        inputs = units;
    }
    for (const int units : training.dense) {
        products += units * inputs;
        inputs = units;
    }
    // What else there is to do: as much as for so many products.
    return products + inputs + 2000.0 * settings.k;
}

}  // namespace

std::vector<SearchAxis> ReadGrid(std::istream& in, const std::string& fileName) {
    std::vector<SearchAxis> axes;
    size_t count = 1;
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        const auto fail = [&](const std::string& message) {
            throw std::runtime_error(fileName + ":" + std::to_string(number) + ": " + message);
        };
        std::istringstream words(line.substr(0, line.find('#')));
        SearchAxis axis{.option = "", .values = {}, .line = number};
        if (!(words >> axis.option)) continue;
        if (std::ranges::find(axes, axis.option, &SearchAxis::option) != axes.end())
            fail("'" + axis.option + "' comes twice");
        for (std::string value; words >> value; axis.values.push_back(value))
            if (std::ranges::find(axis.values, value) != axis.values.end())
                fail("the value '" + value + "' comes twice");
        if (axis.values.empty()) fail("'" + axis.option + "' has no values");
        count *= axis.values.size();
        if (count > kMostCombinations)
            fail("these are more than " + std::to_string(kMostCombinations) + " combinations");
        axes.push_back(std::move(axis));
    }
    if (axes.empty())
        throw std::runtime_error(fileName +
                                 ":1: there is no option to vary; a line is, for "
                                 "example, 'k 4 8 16'");
    return axes;
}

std::vector<SearchAxis> ReadGrid(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error(path + ": cannot be read");
    return ReadGrid(file, path);
}

size_t CombinationCount(std::span<const SearchAxis> axes) {
    size_t count = 1;
    for (const SearchAxis& axis : axes) count *= axis.values.size();
    return count;
}

std::vector<std::string> CombinationAt(std::span<const SearchAxis> axes, size_t index) {
    std::vector<std::string> values(axes.size());
    for (size_t i = axes.size(); i-- > 0;) {
        values[i] = axes[i].values[index % axes[i].values.size()];
        index /= axes[i].values.size();
    }
    return values;
}

void RankResults(std::vector<SearchResult>* results) {
    const auto key = [](const SearchResult& r) {
        return std::isfinite(r.testAuc) ? r.testAuc : -1;
    };
    std::ranges::stable_sort(*results, std::greater<>(), key);
}

std::string SearchCsv(std::span<const SearchAxis> axes, std::span<const SearchResult> results) {
    std::string csv;
    for (const SearchAxis& axis : axes) csv += axis.option + ",";
    for (const Figure& figure : figures) csv += std::string(figure.column) + ",";
    csv += "seconds\n";
    for (const SearchResult& result : results) {
        for (const std::string& value : result.values) csv += CsvField(value) + ",";
        for (const Figure& figure : figures) csv += Text(result.*figure.value, 6) + ",";
        csv += Text(result.seconds, 2) + "\n";
    }
    return csv;
}

std::string SearchMarkdown(std::span<const SearchAxis> axes,
                           std::span<const SearchResult> results) {
    std::string table = "|";
    const auto add = [&](const std::string& cell) { table.append(" ").append(cell).append(" |"); };
    for (const SearchAxis& axis : axes) add(axis.option);
    for (const Figure& figure : figures) add(figure.title);
    table.append("\n|");
    for (size_t i = 0; i < axes.size() + figures.size(); ++i) table.append("---|");
    for (const SearchResult& result : results) {
        table.append("\n|");
        for (const std::string& value : result.values) add(value);
        for (const Figure& figure : figures) {
            const double value = result.*figure.value * figure.scale;
            add(std::isfinite(value) ? Text(value, figure.digits) : "-");
        }
    }
    return table.append("\n");
}

std::vector<std::byte> SaveResults(const std::string& data, std::span<const SearchResult> results) {
    StateWriter writer;
    const auto put = [&](const std::string& text) {
        writer.Put(uint64_t(text.size()));
        writer.PutAll(std::span<const char>(text));
    };
    writer.Put(searchTag);
    put(data);
    writer.Put(uint64_t(results.size()));
    for (const SearchResult& result : results) {
        writer.Put(uint64_t(result.values.size()));
        for (const std::string& value : result.values) put(value);
        for (const Figure& figure : figures) writer.Put(result.*figure.value);
        writer.Put(result.seconds);
    }
    Seal(&writer.bytes);
    return std::move(writer.bytes);
}

std::vector<SearchResult> RestoreResults(std::span<const std::byte> bytes,
                                         const std::string& data) {
    StateReader reader(CheckSeal(bytes));
    // Every element takes at least a byte of what is left.
    const auto getCount = [&] {
        const uint64_t count = reader.Get<uint64_t>();
        if (count > reader.Left()) throw std::runtime_error("the saved search is damaged");
        return size_t(count);
    };
    const auto getText = [&] {
        std::string text(getCount(), ' ');
        reader.GetAll(std::span<char>(text));
        return text;
    };
    if (reader.Get<uint32_t>() != searchTag) throw std::runtime_error("this is no saved search");
    if (getText() != data)
        throw std::runtime_error("the saved search had other recordings, thresholds or options");
    std::vector<SearchResult> results(getCount());
    for (SearchResult& result : results) {
        result.values.resize(getCount());
        for (std::string& value : result.values) value = getText();
        for (const Figure& figure : figures) result.*figure.value = reader.Get<double>();
        result.seconds = reader.Get<double>();
    }
    reader.Finish();
    return results;
}

std::vector<SearchResult> ReadResults(const std::string& path, const std::string& data) try {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error("there is no checkpoint to resume from");
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    return RestoreResults(std::as_bytes(std::span(text)), data);
} catch (const std::runtime_error& error) {
    throw std::runtime_error(path + ": " + error.what());
}

double SearchCost(const ModelSettings& settings, const TrainingOptions& training,
                  std::span<const BlockSplit> splits) {
    double windows = 0;
    for (const BlockSplit& split : splits) {
        const double trained = WindowCount(split.training, settings);
        const double judged = trained + WindowCount(split.test, settings);
        windows += 3 * training.epochs * trained + judged;  // forwards, and backwards twice
    }
    return windows * ProductCount(settings, training);
}

double SecondsLeft(std::span<const double> costs, std::span<const double> seconds) {
    const auto sum = [](std::span<const double> v) {
        return std::accumulate(v.begin(), v.end(), 0.0);
    };
    const double done = sum(costs.first(std::min(costs.size(), seconds.size())));
    return done > 0 ? std::max(0.0, sum(costs) - done) / done * sum(seconds) : 0;
}

}  // namespace lull
