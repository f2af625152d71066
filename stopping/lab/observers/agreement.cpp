#include "stopping/lab/observers/agreement.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace lull {

namespace {

// Returns the probability of being between -t and t: the finite series 26.7.3 and 26.7.4.
double WithinStudent(double t, int degrees) {
    const double theta = std::atan(t / std::sqrt(double(degrees)));
    const double sine = std::sin(theta), cosine2 = std::cos(theta) * std::cos(theta);
    const bool isOdd = degrees % 2 == 1;
    double term = isOdd ? std::cos(theta) : 1, sum = degrees > 1 ? term : 0;
    for (int k = isOdd ? 3 : 2; k < degrees; k += 2) {
        term *= cosine2 * (k - 1) / k;
        sum += term;
    }
    return isOdd ? 2 / std::numbers::pi * (theta + sine * sum) : sine * sum;
}

double Mean(std::span<const double> values) {
    double sum = 0;
    for (const double v : values) sum += v;
    return values.empty() ? 0 : sum / double(values.size());
}

}  // namespace

double StudentInterval(double share, int degrees) {
    if (!(share > 0 && share < 1) || degrees < 1)
        throw std::invalid_argument("no interval of Student's distribution");
    double low = 0, high = 1;
    while (WithinStudent(high, degrees) < share && high < 1e12) high *= 2;
    for (int i = 0; i < 100; ++i) {
        const double middle = (low + high) / 2;
        (WithinStudent(middle, degrees) < share ? low : high) = middle;
    }
    return (low + high) / 2;
}

std::optional<double> IntraclassCorrelation(std::span<const std::vector<double>> ratings) {
    const size_t n = ratings.size(), k = n > 0 ? ratings.front().size() : 0;
    if (n < 2 || k < 2) return {};
    std::vector<double> rows(n), columns(k, 0);
    for (size_t i = 0; i < n; ++i) {
        if (ratings[i].size() != k) throw std::invalid_argument("ratings are missing");
        rows[i] = Mean(ratings[i]);
        for (size_t j = 0; j < k; ++j) columns[j] += ratings[i][j] / double(n);
    }
    const double mean = Mean(rows);
    double betweenRows = 0, betweenColumns = 0, rest = 0;
    for (const double row : rows) betweenRows += double(k) * (row - mean) * (row - mean);
    for (const double c : columns) betweenColumns += double(n) * (c - mean) * (c - mean);
    for (size_t i = 0; i < n; ++i)
        for (size_t j = 0; j < k; ++j) {
            const double error = ratings[i][j] - rows[i] - columns[j] + mean;
            rest += error * error;
        }
    const double msr = betweenRows / double(n - 1), msc = betweenColumns / double(k - 1);
    const double mse = rest / double((n - 1) * (k - 1));
    const double whole = msr + double(k - 1) * mse + double(k) * (msc - mse) / double(n);
    if (!(whole > 1e-12)) return {};
    return (msr - mse) / whole;
}

const char* AgreementInAWord(double correlation) {
    return correlation < 0.5    ? "poor"
           : correlation < 0.75 ? "moderate"
           : correlation < 0.9  ? "good"
                                : "excellent";
}

std::optional<double> SampleDeviation(std::span<const double> values) {
    if (values.size() < 2) return {};
    const double mean = Mean(values);
    double sum = 0;
    for (const double v : values) sum += (v - mean) * (v - mean);
    return std::sqrt(sum / double(values.size() - 1));
}

}  // namespace lull
