/* The header is C: this file is compiled as such, and says what C sees. */
#include <lull/lull.h>

int lull_header_in_c(void);

int lull_header_in_c(void) {
    lull_settings settings = {0};
    lull_stopper* stopper = NULL;
    int blocks;
    settings.width = 400;
    settings.height = 300;
    settings.rule = "entropy";
    if (lull_stopper_create(&settings, &stopper) != LULL_OK) return -1;
    blocks = lull_stopper_block_count(stopper);
    lull_stopper_destroy(stopper);
    return blocks + (int)sizeof(lull_answer);
}
