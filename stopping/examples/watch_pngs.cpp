// Watches the pictures of any renderer: `watch_pngs SPP a.png b.png ...`, each with SPP samples per
// pixel more than the one before. Says of each whether blocks of it still need samples.
#include <lull/stopping.h>
#include <png.h>

#include <cstdio>
#include <cstdlib>
#include <vector>

static int Fail(const char* file, const char* message) {
    std::fprintf(stderr, "watch_pngs: %s: %s\n", file, message);
    return 1;
}

int main(int argc, char** argv) {
    const int step = argc > 2 ? std::atoi(argv[1]) : 0;
    if (step < 1) return Fail("usage", "watch_pngs SPP a.png b.png ...");
    lull_stopper* stopper = nullptr;
    for (int i = 2; i < argc; ++i) {
        png_image png = {};
        png.version = PNG_IMAGE_VERSION;
        if (!png_image_begin_read_from_file(&png, argv[i])) return Fail(argv[i], png.message);
        png.format = PNG_FORMAT_RGB;
        std::vector<unsigned char> pixels(PNG_IMAGE_SIZE(png));
        if (!png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr))
            return Fail(argv[i], png.message);

        lull_settings settings = {};  // all that is 0 has its default: the model "entropy"
        settings.width = int(png.width), settings.height = int(png.height);
        if (!stopper && lull_stopper_create(&settings, &stopper) != LULL_OK)
            return Fail(argv[i], lull_error_message());
        lull_picture picture = {};
        picture.width = int(png.width), picture.height = int(png.height);
        picture.format = LULL_SRGB8, picture.mean = pixels.data();
        std::vector<lull_answer> answers(size_t(lull_stopper_block_count(stopper)));
        if (lull_stopper_observe(stopper, &picture, step * (i - 1), answers.data()) != LULL_OK)
            return Fail(argv[i], lull_error_message());

        int going = 0;
        for (const lull_answer& answer : answers) going += !answer.stop;
        std::printf("%s: %d spp, %d of %zu blocks go on\n", argv[i], step * (i - 1), going,
                    answers.size());
        if (going == 0) break;
    }
    lull_stopper_destroy(stopper);
}
