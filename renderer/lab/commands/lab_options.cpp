#include "renderer/lab/commands/lab_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <string_view>

#include "renderer/base/error.h"
#include "renderer/commands/command.h"

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

CLI::Option* AddList(CLI::App& app, const std::string& name, std::vector<std::string>* list,
                     const std::string& help) {
    return app.add_option(name, *list, help)
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->type_name("NAME");
}

void AddViewingOption(CLI::App& app, DisplayModel* display) {
    app.add_option_function<std::string>(
           "--viewing",
           [display](const std::string& text) {
               try {
                   *display = ParseDisplay(text);
               } catch (const Error& e) {
                   throw CLI::ValidationError("--viewing", e.what());
               }
           },
           "Display for visible differences: peak luminance in cd/m2, pixels per degree\n"
           "and ambient light in lux [" +
               NameOf(DisplayModel()) + "]")
        ->type_name("Lcd,Nppd,Elux");
}

void AllowOnly(const CLI::App& app, std::span<const char* const> names, const std::string& where) {
    for (const CLI::Option* option : app.get_options()) {
        const std::string name = option->get_name();
        const bool isAllowed =
            std::ranges::any_of(names, [&](std::string_view allowed) { return name == allowed; });
        if (option->count() > 0 && !isAllowed)
            throw CLI::ValidationError(name, "has no effect " + where);
    }
}

void AddImagesOptions(CLI::App& app, std::vector<std::string>* folders, int* blockSize) {
    CLI::Option* images =
        AddList(app, "--images", folders,
                "Images of another renderer, their spp in the file names, to run rules on;\n"
                "NAME names the viewpoint [the folder's name]; can be given again")
            ->type_name("DIR[:NAME]");
    AddBlockOption(app, blockSize)->needs(images);
}

CLI::Option* AddBlockOption(CLI::App& app, int* blockSize) {
    return AddOption(app, kOptions, "--block", blockSize, "Pixels a side of the blocks", "N",
                     Between(1, 1 << 16));
}

std::vector<NamedFile> InputsOf(const PictureFolder& folder) {
    std::vector<NamedFile> files;
    for (const auto& [spp, file] : folder.files) files.push_back({"a picture", file});
    return files;
}

ViewpointRecording RecordAndTell(const PictureFolder& folder, PictureRecordingOptions options,
                                 const Messages& messages) {
    using Clock = std::chrono::steady_clock;
    auto told = Clock::now();
    options.onPicture = [&](int read, int count) {
        if (Clock::now() - told < std::chrono::seconds(10)) return;
        told = Clock::now();
        messages.Note(fmt::format("{}: {} of {} pictures", folder.name, read, count));
    };
    ViewpointRecording viewpoint = RecordPictures(folder, options);
    messages.Note(fmt::format("{}: {} pictures of {} to {} spp, {} of {} blocks", folder.name,
                              folder.files.size(), folder.files.begin()->first,
                              folder.files.rbegin()->first, viewpoint.blocks.size(),
                              viewpoint.blockCount));
    return viewpoint;
}

void WriteRecording(const ViewpointRecording& viewpoint, const std::string& path,
                    const Messages& messages, ResultFiles* results) {
    results->Write(path, [&](const std::string& file) {
        AddToDatasetFile(viewpoint, file,
                         [&] { messages.Note("waiting for another process to write " + file); });
    });
}

}  // namespace lull
