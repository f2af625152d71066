#include "renderer/lab/commands/picture_options.h"
#include "renderer/commands/option_values.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>

namespace lull {

void AddImagesOptions(CLI::App& app, std::vector<std::string>* folders, int* blockSize) {
    CLI::Option* images =
        app.add_option(
               "--images", *folders,
               "Pictures of another renderer, their spp in the file names, to run rules on;\n"
               "NAME names the viewpoint [the folder's name]; can be given again")
            ->expected(1)
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
            ->type_name("DIR[:NAME]");
    AddBlockOption(app, blockSize)->needs(images);
}

CLI::Option* AddBlockOption(CLI::App& app, int* blockSize) {
    return app.add_option("--block", *blockSize, "Pixels a side of the blocks")
        ->check(Between(1, 1 << 16))
        ->type_name("N")
        ->capture_default_str();
}

std::vector<NamedFile> InputsOf(const PictureFolder& folder) {
    std::vector<NamedFile> files;
    for (const auto& [spp, file] : folder.files) files.push_back({"a picture", file});
    return files;
}

ViewpointRecording RecordAndTell(const PictureFolder& folder, PictureRecordingOptions options,
                                 const Talk& talk) {
    using Clock = std::chrono::steady_clock;
    auto told = Clock::now();
    options.onPicture = [&](int read, int count) {
        if (Clock::now() - told < std::chrono::seconds(10)) return;
        told = Clock::now();
        talk.Note(fmt::format("{}: {} of {} pictures", folder.name, read, count));
    };
    ViewpointRecording viewpoint = RecordPictures(folder, options);
    talk.Note(fmt::format("{}: {} pictures of {} to {} spp, {} of {} blocks", folder.name,
                          folder.files.size(), folder.files.begin()->first,
                          folder.files.rbegin()->first, viewpoint.blocks.size(),
                          viewpoint.blockCount));
    return viewpoint;
}

}  // namespace lull
