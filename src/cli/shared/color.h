/* color.h - CSS colors. */
#ifndef CLI_COLOR_H
#define CLI_COLOR_H

#include <stdbool.h>

/* Parses "#rgb", "#rrggbb" or a CSS color name (in any case) to linear Rec.709, [0, 1]. Returns false and
 * leaves linear untouched otherwise. */
bool color_parse(const char *text, float linear[3]);

#endif
