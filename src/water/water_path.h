/* water_path.h - water as the path tracer sees it (path/path_surface.h): waves are vertices down to their
 * spacing, finer ones are microfacets with Gaussian slopes (shade/water_surface.h), with foam between
 * them; the water below absorbs and scatters as shade/water.h describes. */
#ifndef WATER_WATER_PATH_H
#define WATER_WATER_PATH_H

#include "path/path_surface.h"
#include "water/water_setup.h"

/* The water of one image; scene_primitive.water has its parameters per vertex. */
typedef struct water_path {
    Water water;
    vec3 downwelling;   /* lx on a horizontal plane just below the surface */
    vec3 beam, sunward; /* irradiance (lx) across the refracted sun's beam there; unit direction to it */
    float sun_spread; /* tangent of the angle about sunward within which waves refract sunlight; 0: no sun */
    bool is_below;    /* the camera is in the water */
    float center[2];  /* m, X and Z around which the sea falls away */
    float fall;       /* 1/m, by which it does with the square of distance */
    const water_sky *sky; /* for the background and the air */
} water_path;

/* Refers to s. */
water_path water_path_make(const water_setup *s);
/* Refers to w. */
path_surface water_path_surface(const water_path *w);

/* m of water over P, 0 above the level. */
float water_path_depth(const water_path *w, vec3 P);

#endif
