/* The header is C: this file is compiled as such, and says what C sees. */
#include <lull/denoising.h>

const char* lull_denoise_in_c(void);

const char* lull_denoise_in_c(void) {
    lull_noisy_picture noisy = {0};
    lull_denoised_picture clean = {0};
    return lull_denoise(&noisy, &clean);
}
