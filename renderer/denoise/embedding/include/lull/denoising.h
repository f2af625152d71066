/* Takes the noise out of pictures of any renderer, and says how wrong they may still be: lull's
 * denoiser, for C and everything that can call C.
 *
 *     lull_noisy_picture noisy = {0};            // what is 0 is not known
 *     noisy.width = 1920, noisy.height = 1080;
 *     noisy.colour.a = first;                    // two renders with other seeds, or the means of
 *     noisy.colour.b = second;                   // every other sample and of the rest
 *     noisy.albedo.a = albedo;
 *     lull_block_error block = {0, 0, 200, 200};
 *     lull_denoised_picture clean = {pixels, NULL, &block, 1};
 *     const char* wrong = lull_denoise(&noisy, &clean);
 *     if (wrong) puts(wrong);
 *     else if (block.upper < 3.1) ...            // people would hardly see the error
 *
 * Nothing throws, prints or ends the program. All functions can be called from any thread; the work
 * is shared between the threads that oneTBB has for the caller. The same pictures give the same
 * bits on any number of threads.
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

/* Points to two images of the same, each the mean of one half of the samples, which are read only
 * during the call: to the first channel of the pixel at the top left. Strides are in bytes and may
 * be negative; 0 means contiguous channels of a pixel, pixels of a row, and rows, from the top
 * down. */
typedef struct lull_halves {
    const float *a, *b;
    ptrdiff_t row_stride, pixel_stride, channel_stride;
} lull_halves;

/* Holds what is known of a picture. Of all but the colours, `b` may be NULL, where there is one
 * image without noise, and both may, where there is none; the more there is, the sharper the
 * result. Values that are not finite or negative count as 0. Refused are colours of which more than
 * a tenth are not finite, a quarter negative, or half of what is lit above 4; and halves that are
 * the same, or whose noise is seen to be. */
typedef struct lull_noisy_picture {
    int width, height;  /* from 1 to 65,536 */
    lull_halves colour; /* linear R, G, B with Rec. 709 primaries, 1 is the display's white; not
                           negative. The noise of `a` and `b` has to be independent. */
    lull_halves albedo; /* of what paths meet first: R, G, B, 0 to 1 */
    lull_halves normal; /* the same: X, Y, Z, each from -1 to 1 */
    lull_halves depth;  /* the same, one channel: above 0; 0 or infinite where there is nothing */
} lull_noisy_picture;

/* Says how visibly a block still differs from the true picture, on a display of 100 cd/m2 and 40
 * pixels a degree; people just accept 3.1. */
typedef struct lull_block_error {
    int x, y, width, height; /* which block: set by the caller; at least 10 pixels a side */
    double estimate;         /* how wrong it probably is, */
    double upper;            /* and what that hardly exceeds: meant to, in 5 of 100 blocks */
} lull_block_error;

/* Says where to write. */
typedef struct lull_denoised_picture {
    float* colour; /* 3 * width * height values: R, G, B of each pixel, row by row from the top */
    float* error;  /* width * height values: the estimated standard error of each pixel in
                      lightness (0 to 100); or NULL */
    lull_block_error* blocks; /* whose errors are wanted; or NULL */
    int block_count;
} lull_denoised_picture;

/* Denoises a picture; takes some 11 us of CPU time a pixel. Returns NULL, or what is wrong, and
 * then has written nothing: a text that is valid until the next call of this thread. */
LULL_API const char* lull_denoise(const lull_noisy_picture* noisy, lull_denoised_picture* clean);

#ifdef __cplusplus
}
#endif

#endif
