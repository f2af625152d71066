/* The denoiser of lull for other renderers: denoises an image ("picture") and estimates its
 * remaining error. For C, and languages that call C.
 *
 *     lull_noisy_picture noisy = {0};            // 0: unknown
 *     noisy.width = 1920, noisy.height = 1080;
 *     noisy.colour.a = first;                    // half buffers: renders with other seeds, or
 *     noisy.colour.b = second;                   // means of odd and of even samples
 *     noisy.albedo.a = albedo;
 *     lull_block_error block = {0, 0, 200, 200};
 *     lull_denoised_picture clean = {pixels, NULL, &block, 1};
 *     const char* wrong = lull_denoise(&noisy, &clean);
 *     if (wrong) puts(wrong);
 *     else if (block.upper < 3.1) ...            // the error is hardly visible
 *
 * No function throws, prints or ends the program. All functions can be called from any thread and
 * run on the threads of oneTBB. Equal pictures give equal bits on any number of threads.
 */
#ifndef LULL_DENOISING_H
#define LULL_DENOISING_H

#include <stddef.h>

#if defined(__GNUC__)
#define LULL_API __attribute__((visibility("default")))
#else
#define LULL_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Two half buffers, read only during the call: pointers to the first channel of the top-left pixel.
 * Strides are in bytes and may be negative; 0: contiguous channels, pixels and rows, from the top.
 */
typedef struct lull_halves {
    const float *a, *b;
    ptrdiff_t row_stride, pixel_stride, channel_stride;
} lull_halves;

/* A noisy picture with its features, which sharpen the result. Of features, `b` is NULL for one
 * image without noise, and both are NULL if there is none. Values that are not finite or negative
 * count as 0. Errors: more than 10 % of the colours not finite, 25 % negative, or half of the
 * non-black ones above 4; equal half buffers, and half buffers with dependent noise. */
typedef struct lull_noisy_picture {
    int width, height;  /* from 1 to 65,536 */
    lull_halves colour; /* linear R, G, B with Rec. 709 primaries, 1 is the display's white; not
                           negative. The noise of `a` and `b` has to be independent. */
    lull_halves albedo; /* of first hits: R, G, B, 0 to 1 */
    lull_halves normal; /* of first hits: X, Y, Z, -1 to 1 */
    lull_halves depth;  /* of first hits: above 0; 0 or infinite without a hit */
} lull_noisy_picture;

/* Visible difference of a block from the true picture, but for the noise of its worst pixels, one
 * of 5,000, on a display of 100 cd/m2 and 40 pixels per degree; observers just accept 3.1. */
typedef struct lull_block_error {
    int x, y, width, height; /* set by the caller; at least 10 pixels a side */
    double estimate;         /* estimated visible difference */
    double upper;            /* upper bound, exceeded in 10 of 100 blocks */
} lull_block_error;

/* The results. */
typedef struct lull_denoised_picture {
    float* colour;            /* 3 * width * height values: R, G, B, row by row from the top */
    float* error;             /* width * height values: estimated standard error of each pixel in
                                 L*; or NULL */
    lull_block_error* blocks; /* blocks to estimate; or NULL */
    int block_count;
} lull_denoised_picture;

/* Denoises a picture, in about 11 us of CPU time per pixel. Returns NULL, or an error message that
 * is valid until the next call of this thread; nothing is written then. */
LULL_API const char* lull_denoise(const lull_noisy_picture* noisy, lull_denoised_picture* clean);

#ifdef __cplusplus
}
#endif

#endif
