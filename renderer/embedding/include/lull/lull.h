/* The stopping rule and the denoiser of lull for other renderers. For C, and languages that call C.
 *
 * The stopping rule decides for each block of an image whether it needs more samples:
 *
 *     lull_settings settings = {0};              // 0: default
 *     settings.width = 1920, settings.height = 1080;
 *     lull_stopper* stopper = NULL;
 *     if (lull_stopper_create(&settings, &stopper) != LULL_OK) puts(lull_error_message());
 *     while (!lull_stopper_done(stopper)) {
 *         spp += render(...);                    // more samples in active blocks
 *         lull_image image = {1920, 1080, LULL_LINEAR_FLOAT, pixels};
 *         lull_stopper_observe(stopper, &image, spp, NULL);
 *     }
 *     lull_stopper_destroy(stopper);
 *
 * The image is cut into blocks, each of which stops by itself. Only active blocks need
 * more samples; blocks may have different sample counts.
 *
 * The denoiser denoises an image and estimates its remaining error:
 *
 *     lull_noisy_image noisy = {0};            // 0: unknown
 *     noisy.width = 1920, noisy.height = 1080;
 *     noisy.colour.a = first;                    // half buffers: renders with other seeds, or
 *     noisy.colour.b = second;                   // means of odd and of even samples
 *     noisy.albedo.a = albedo;
 *     lull_block_error block = {0, 0, 200, 200};
 *     lull_denoised_image clean = {pixels, NULL, &block, 1};
 *     if (lull_denoise(&noisy, &clean) != LULL_OK) puts(lull_error_message());
 *     else if (block.estimate < 3.1) ...         // as lull render --denoise stops
 *
 * Errors. Functions return LULL_OK or another lull_status. In the latter case,
 * lull_error_message() returns the reason and the remedy, in the same thread. No result is written,
 * and no block changes its state, except for LULL_OUT_OF_MEMORY and LULL_INTERNAL, after which a
 * stopper can only be destroyed. Null pointers are errors, unless stated otherwise. No function
 * throws, prints or ends the program.
 *
 * Threads. All functions can be called from any thread. A stopper must not be used while or after
 * it is destroyed. Different blocks can be checked concurrently; calls for one block are
 * serialised. lull_stopper_observe() and lull_denoise() run on the threads of oneTBB. Reading a
 * model uses HDF5, which allows one thread at a time: a program that uses HDF5 must not do so
 * meanwhile.
 *
 * Equal images lead to equal answers, bit for bit, on any number of threads.
 */
#ifndef LULL_LULL_H
#define LULL_LULL_H

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
                              white. Values that are not finite count as black. Errors: blocks with
                              more than 10 % of them or 25 % of negative pixels, and first images
                              with most non-black pixels above 4. */
    LULL_SRGB8 = 1         /* unsigned char, sRGB, as in a PNG. A half buffer in 8 bits has rounding
                              errors, which rules that read it take for noise. */
} lull_format;

/* Settings of a stopper; initialise with zeros. */
typedef struct lull_settings {
    int width, height; /* pixels of the whole image, 40 to 65,536 */
    /* The rule: a model by name ("entropy", the default; "paper") or file ("own.h5"), or
     * another rule of `lull render --stop` ("entropy:0.64", "lnoise", "fixed:400"). At most one is
     * set; the other is NULL. */
    const char *model, *rule;
    /* Folder of installed models. NULL: $LULL_MODELS if set, else share/lull/models of the
     * installation. */
    const char* models;
    /* Side of the blocks in pixels, at least 40; 0: 200, the size of the training data. Blocks at
     * the right and bottom border can be smaller. A block with a side below 40 pixels is not
     * checked: it has the answer of its largest neighbour, unless the rule only counts samples. */
    int block;
    /* Spp between two images of a block, if constant; the first image has as many. 0: any. The
     * default model and the rule `entropy` then check an image 40 spp after the last checked one;
     * "paper" checks at 40, 80, 120, ... spp (at 20, 60, 100, ... for pass = 20). The
     * default model compares an image with earlier ones at 1 / sqrt(2), 1 / 2, ... of its spp: it
     * votes if spp grow by at most 1.5x per image, and never if they double (64, 128, 256). */
    int pass;
    int cap;        /* The most spp that the image can have, if above 10,000; 0: not known. Like
                       `pass`, at most 16,777,216 */
    double caution; /* Multiplies the noise that "entropy" receives, and divides the
                       thresholds of the rules `entropy` and `lnoise` and all limits of peak noise:
                       2 stops later, 0.5 sooner; from 0.01 to 100, 0: 1 */
} lull_settings;

