/* Lets a renderer ask when its picture has enough samples: lull's stopping module, for C and
 * everything that can call C.
 *
 *     lull_settings settings = {0};              // all that is 0 has its default
 *     settings.width = 1920, settings.height = 1080;
 *     lull_stopper* stopper = NULL;
 *     if (lull_stopper_create(&settings, &stopper) != LULL_OK) puts(lull_error_message());
 *     while (!lull_stopper_done(stopper)) {
 *         spp += render(...);                    // more samples where blocks go on
 *         lull_picture picture = {1920, 1080, LULL_LINEAR_FLOAT, pixels};
 *         lull_stopper_observe(stopper, &picture, spp, NULL);
 *     }
 *     lull_stopper_destroy(stopper);
 *
 * A picture is cut into blocks, each of which stops on its own, so that only blocks that go on need
 * more samples. Blocks may have different numbers of samples.
 *
 * Errors. Functions return LULL_OK or another lull_status; then lull_error_message() says, in the
 * same thread, what is wrong and what would be right, and nothing has changed: no result is
 * written, no block's state changes (except for LULL_OUT_OF_MEMORY and LULL_INTERNAL, after which a
 * stopper can only be destroyed). Null pointers are errors like others, unless stated otherwise.
 * Nothing throws, prints or ends the program.
 *
 * Threads. All functions can be called from any thread at any time, but a stopper must not be used
 * while or after it is destroyed. Different blocks can be checked concurrently; calls for the same
 * block wait for each other. lull_stopper_observe() shares its work between the threads that oneTBB
 * has for the caller. Reading a model uses the HDF5 library, which allows one thread at a time: a
 * program that uses HDF5 itself must not do so meanwhile.
 *
 * The same pictures lead to the same answers, bit for bit, on any number of threads.
 */
#ifndef LULL_STOPPING_H
#define LULL_STOPPING_H

#include <stddef.h>

#if defined(__GNUC__)
#define LULL_API __attribute__((visibility("default")))
#else
#define LULL_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef enum lull_status {
    LULL_OK = 0,
    LULL_BAD_ARGUMENT = 1, /* an invalid setting, size or spp, or an unknown rule */
    LULL_BAD_FILE = 2,     /* a model or thresholds file is missing or damaged, or a saved state */
    LULL_OUT_OF_MEMORY = 3,
    LULL_INTERNAL = 4 /* a bug in lull */
} lull_status;

typedef enum lull_format {
    LULL_LINEAR_FLOAT = 0, /* float, linear R, G, B with Rec. 709 primaries; 1 is the display's
                              white. Values not finite count as black; blocks with more than a
                              tenth of them, or a quarter of negative pixels, are refused, and so
                              are first pictures most of whose lit pixels are above 4. */
    LULL_SRGB8 = 1         /* unsigned char, sRGB, as in a PNG. A half in 8 bits is rounded, which
                              looks like a little noise to rules that read it. */
} lull_format;

/* Holds the settings of a stopper; begin with all zeros. */
typedef struct lull_settings {
    int width, height; /* pixels of the whole picture; from 40 to 65,536 each */
    /* What decides: a model, by its name ("entropy", the default; "noise", "paper") or by its file
     * ("own.h5"); or any other rule of `lull render --stop` ("entropy:0.64", "lnoise",
     * "fixed:400"). Set one of the two; the other is NULL. */
    const char *model, *rule;
    /* The folder of installed models. NULL: $LULL_MODELS if that is set, else share/lull/models
     * where the library is installed. */
    const char* models;
    /* Pixels a side of the blocks, at least 40; 0: 200, which the models were trained on. What is
     * left at the right and at the bottom are smaller blocks. A block with a side below 40 pixels
     * is not checked, but follows the largest of its neighbours, whose answer is its own, too
     * (unless the rule only counts samples). A block as large as the picture is the whole picture.
     */
    int block;
    /* Samples per pixel between two pictures of a block, if always the same: the first picture has
     * as many. 0: pictures come at any spp. Then the default model and the rule `entropy` look at
     * one when 40 spp have passed since the last one that they looked at; "noise" and "paper" look
     * only at 40, 80, 120, ... spp (20, 60, 100, ... with 20 here). The default model compares a
     * picture with earlier ones, at 1 / sqrt(2) of its spp, 1 / 2, ...: with 1.5 times the spp from
     * one picture to the next it votes; with 1.7 times, or if they double (64, 128, 256), never. */
    int pass;
    int cap;        /* The most spp that the picture can have, if above 10,000; 0: not known. Like
                       `pass`, at most 16,777,216 */
    double caution; /* Divides the threshold of visible noise of "entropy", "noise" and the rules
                       `entropy` and `lnoise`: 2 stops later, 0.5 sooner; from 0.01 to 100, 0: 1 */
} lull_settings;

/* Points to pixels, which are read only during the call. Strides are in bytes and may be negative;
 * 0 means contiguous channels of a pixel, pixels of a row, and rows, from the top down. Rows must
 * not overlap. */
typedef struct lull_picture {
    int width, height;
    int format;       /* a lull_format */
    const void* mean; /* of all samples so far: the first channel of the pixel at the top left */
    const void* half; /* the same of one fixed half of the samples; NULL if there is none */
    ptrdiff_t row_stride, pixel_stride, channel_stride;
} lull_picture;

typedef struct lull_rect {
    int x, y, width, height; /* pixels; x to the right, y down */
} lull_rect;

