/* color.h - colors as CSS writes them. */
#ifndef CLI_COLOR_H
#define CLI_COLOR_H

#include <stdbool.h>

/* "#rgb", "#rrggbb" or a CSS color name (any case) as linear Rec.709, [0, 1]. False: it is none of these, and linear
 * is untouched. */
bool color_parse(const char *text, float linear[3]);

#endif
