#include "renderer/commands/input_files.h"

#include <filesystem>

namespace lull {

std::vector<NamedFile> InputsOf(const SceneOptions& options, const Description& description) {
    std::vector<NamedFile> inputs = {{"the scene", options.file},
                                     {"--environment", options.environment}};
    for (const std::string& file : FilesOf(description))
        inputs.push_back({"a file of the scene", file});
    return inputs;
}

void AddFileOfRule(const std::string& rule, std::vector<NamedFile>* inputs) {
    const size_t colon = rule.find(':');
    if (colon == std::string::npos) return;
    const std::string rest = rule.substr(colon + 1);
    // A name may follow the file's, whose own may have colons.
    for (const std::string& file : {rest, rest.substr(0, rest.rfind(':'))}) {
        std::error_code error;
        if (std::filesystem::is_regular_file(file, error))
            return inputs->push_back({"the file of the rule,", file});
    }
}

}  // namespace lull
