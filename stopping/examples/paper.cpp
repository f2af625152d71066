// The method of Buisine et al., Entropy 2021, 23(1), 75, on a folder of pictures: `paper FOLDER
// [MODEL.h5]`. FOLDER has PNG files of one scene; the last number in a name is its samples per
// pixel: kitchen_20.png, kitchen_40.png, ... The last line of the output is that of a thresholds
// file: the spp at which each block stopped, row by row.
//
// The library runs the method, and no more. Its inputs (sub-blocks, H, H1 or H2, k, n, snorm)
// are fixed by the model; lull_svd_entropy() returns the entropies. It trains nothing, and
// it does not compare with people: `lull train --preset paper` and `lull evaluate` do, or paper.py
// in this folder. The model "paper" is lull's own small network: the authors' weights are not part
// of lull; a file with weights of Keras can be named instead.
#include <lull/lull.h>

#include "pictures.h"

static int Fail(const std::string& file, const std::string& message) {
    std::fprintf(stderr, "paper: %s: %s\n", file.c_str(), message.c_str());
    return 1;
}

static bool Find(const char* folder, std::map<int, std::string>* files) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".png") continue;
        if (const std::string problem = Add(entry.path().string(), files); !problem.empty())
            return !Fail(entry.path().string(), problem);
    }
    return !files->empty() || !Fail(folder, "has no PNG files");
}

static void Report(int spp, const std::vector<lull_answer>& answers) {
    int stopped = 0, checked = 0;
    double sum = 0;
    for (const lull_answer& a : answers) {
        stopped += a.stop, checked += a.checked;
        sum += a.checked ? a.probability : 0;
    }
    std::printf("%d spp: %d of %zu blocks are clean", spp, stopped, answers.size());
    if (checked > 0) std::printf(", P(noise) %.2f on average", sum / checked);
    std::printf("\n");
}

int main(int argc, char** argv) {
    if (argc < 2 || !std::filesystem::is_directory(argv[1]))
        return Fail("usage", "paper FOLDER [MODEL.h5]");
    std::map<int, std::string> files;
    if (!Find(argv[1], &files)) return 1;

    lull_settings settings = {};  // blocks of 200x200 pixels
    settings.model = argc > 2 ? argv[2] : "paper";
    settings.pass = PassOf(files);
    lull_stopper* stopper = nullptr;
    std::vector<lull_answer> answers;
    for (const auto& [spp, file] : files) {
        Picture image;
        if (const std::string problem = Read(file, &image); !problem.empty())
            return Fail(file, problem);
        settings.width = image.width, settings.height = image.height;
        if (!stopper && lull_stopper_create(&settings, &stopper) != LULL_OK)
            return Fail(file, lull_error_message());
        lull_image picture = {};
        picture.width = image.width, picture.height = image.height;
        picture.format = LULL_SRGB8, picture.mean = image.pixels.data();
        answers.resize(size_t(lull_stopper_block_count(stopper)));
        // Entropies of the sub-blocks (Eq. 3), the window of k of them, its normalisation, the
        // network's probability of noise, and the vote: all of it in one call.
        if (lull_stopper_observe(stopper, &picture, spp, answers.data()) != LULL_OK)
            return Fail(file, lull_error_message());
        Report(spp, answers);
        if (lull_stopper_done(stopper)) break;
    }
    if (const std::string warning = lull_stopper_warning(stopper); !warning.empty())
        Fail(argv[1], warning);
    std::printf("%s;", std::filesystem::absolute(argv[1]).lexically_normal().filename().c_str());
    for (const lull_answer& a : answers) std::printf("%d;", a.stop ? a.spp : 10000);
    std::printf("\n");
    lull_stopper_destroy(stopper);
}
