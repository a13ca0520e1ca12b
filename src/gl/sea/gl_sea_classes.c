/* gl_sea_classes.c - see gl_sea_classes.h. */
#include "gl/sea/gl_sea_classes.h"

enum { STEP = 8, CLASSES = STEP * STEP * STEP }; /* as sea_block.glsl has them */

uint32_t gl_sea_classes(uint32_t tile_count, gl_sea_class classes[GL_SEA_MOST_CLASSES])
{
    int32_t tiles = (int32_t)tile_count;
    uint32_t count = 0;
    for (int32_t end = 0; end <= tiles; end++)
        classes[count++] = (gl_sea_class){0, 0, end};
    for (int32_t cubic = 1; cubic <= tiles; cubic++)
        for (int32_t begin = 0; begin <= cubic; begin++)
            if (begin == 0 || begin >= cubic - 1)
                classes[count++] = (gl_sea_class){cubic, begin, tiles};
    return count;
}

double gl_sea_class_depth(gl_sea_class c)
{
    return (double)(1 + c.linear_end + STEP * (c.linear_begin + STEP * c.cubic_end)) / CLASSES;
}