/* Describes the state of a block. No number is NaN. */
typedef struct lull_answer {
    int stop;         /* 1: needs no more samples; stays so */
    int checked;      /* 1: the call checked the block; 0: the numbers are older */
    int spp;          /* of the picture that was shown last, or of the one that stopped it */
    int next_spp;     /* the least spp that will be checked next; 0: none */
    int votes;        /* for stopping, in a row, */
    int votes_needed; /* and how many stop the block; 1 for rules that do not vote */
    /* Once it has stopped: between which spp people would cease to see noise in 80 of 100 cases,
     * for models that know; 0: not known. */
    int people_low, people_high;
    double value;         /* what the rule compares, */
    double threshold;     /* with what */
    double probability;   /* that people would see noise (models), 1 before there is an estimate;
                             -1: the rule has none */
    double visible_noise; /* RMS of the noise in lightness (0 to 100), less on texture, at the last
                             check with a half; -1: not known */
} lull_answer;

/* Decides on the blocks of one picture, from its first samples to its last. */
typedef struct lull_stopper lull_stopper;

/* Makes a stopper. LULL_BAD_ARGUMENT, LULL_BAD_FILE. */
LULL_API lull_status lull_stopper_create(const lull_settings* settings, lull_stopper** stopper);
/* Frees it. It may be NULL. */
LULL_API void lull_stopper_destroy(lull_stopper* stopper);

/* Return the number of blocks, and of their columns (0 for NULL), and where a block lies: row by
 * row from the top left, block = row * columns + column. LULL_BAD_ARGUMENT. */
LULL_API int lull_stopper_block_count(const lull_stopper* stopper);
LULL_API int lull_stopper_column_count(const lull_stopper* stopper);
LULL_API lull_status lull_stopper_block_rect(const lull_stopper* stopper, int block,
                                             lull_rect* rect);
/* Returns 1 if the rule compares with a half of the samples, so that pictures must have one. */
LULL_API int lull_stopper_needs_half(const lull_stopper* stopper);

/* Shows the whole picture, which has `spp` samples per pixel except in blocks that have stopped,
 * whose pixels are not read; `spp` is more than at the last call. Writes an answer for each block,
 * unless `answers` is NULL. LULL_BAD_ARGUMENT. */
LULL_API lull_status lull_stopper_observe(lull_stopper* stopper, const lull_picture* picture,
                                          int spp, lull_answer* answers);
/* Does the same for one block, with a picture of its size. `answer` may be NULL. For a block that
 * follows another nothing is done but to answer. */
LULL_API lull_status lull_stopper_observe_block(lull_stopper* stopper, int block,
                                                const lull_picture* picture, int spp,
                                                lull_answer* answer);
/* Repeats the last answer for a block; `spp` is 0 if there is none. LULL_BAD_ARGUMENT. */
LULL_API lull_status lull_stopper_answer(const lull_stopper* stopper, int block,
                                         lull_answer* answer);
/* Returns 1 if all blocks have stopped, and for NULL. */
LULL_API int lull_stopper_done(const lull_stopper* stopper);

/* Return what a user should know of the pictures that have been shown, as a line of text; "" if
 * there is nothing, and for NULL. Valid until the next call for the stopper. That pictures lie too
 * far apart for the rule, which compares them, so that it will never stop (spp that double), and
 * that pixels seem to have a fourth channel (pixel_stride), which is ignored. */
LULL_API const char* lull_stopper_warning(const lull_stopper* stopper);

/* Writes the state of a stopper to `bytes`, for a checkpoint of the renderer. `*size` is the room
 * there on entry, and the size needed on return; if `bytes` is NULL nothing else is done.
 * LULL_BAD_ARGUMENT if the room is too small. The layout is that of this machine and version. */
LULL_API lull_status lull_stopper_save(const lull_stopper* stopper, void* bytes, size_t* size);
/* Restores that state in a stopper with the same settings. LULL_BAD_FILE if the bytes are damaged
 * or belong to other settings; the stopper is then unchanged. */
LULL_API lull_status lull_stopper_restore(lull_stopper* stopper, const void* bytes, size_t size);

/* Holds the entropies of a part of a picture, each in [0, 1]; h = h1 + h2. */
typedef struct lull_entropy {
    double h, h1, h2;
} lull_entropy;

/* Computes the SVD-entropy of each of `sub_blocks` parts of a picture, row by row, from the
 * lightness (0 to 100) that an 8-bit display shows of its mean: with the n singular values s_i of a
 * part, the largest first, and p_i = s_i^2 / sum s^2, h = -1 / log(n) sum p_i log p_i, of which h1
 * has the terms of the first n / 4 values and h2 the others (Buisine et al. 2021, Eqs. 3 to 5).
 * `sub_blocks` is a square number, 1 for the picture as a whole; the picture has at least its root
 * in pixels a side. `entropies` has room for as many. LULL_BAD_ARGUMENT. */
LULL_API lull_status lull_svd_entropy(const lull_picture* picture, int sub_blocks,
                                      lull_entropy* entropies);
/* Computes the 26 attributes that SVD-entropy is compared with: the means of |L - filtered L| for
 * 13 filters, then their standard deviations. The picture has at least 5 pixels a side,
 * `attributes` room for 26 numbers. LULL_BAD_ARGUMENT. */
LULL_API lull_status lull_attributes26(const lull_picture* picture, double* attributes);

/* Returns what went wrong in the last call of this thread that did not return LULL_OK; never NULL;
 * valid until the next such call. */
LULL_API const char* lull_error_message(void);
/* Returns the version of the library, such as "0.1.0". */
LULL_API const char* lull_version(void);

#ifdef __cplusplus
}
#endif

#endif
