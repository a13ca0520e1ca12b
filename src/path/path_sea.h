/* path_sea.h - the water of a sea, where a scene has one (facet_scene.sea): a surface whose waves are vertices down to their
 * spacing and slopes of Gaussian facets below it (shade/water_surface.h), foam on it, and water under it that absorbs and shines
 * as shade/water.h has it. Holds shared shading text: include it last.
 *
 * Radiance is carried as it is on either side: through the surface it changes by the square of the index. */
#ifndef PATH_SEA_H
#define PATH_SEA_H

#include "cpu/surface_point.h"

/* What the caller of the path tracer knows of one picture's sea; scene_primitive.water has what differs from vertex to vertex. */
typedef struct path_sea {
    Water water;
    vec3 downwelling;   /* lx on a horizontal plane just below the surface */
    vec3 beam, sunward; /* irradiance (lx) across the refracted sun's beam there; unit direction to it */
    /* tangent of the angle about sunward within which waves bring the sun; 0: there is none */
    float sun_spread;
    bool is_below;   /* the eye is in the water */
    float center[2]; /* m, X and Z around which the sea falls away */
    float fall;      /* 1/m, by which it does with the square of distance */
    const void *sky; /* for both: */
    /* Radiance (cd/m^2) that the eye sees where nothing is, along the unit direction d. */
    void (*seen)(const void *sky, const float d[3], float radiance[3]);
    /* What the air between the eye and something so far along d, and so high, makes of its radiance. */
    void (*through_air)(const void *sky, const float d[3], float distance_m, float height_m,
                        float radiance[3]);
} path_sea;

/* A place of the surface. */
typedef struct path_sea_point {
    const path_sea *sea;
    vec3 N, Ng; /* unit, up: of the waves that are vertices, turned to where V sees it; of the triangle */
    vec3 C;     /* covariance of the slopes of all others */
    float foam; /* share that it hides */
    float side; /* 1: V is in the air; -1: in the water */
} path_sea_point;

/* Of a hit on a primitive that has water; V: unit, to where the ray came from. */
path_sea_point path_sea_point_make(const path_sea *sea, const shading_hit *h, const float triangle_normal[3],
                                   vec3 V);

/* BSDF |N.L| in 1/sr for light from L, and the pdf with which path_sea_sample() finds it, but for light by way of a second facet, and for
 * light that goes straight on. */
vec3 path_sea_scatter(const path_sea_point *p, vec3 V, vec3 L, float *pdf);

typedef struct path_sea_direction {
    vec3 L;
    float weight, pdf; /* BSDF |N.L| / pdf */
    bool is_through;
    bool is_second;   /* by way of a second facet: not in path_sea_scatter() */
    bool is_straight; /* through a surface between equal indices: neither */
} path_sea_direction;
path_sea_direction path_sea_sample(const path_sea_point *p, vec3 V, float u_lobe, vec2 u);

/* What is seen of the surface on average: foam, and what water reflects; [0, 1]. */
float path_sea_albedo(const path_sea_point *p, vec3 V);

/* m of water over P, 0 above the level. */
float path_sea_depth(const path_sea *sea, vec3 P);
/* Share of light left after x m, x up to INFINITY. */
vec3 path_sea_transmittance(const path_sea *sea, float x);
/* Of the sun's beam, over that: the rest is in its glow. */
vec3 path_sea_unscattered(const path_sea *sea, float x);
/* Radiance (cd/m^2) that the water adds along x m from P along D, as the eye sees it. */
vec3 path_sea_glow(const path_sea *sea, vec3 P, vec3 D, float x);

/* And to light that the bed sends back. */
vec3 path_sea_glow_returned(const path_sea *sea, vec3 P, vec3 D, float x);

/* A direction from below towards where the refracted sun is, and its pdf per sr. */
vec3 path_sea_sunward(const path_sea *sea, vec2 u);
float path_sea_sunward_pdf(const path_sea *sea, vec3 L);

#endif
