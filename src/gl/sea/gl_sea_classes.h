/* gl_sea_classes.h - pixels of a sea's picture sorted by what is done for them: sea_class.frag writes numbers of classes as depths. */
#ifndef GL_GL_SEA_CLASSES_H
#define GL_GL_SEA_CLASSES_H

#include <stdint.h>

/* How the tiles of waves are read: those from 0 to cubic_end may be so by cubics, those from linear_begin to linear_end linearly. */
typedef struct gl_sea_class {
    int32_t cubic_end, linear_begin, linear_end;
} gl_sea_class;

enum { GL_SEA_MOST_CLASSES = 24 };

/* Those that there are with so many tiles; how many. Depth 0 is what is not water. */
uint32_t gl_sea_classes(uint32_t tile_count, gl_sea_class classes[GL_SEA_MOST_CLASSES]);
/* What sea_class.frag writes for it, exact in floats. */
double gl_sea_class_depth(gl_sea_class c);

#endif
