// Finds the values of independent programs that tests compare with.
#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace lull {

// Returns the path of a file of tests/stopping/golden or stopping/data.
inline std::string GoldenFile(const std::string& name) {
    return LULL_TESTS_DIR "/stopping/golden/" + name;
}
inline std::string ThresholdsFile(const std::string& name) {
    return LULL_TESTS_DIR "/../stopping/data/" + name;
}

inline nlohmann::json ReadJson(const std::string& path) {
    std::ifstream file(path);
    return nlohmann::json::parse(file);
}

}  // namespace lull