/* Points to pixels, which are read only during the call. Strides are in bytes and may be negative;
 * 0 means contiguous channels of a pixel, pixels of a row, and rows, from the top down. Rows must
 * not overlap. */
typedef struct lull_image {
    int width, height;
    int format;       /* a lull_format */
    const void* mean; /* mean of all samples: first channel of the top-left pixel */
    const void* half; /* half buffer: mean of a fixed half of the samples; NULL: the rule
                         does without a limit of peak noise */
    ptrdiff_t row_stride, pixel_stride, channel_stride;
} lull_image;

typedef struct lull_rect {
    int x, y, width, height; /* pixels; x to the right, y down */
} lull_rect;

/* State of a block. No number is NaN. */
typedef struct lull_answer {
    int stop;            /* 1: needs no more samples; final */
    int checked;         /* 1: the call checked the block; 0: the numbers are older */
    int spp;             /* of the last image, or of the one that stopped the block */
    int next_spp;        /* smallest spp of the next check; 0: none */
    int votes;           /* consecutive votes to stop */
    int votes_needed;    /* votes that stop the block; 1 for rules without votes */
    double value;        /* value of the rule, */
    double threshold;    /* and its threshold */
    double probability;  /* that an observer sees noise (models); 1 before the first estimate;
                            -1: none */
    double masked_noise; /* RMS noise in L*, masked by texture, at the last check with a half
                             buffer; -1: unknown */
} lull_answer;

/* Decides on the blocks of one image, from its first to its last samples. */
typedef struct lull_stopper lull_stopper;

/* Creates a stopper. Errors: LULL_BAD_ARGUMENT, LULL_BAD_FILE. */
LULL_API lull_status lull_stopper_create(const lull_settings* settings, lull_stopper** stopper);
/* Destroys a stopper; NULL is allowed. */
LULL_API void lull_stopper_destroy(lull_stopper* stopper);

/* Return the numbers of blocks and of columns (0 for NULL), and the rectangle of a block. Blocks
 * have numbers row by row from the top left: row * columns + column.
 * Error: LULL_BAD_ARGUMENT. */
LULL_API int lull_stopper_block_count(const lull_stopper* stopper);
LULL_API int lull_stopper_column_count(const lull_stopper* stopper);
LULL_API lull_status lull_stopper_block_rect(const lull_stopper* stopper, int block,
                                             lull_rect* rect);
/* Returns 1 if the rule needs half buffers. */
LULL_API int lull_stopper_needs_half(const lull_stopper* stopper);

/* Checks all active blocks of the whole image. `spp` is their sample count, larger than at the
 * last call; stopped blocks are not read. Writes one answer per block, unless `answers` is NULL.
 * Error: LULL_BAD_ARGUMENT. */
LULL_API lull_status lull_stopper_observe(lull_stopper* stopper, const lull_image* image, int spp,
                                          lull_answer* answers);
/* Checks one block, with an image of its size. `answer` may be NULL. A block that follows another
 * is not checked. Error: LULL_BAD_ARGUMENT. */
LULL_API lull_status lull_stopper_observe_block(lull_stopper* stopper, int block,
                                                const lull_image* image, int spp,
                                                lull_answer* answer);
/* Returns the last answer for a block; `spp` is 0 before the first. Error: LULL_BAD_ARGUMENT. */
LULL_API lull_status lull_stopper_answer(const lull_stopper* stopper, int block,
                                         lull_answer* answer);
/* Returns 1 if all blocks are clean, and for NULL. */
LULL_API int lull_stopper_done(const lull_stopper* stopper);

/* Returns a warning about the images so far, as a line of text; "" if there is none, and for
 * NULL. Valid until the next call for the stopper. Images are too far apart for a rule that
 * compares them (spp that double): it will never stop. Or pixels seem to have a fourth channel
 * (pixel_stride), which is ignored. */
LULL_API const char* lull_stopper_warning(const lull_stopper* stopper);

