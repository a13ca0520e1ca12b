/* path_vertex.h - a hit as a vertex of a path: the surface, its lobes and tables, and the media on both
 * its sides. */
#ifndef PATH_PATH_VERTEX_H
#define PATH_PATH_VERTEX_H

#include "cpu/media.h"
#include "path/path_surface.h"
#include "path/path_scene.h"

typedef struct path_vertex {
    surface_point s;   /* s.m.base.N is visible from V */
    vec3 Ng;           /* unit, geometric, on the side of V */
    float tolerance_m; /* positions that are nearer are equal: media_tolerance_at() */
    int delta_energy; /* ENERGY_* of path_vertex_eval_delta(); other light is reflected with multiple scattering */
    bool is_transmissive;   /* some lobe is on the other side */
    bool is_null_interface; /* the same medium is on both sides: another volume displaces this one here */
    bool is_specular;       /* specular lobes only */
    bool passes_straight;   /* path_vertex_straight() is not 0; shadow rays pass as well */
    bool disperses;         /* transmitted light needs a wavelength first */
    media behind;           /* on the other side */
    LayerTables tables;
    LayersLobes lobes;
    SurfaceLobesAtV plain;       /* without layers */
    const path_surface *surface; /* NULL: a mesh with a material */
    path_surface_point on;       /* surface: the point of it */
} path_vertex;

/* The surface that a ray hit, coming through the media `in`. A back face of a volume that `in` lacks (a
 * mesh with a hole) is left as if it had been entered: `in` gets it. wavelength_nm: 0: all. */
void path_vertex_make(const path_scene *scene, const visibility_hit *hit, const shading_ray *ray, media *in,
                      float wavelength_nm, path_vertex *v);
/* Makes v that of one wavelength, for transmitted light. */
void path_vertex_set_wavelength(path_vertex *v, const media *in, float wavelength_nm);

/* Emitted radiance towards V, cd/m^2. Single-sided surfaces that bound no volume emit on their front only;
 * unlit surfaces emit their color. */
vec3 path_vertex_emission(const path_vertex *v);

/* BSDF |N.L| in 1/sr for light from L, and the pdf (per sr) of path_vertex_sample(); both without specular
 * lobes. */
vec3 path_vertex_eval(const path_vertex *v, vec3 L, float *pdf);
/* The same for a delta light, which specular lobes reflect as a highlight: layers_punctual(). */
vec3 path_vertex_eval_delta(const path_vertex *v, vec3 L);
/* False: the path ends here. */
bool path_vertex_sample(const path_vertex *v, float u_lobe, vec2 u, bsdf_sample *out);

/* Transmittance straight through the surface: of a smooth thin wall, or of a boundary between equal
 * indices. Shadow rays pass it as paths do. Else 0. */
vec3 path_vertex_straight(const path_vertex *v);

/* Where a ray in direction L starts, so that it does not hit the surface that it leaves. */
static inline vec3 path_vertex_start(const path_vertex *v, vec3 L)
{
    return v->s.P + v->Ng * (dot(v->Ng, L) < 0.0f ? -v->tolerance_m : v->tolerance_m);
}

/* N for path_lights_see(). */
static inline vec3 path_vertex_light_normal(const path_vertex *v)
{
    return v->is_transmissive ? vec3(0.0f) : v->s.m.base.N;
}

#endif
