/* color.h - colors as CSS writes them. */
#ifndef CLI_COLOR_H
#define CLI_COLOR_H

#include <stdbool.h>

/* "#rgb", "#rrggbb" or a CSS color name (any case) as linear Rec.709, [0, 1]. False: it is none of these, and linear
 * is untouched. */
bool color_parse(const char *text, float linear[3]);

/* The inverse of the sRGB transfer function (IEC 61966-2-1) for encoded in [0, 1]. */
float color_srgb_to_linear(float encoded);

#endif
