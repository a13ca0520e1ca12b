/* media.h - the bodies that a ray is in, glass in liquid in glass: a small stack of their materials. */
#ifndef CPU_MEDIA_H
#define CPU_MEDIA_H

#include <string.h>

#include "scene/scene.h"

enum { MEDIA_DEPTH = 8 };

/* A body is known by its material: several meshes may bound it together. The one entered last is what the ray goes
 * through, so that a liquid whose surface reaches into the glass around it displaces the glass, as modelling tools
 * recommend. {0}: air. */
typedef struct medium {
    const scene_material *material;
    float thickness_m; /* nominal: thicknessFactor, with the scale of the node */
} medium;

typedef struct media {
    uint32_t count;
    medium bodies[MEDIA_DEPTH]; /* the last is what is here */
} media;

/* NULL: air. */
static inline const scene_material *media_here(const media *m)
{
    return m->count ? m->bodies[m->count - 1].material : NULL;
}

/* Beyond MEDIA_DEPTH the outermost is forgotten. */
static inline void media_enter(media *m, const scene_material *material, float thickness_m)
{
    if (m->count == MEDIA_DEPTH)
        memmove(m->bodies, m->bodies + 1, --m->count * sizeof *m->bodies);
    m->bodies[m->count++] = (medium){.material = material, .thickness_m = thickness_m};
}

/* A ray that leaves what it has not entered (a mesh with a hole, a camera inside) stays where it is. */
static inline void media_leave(media *m, const scene_material *material)
{
    for (uint32_t i = m->count; i > 0; i--)
        if (m->bodies[i - 1].material == material) {
            memmove(m->bodies + i - 1, m->bodies + i, (m->count - i) * sizeof *m->bodies);
            m->count--;
            return;
        }
}

#endif
