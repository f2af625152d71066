// Watches the pictures of any renderer: `watch_pngs a_64.png b_90.png ...`, PNG files at any
// samples per pixel, which are the last number in their names, in any order. Says of each whether
// blocks of it still need samples.
#include <lull/lull.h>

#include "pictures.h"

static int Fail(const std::string& file, const std::string& message) {
    std::fprintf(stderr, "watch_pngs: %s: %s\n", file.c_str(), message.c_str());
    return 1;
}

int main(int argc, char** argv) {
    if (argc < 2) return Fail("usage", "watch_pngs a_40.png a_80.png ...");
    std::map<int, std::string> files;
    for (int i = 1; i < argc; ++i)
        if (const std::string problem = Add(argv[i], &files); !problem.empty())
            return Fail(argv[i], problem);
    lull_stopper* stopper = nullptr;
    std::string warned;
    for (const auto& [spp, file] : files) {
        Picture image;
        if (const std::string problem = Read(file, &image); !problem.empty())
            return Fail(file, problem);
        lull_settings settings = {};  // all that is 0 has its default: the model "entropy"
        settings.width = image.width, settings.height = image.height;
        if (!stopper && lull_stopper_create(&settings, &stopper) != LULL_OK)
            return Fail(file, lull_error_message());
        lull_image picture = {};
        picture.width = image.width, picture.height = image.height;
        picture.format = LULL_SRGB8, picture.mean = image.pixels.data();
        std::vector<lull_answer> answers(size_t(lull_stopper_block_count(stopper)));
        if (lull_stopper_observe(stopper, &picture, spp, answers.data()) != LULL_OK)
            return Fail(file, lull_error_message());
        if (warned != lull_stopper_warning(stopper)) {
            warned = lull_stopper_warning(stopper);
            Fail(file, warned);
        }

        int going = 0;
        for (const lull_answer& answer : answers) going += !answer.stop;
        std::printf("%s: %d spp, %d of %zu blocks go on\n", file.c_str(), spp, going,
                    answers.size());
        if (going == 0) break;
    }
    lull_stopper_destroy(stopper);
}
