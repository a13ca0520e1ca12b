/* path_vertex.h - a hit made into what a path scatters at: the surface, its lobes and tables, and both its sides. Holds
 * shared shading text: include it last. */
#ifndef PATH_VERTEX_H
#define PATH_VERTEX_H

#include "path/path_state.h"
#include "path/path_surface.h"

typedef struct path_vertex {
    surface_point s; /* s.m.base.N sees V */
    vec3 Ng;         /* unit, geometric, on the side of V */
    float tolerance; /* m: positions that are nearer are the same; volume_rays.h */
    int energy;
    bool lets_through; /* some lobe is on the other side */
    bool is_false;     /* no boundary: the same is on both sides, another body displaces this one here */
    bool is_mirror;    /* no other lobes */
    bool is_straight;  /* path_vertex_straight() is not 0, and shadow rays know */
    bool disperses;    /* light that goes through needs a wavelength first */
    const path_surface *surface; /* NULL: a mesh with a material */
    path_surface_point on;       /* surface: the point of it */
    media behind;                /* what is on the other side */
    LayerTables tables;
    LayersLobes lobes;
} path_vertex;

/* The surface that p's ray met as hit. The back of a body that p is not in (a mesh with a hole) is left as if it were:
 * p->media is told. */
void path_vertex_make(path *p, const visibility_hit *hit, const shading_ray *ray, path_vertex *v);

/* cd/m^2 towards V. Single-sided surfaces that are no boundary of a body shine on their front only; what is drawn in flat
 * color shines with it. */
vec3 path_vertex_emission(const path_vertex *v);

/* BSDF |N.L| in 1/sr for light from L, and the pdf with which path_vertex_sample() finds it; both without mirrors. */
vec3 path_vertex_scatter(const path_vertex *v, vec3 L, float *pdf);
/* The same for a light without size, which mirrors show as well, as spots: layers_punctual(). */
vec3 path_vertex_scatter_punctual(const path_vertex *v, vec3 L);

/* False: the path ends here. */
bool path_vertex_sample(const path_vertex *v, float u_lobe, vec2 u, bsdf_sample *out);
/* Makes v that of one wavelength, for what goes through. */
void path_vertex_set_wavelength(const path *p, path_vertex *v);

/* The share of light that goes straight on through the surface: a thin wall without blur, a boundary that does not refract.
 * Shadow rays pass it as paths do. 0: none does. */
vec3 path_vertex_straight(const path_vertex *v);

/* Where a ray into direction L starts, so that it does not meet the surface that it leaves. */
static inline vec3 path_vertex_start(const path_vertex *v, vec3 L)
{
    return v->s.P + v->Ng * (dot(v->Ng, L) < 0.0f ? -v->tolerance : v->tolerance);
}

/* N for path_lights_sample(). */
static inline vec3 path_vertex_light_normal(const path_vertex *v)
{
    return v->lets_through ? vec3(0.0f) : v->s.m.base.N;
}

#endif
