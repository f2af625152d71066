// `lull entropy`: SVD-entropies of pictures.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "renderer/commands/command.h"
#include "renderer/files/file_io.h"
#include "renderer/lab/commands/lab_options.h"
#include "renderer/lab/comparison/compared_files.h"
#include "renderer/lab/viewpoints/picture_folder.h"
#include "stopping/base/input_file.h"

namespace lull::entropy {

namespace {

struct Options {
    std::vector<std::string> pictures;
    std::string images, csv;
    int blockSize = 200, subBlocks = 100;
    bool values = false, attributes = false;
};

constexpr const char* kFooter =
    R"(Computes the SVD-entropy H of the lightness L (0 to 100) of images as an 8-bit display shows them,
and its parts H1, of the first quarter of the singular values, and H2, of the others, all in [0, 1]
(Buisine et al. 2021, Eqs. 3 to 5): of the image and of each block as one matrix, and the mean over
the sub-blocks of each block, the inputs of networks.

The table has a row for each block of a single image. Of several images, or of a folder with the
samples per pixel in the names (--images), it has a row for each, in this order, with means over
blocks.

--csv writes the curves of all blocks, a row for each image and block:
  viewpoint,picture,spp,block,sub_block,x,y,width,height,h,h1,h2,mean_h,mean_h1,mean_h2
A row without a block is of the whole image. spp is empty if it is not in the name. --values adds a
row for each sub-block; --attributes adds the 26 attributes of each block, a1 to a26: differences to
13 filtered versions, means and then standard deviations.

Examples:
  lull entropy image.png
  lull entropy image.png --block 100 --sub-blocks 25 --csv entropies.csv --values
  lull entropy --images images/kitchen --csv curves.csv

Exit codes: 0 success, 1 input or environment error, 2 usage error.)";

void AddOptions(CLI::App& app, Options* o) {
    app.add_option("IMAGE", o->pictures, "Images: .png, .exr, ...");
    AddOption(app, kOptions, "--images", &o->images,
              "Folder of images, with their spp in the file names", "DIR[:NAME]");
    AddOption(app, kOptions, "--block", &o->blockSize, "Pixels a side of the blocks", "N",
              Between(5, 1 << 16));
    AddOption(app, kOptions, "--sub-blocks", &o->subBlocks, "Parts of each block, a square number",
              "M", Between(1, 10000))
        ->check([](const std::string& text) {
            const int n = std::stoi(text), root = int(std::lround(std::sqrt(n)));
            return root * root == n ? "" : text + " is not a square number, such as 25 or 100";
        });
    app.add_option("--csv", o->csv, "Write the entropies of all blocks")->type_name("F.csv");
    app.add_flag("--values", o->values, "Write the entropies of each sub-block as well");
    app.add_flag("--attributes", o->attributes, "Write the 26 attributes of each block as well");
    app.footer(kFooter);
}

struct Source {
    std::string viewpoint, file;
    int spp = 0;  // 0: not known
};

std::vector<Source> SourcesOf(const Options& options) {
    std::vector<Source> sources;
    for (const std::string& file : options.pictures)
        sources.push_back({"", file, SppInName(std::filesystem::path(file).filename().string())});
    std::ranges::stable_sort(sources, {}, &Source::spp);
    if (options.images.empty()) return sources;
    const PictureFolder folder = FindNamedPictures(options.images);
    for (const auto& [spp, file] : folder.files) sources.push_back({folder.name, file, spp});
    return sources;
}

std::string Numbers(const SvdEntropy& e) {
    return fmt::format("  {:8.6f}  {:8.6f}  {:8.6f}", e.h, e.h1, e.h2);
}

void PrintBlocks(const EntropiesOfPicture& picture, int subBlocks) {
    fmt::print("{:>5}  {:>5}  {:>5}  {:>9}  {:>8}  {:>8}  {:>8}  {:>8}  {:>8}  {:>8}\n", "block",
               "x", "y", "size", "H", "H1", "H2", "mean H", "mean H1", "mean H2");
    for (size_t i = 0; i < picture.blocks.size(); ++i) {
        const BlockEntropies& block = picture.blocks[i];
        fmt::print("{:>5}  {:>5}  {:>5}  {:>9}{}{}\n", i, block.pixels.min.x(),
                   block.pixels.min.y(),
                   fmt::format("{}x{}", block.pixels.Width(), block.pixels.Height()),
                   Numbers(block.whole), Numbers(block.mean));
    }
    fmt::print("{:>5}{:>25}{}\n", "all", "", Numbers(picture.whole));
    fmt::print("mean: over {} sub-blocks\n", subBlocks);
}

void PrintPicture(const Source& source, const EntropiesOfPicture& picture, size_t width) {
    fmt::print("{:<{}}  {:>6}{}{}\n", source.file, width,
               source.spp > 0 ? std::to_string(source.spp) : "-", Numbers(picture.whole),
               Numbers(picture.mean));
}

std::string CsvNumbers(const SvdEntropy& e) {
    return fmt::format(",{:.9g},{:.9g},{:.9g}", e.h, e.h1, e.h2);
}

std::string PlaceFields(const PixelRect& rect) {
    return fmt::format("{},{},{},{}", rect.min.x(), rect.min.y(), rect.Width(), rect.Height());
}

PixelRect SubBlockRect(const PixelRect& block, int subBlocks, int i) {
    const int side = int(std::lround(std::sqrt(subBlocks)));
    const std::vector<int> x = SplitEvenly(block.Width(), side),
                           y = SplitEvenly(block.Height(), side);
    const size_t column = size_t(i % side), row = size_t(i / side);
    return {block.min + Vec2i(x[column], y[row]), block.min + Vec2i(x[column + 1], y[row + 1])};
}

std::string CsvHead(const Options& options) {
    std::string head =
        "viewpoint,picture,spp,block,sub_block,x,y,width,height,h,h1,h2,mean_h,mean_h1,mean_h2";
    if (options.attributes)
        for (int i = 1; i <= kAttributes; ++i) head += fmt::format(",a{}", i);
    return head + "\n";
}

std::string CsvRows(const Source& source, const RgbImage& image, const EntropiesOfPicture& picture,
                    const Options& options) {
    const std::string start =
        fmt::format("{},{},{}", CsvField(source.viewpoint), CsvField(source.file),
                    source.spp > 0 ? std::to_string(source.spp) : "");
    const std::string noAttributes(options.attributes ? size_t(kAttributes) : 0, ',');
    std::string rows =
        fmt::format("{},,,{}{},,,{}\n", start, PlaceFields({{0, 0}, {image.width, image.height}}),
                    CsvNumbers(picture.whole), noAttributes);
    for (size_t b = 0; b < picture.blocks.size(); ++b) {
        const BlockEntropies& block = picture.blocks[b];
        rows += fmt::format("{},{},,{}{}{}", start, b, PlaceFields(block.pixels),
                            CsvNumbers(block.whole), CsvNumbers(block.mean));
        if (options.attributes)
            for (const double a : block.attributes) rows += fmt::format(",{:.9g}", a);
        rows += "\n";
        if (!options.values) continue;
        for (int i = 0; i < options.subBlocks; ++i)
            rows += fmt::format("{},{},{},{}{},,,{}\n", start, b, i,
                                PlaceFields(SubBlockRect(block.pixels, options.subBlocks, i)),
                                CsvNumbers(block.subBlocks[size_t(i)]), noAttributes);
    }
    return rows;
}

ExitCode RunEntropy(const Options& options) {
    const std::vector<Source> sources = SourcesOf(options);
    std::vector<NamedFile> inputs;
    size_t width = std::string("picture").size();
    for (const Source& source : sources) {
        inputs.push_back({"a picture", source.file});
        width = std::max(width, source.file.size());
    }
    CheckOutputs(std::vector<NamedFile>{{"--csv", options.csv}}, inputs);
    std::string csv = CsvHead(options);
    if (sources.size() > 1)
        fmt::print("{:<{}}  {:>6}  {:>8}  {:>8}  {:>8}  {:>8}  {:>8}  {:>8}\n", "picture", width,
                   "spp", "H", "H1", "H2", "mean H", "mean H1", "mean H2");
    for (const Source& source : sources) {
        const RgbImage image = ReadShownPicture(source.file);
        EntropiesOfPicture picture;
        try {
            picture =
                MeasureEntropies(image, options.blockSize, options.subBlocks, options.attributes);
        } catch (const Error& error) {
            throw Error("{}: {}", source.file, error.what());
        }
        if (sources.size() > 1)
            PrintPicture(source, picture, width);
        else
            PrintBlocks(picture, options.subBlocks);
        if (!options.csv.empty()) csv += CsvRows(source, image, picture, options);
    }
    if (!options.csv.empty()) WriteFileAtomically(options.csv, csv);
    return kDone;
}

}  // namespace

void AddCommand(CLI::App& app, Command* command) {
    CLI::App* entropy = app.add_subcommand("entropy", "Computes SVD-entropies of images.");
    auto options = std::make_shared<Options>();
    AddOptions(*entropy, options.get());
    entropy->callback([=] {
        if (options->pictures.empty() && options->images.empty())
            throw CLI::ValidationError("entropy", "an IMAGE is needed, or --images");
        if (options->csv.empty() && (options->values || options->attributes))
            throw CLI::ValidationError("--values and --attributes", "need --csv");
        *command = [=] { return RunEntropy(*options); };
    });
}

}  // namespace lull::entropy
