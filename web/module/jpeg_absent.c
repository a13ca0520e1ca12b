/* jpeg_absent.c - parts of libjpeg-turbo that TurboJPEG's interface never asks for without TJFLAG_FASTUPSAMPLE: images of few colors,
 * and upsampling without filter. The linker takes these functions in place of the library's. */
#include <stdlib.h>

void jinit_1pass_quantizer(void *decompression);
void jinit_2pass_quantizer(void *decompression);
void jinit_merged_upsampler(void *decompression);

void jinit_1pass_quantizer(void *decompression)
{
    (void)decompression;
    abort();
}

void jinit_2pass_quantizer(void *decompression)
{
    (void)decompression;
    abort();
}

void jinit_merged_upsampler(void *decompression)
{
    (void)decompression;
    abort();
}