/* Writes the state of a stopper to `bytes`, for a checkpoint of the renderer. `*size` is the room
 * there on entry, and the size needed on return; if `bytes` is NULL nothing else is done.
 * LULL_BAD_ARGUMENT if the room is too small. The layout is that of this machine and version. */
LULL_API lull_status lull_stopper_save(const lull_stopper* stopper, void* bytes, size_t* size);
/* Restores a state into a stopper with equal settings. LULL_BAD_FILE if the bytes are damaged or
 * belong to other settings; the stopper is then unchanged. */
LULL_API lull_status lull_stopper_restore(lull_stopper* stopper, const void* bytes, size_t size);

/* The entropies of a part of an image, each in [0, 1]; h = h1 + h2. */
typedef struct lull_entropy {
    double h, h1, h2;
} lull_entropy;

/* Computes the SVD-entropy of each of `sub_blocks` parts of an image, row by row, from the
 * lightness (0 to 100) that an 8-bit display shows of its mean. Let s_i be the n singular values of
 * a part, the largest first, and p_i = s_i^2 / sum s^2. Then h = -1 / log(n) sum p_i log p_i; h1
 * has the terms of the first n / 4 values, h2 the others (Buisine et al. 2021, Eqs. 3 to 5).
 * `sub_blocks` is a square number, 1 for the image as a whole; the image has at least its root
 * in pixels a side. `entropies` has room for as many. LULL_BAD_ARGUMENT. */
LULL_API lull_status lull_svd_entropy(const lull_image* image, int sub_blocks,
                                      lull_entropy* entropies);
/* Computes the 26 attributes that SVD-entropy is compared with: the means of |L - filtered L| for
 * 13 filters, then their standard deviations. The image has at least 5 pixels a side,
 * `attributes` room for 26 numbers. LULL_BAD_ARGUMENT. */
LULL_API lull_status lull_attributes26(const lull_image* image, double* attributes);

/* Two half buffers, read only during the call: pointers to the first channel of the top-left pixel.
 * Strides are in bytes and may be negative; 0: contiguous channels, pixels and rows, from the top.
 */
typedef struct lull_halves {
    const float *a, *b;
    ptrdiff_t row_stride, pixel_stride, channel_stride;
} lull_halves;

/* A noisy image with its features, which sharpen the result. Of features, `b` is NULL for one
 * image without noise, and both are NULL if there is none. Values that are not finite or negative
 * count as 0. Errors: more than 10 % of the colours not finite, 25 % negative, or half of the
 * non-black ones above 4; equal half buffers, and half buffers with dependent noise. */
typedef struct lull_noisy_image {
    int width, height;  /* from 1 to 65,536 */
    lull_halves colour; /* linear R, G, B with Rec. 709 primaries, 1 is the display's white; not
                           negative. The noise of `a` and `b` has to be independent. */
    lull_halves albedo; /* of first hits: R, G, B, 0 to 1 */
    lull_halves normal; /* of first hits: X, Y, Z, -1 to 1 */
    lull_halves depth;  /* of first hits: above 0; 0 or infinite without a hit */
} lull_noisy_image;

/* Visible difference of a block from the true image on a display of 100 cd/m2 and 40 pixels per
 * degree, without the noise of its worst pixels, one of 5,000. `lull render` stops at an estimate
 * below 3.1. */
typedef struct lull_block_error {
    int x, y, width, height; /* set by the caller; at least 10 pixels a side */
    double estimate;         /* estimated visible difference */
    double upper;            /* upper bound, exceeded in 10 of 100 blocks */
} lull_block_error;

/* The results. */
typedef struct lull_denoised_image {
    float* colour;            /* 3 * width * height values: R, G, B, row by row from the top */
    float* error;             /* width * height values: estimated standard error of each pixel in
                                 L*; or NULL */
    lull_block_error* blocks; /* blocks to estimate; or NULL */
    int block_count;
} lull_denoised_image;

/* Denoises an image. Error: LULL_BAD_ARGUMENT. */
LULL_API lull_status lull_denoise(const lull_noisy_image* noisy, lull_denoised_image* clean);

/* Returns the reason and remedy of the last error in this thread; never NULL; valid until the next
 * error. */
LULL_API const char* lull_error_message(void);
/* Returns the version of the library, such as "0.1.0". */
LULL_API const char* lull_version(void);

#ifdef __cplusplus
}
#endif

#endif
