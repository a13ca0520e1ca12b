/* texture_statistics.c - what can be told of a texture from its counted codes. */
#include "legacy/texture_bench.h"

double texture_mean(const texture_statistics *s, int channel, const float values[256])
{
    double sum = 0;
    for (int i = 0; i < 256; i++)
        sum += (double)s->histogram[channel][i] * (double)values[i];
    return sum / (double)s->texel_count;
}

int texture_percentile(const texture_statistics *s, int channel, double fraction)
{
    double wanted = fraction * (double)s->texel_count;
    double sum = 0;
    for (int i = 0; i < 255; i++) {
        sum += (double)s->histogram[channel][i];
        if (sum >= wanted && sum > 0)
            return i;
    }
    return 255;
}

bool texture_is_two_valued(const texture_statistics *s, int channel)
{
    return s->histogram[channel][0] + s->histogram[channel][255] == s->texel_count;
}

int texture_highest(const texture_statistics *s, int channel)
{
    int i = 255;
    while (i > 0 && s->histogram[channel][i] == 0)
        i--;
    return i;
}

int texture_lowest(const texture_statistics *s, int channel)
{
    int i = 0;
    while (i < 255 && s->histogram[channel][i] == 0)
        i++;
    return i;
}
