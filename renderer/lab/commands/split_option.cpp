#include "renderer/lab/commands/split_option.h"

#include <CLI/CLI.hpp>

namespace lull {

void AddSplitOption(CLI::App& app, std::string* file, const std::string& help) {
    const std::string kind = "paper:";
    app.add_option_function<std::string>(
           "--split",
           [=](const std::string& text) {
               if (!text.starts_with(kind) || text.size() == kind.size())
                   throw CLI::ValidationError("--split", text + " is not paper:FILE");
               *file = text.substr(kind.size());
           },
           help)
        ->type_name("paper:FILE");
}

}  // namespace lull
