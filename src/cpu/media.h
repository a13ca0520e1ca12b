/* media.h - the closed volumes that a ray is in, glass in liquid in glass: a small stack of their
 * materials, and where a ray crosses their boundaries. */
#ifndef CPU_MEDIA_H
#define CPU_MEDIA_H

#include <string.h>

#include "cpu/surface_point.h"
#include "scene/scene.h"

/* ---- the stack ---- */

enum { MEDIA_DEPTH = 8 };

/* A closed volume is identified by its material: several meshes may bound it together. The one entered
 * last is the current medium, so that a liquid whose surface reaches into the glass around it displaces
 * the glass, as modeling tools recommend. {0}: air. */
typedef struct medium {
    const scene_material *material;
    float thickness_m; /* nominal: thicknessFactor times the scale of the node */
} medium;

typedef struct media {
    uint32_t count;
    medium volumes[MEDIA_DEPTH]; /* the last is the current one */
} media;

/* NULL: air. */
static inline const scene_material *media_here(const media *m)
{
    return m->count ? m->volumes[m->count - 1].material : NULL;
}

/* Beyond MEDIA_DEPTH the outermost is forgotten. */
static inline void media_enter(media *m, const scene_material *material, float thickness_m)
{
    if (m->count == MEDIA_DEPTH)
        memmove(m->volumes, m->volumes + 1, --m->count * sizeof *m->volumes);
    m->volumes[m->count++] = (medium){.material = material, .thickness_m = thickness_m};
}

/* Leaving a volume that was not entered (a mesh with a hole, a camera inside) changes nothing. */
static inline void media_leave(media *m, const scene_material *material)
{
    for (uint32_t i = m->count; i > 0; i--)
        if (m->volumes[i - 1].material == material) {
            memmove(m->volumes + i - 1, m->volumes + i, (m->count - i) * sizeof *m->volumes);
            m->count--;
            return;
        }
}

/* ---- boundaries ---- */

/* Lengths, m, below which positions on a triangle are equal: several times the rounding error of the
 * intersection, which is proportional to the largest of its corners' coordinates. */
static inline float media_tolerance(float coordinate_m)
{
    return 1e-6f * coordinate_m + 1e-12f;
}

/* The same at a point. */
float media_tolerance_at(const surface_point *s);

typedef struct media_exit {
    float distance_m;
    vec3 normal; /* unit, geometric, outward */
} media_exit;

/* Where the volume behind s, which bounds it, ends along a unit direction into it. False: nowhere. */
bool media_find_exit(const shading_scene *scene, const surface_point *s, vec3 direction, media_exit *out);

/* Updates the media of a ray that crosses the boundary at s, and coincident boundaries of other volumes (a
 * liquid that touches its glass): within tolerance, m. */
void media_cross(const shading_scene *scene, const visibility_hit *hit, const surface_point *s,
                 float tolerance, media *m);

/* Enters the volumes that P is in, the outermost first as far as can be determined: those that rays to the
 * outside leave more often than enter, in every direction. Returns the number of rays. */
uint32_t media_at(const shading_scene *scene, const float P[3], media *m);

#endif
