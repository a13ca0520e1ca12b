/* water_frame.h - the inputs of one image of a sea as plain data for a renderer on the GPU; the CPU renderer
 * prepares the same once per image. */
#ifndef WATER_WATER_FRAME_H
#define WATER_WATER_FRAME_H

#include "ocean/caustic_map.h"
#include "ocean/water_table.h"
#include "ocean/waves_foam.h"
#include "water/water_render.h"

struct ibl_light;

/* Layers of images of the sky, RGBA. Columns of the first two are sky_turn() of shade/sky.h, rows sky_row()
 * from the horizon that the eye sees; sampled at texel centers. */
enum {
    SEA_SKY_WIDTH = 512,
    SEA_SKY_HEIGHT = 128,
    SEA_SKY_SEEN = 0, /* radiance seen by the eye without the sun's disc, up to the zenith; cd/m^2 */
    SEA_SKY_AIR, /* down to the nadir: in-scattered radiance between eye and sea over (1 - transmittance), cd/m^2 */
    SEA_SKY_TRANSMITTANCE, /* transmittance over a distance of x / (1 - x) SEA_SKY_DISTANCE_KM, x along the columns, [0, 1) */
    SEA_SKY_DISC, /* the sun's disc over 2 x 2 radii, x to its right, y upwards; cd/m^2 */
    SEA_SKY_LAYERS
};
#define SEA_SKY_DISTANCE_KM 20.0f

/* The sky prefiltered for reflection, cd/m^2: perceptual roughness from 0 to 1 in equal steps, one per layer.
 * Columns and rows as above, from the horizontal up to the zenith. */
enum { SEA_LOBE_WIDTH = 256, SEA_LOBE_HEIGHT = 128, SEA_LOBE_LAYERS = 17 };

/* Effect of a model on the water around it, and on the light on the bed: over one rectangle of the plane
 * each, rows along z, sampled at texel centers. */
enum { SEA_CONTACT_EDGE = 192 };
typedef struct sea_contact {
    float dry;               /* 1: inside of a hull that keeps the sea out */
    float open;              /* the sun's visibility past the model */
    float bed_sun, bed_rest; /* visibility on the bed, of the beam and of all other light: bed_shadow.h */
} sea_contact;

typedef struct water_frame {
    const facet_sea *sea;
    const facet_render_desc *desc; /* resolved, with a camera */
    const waves_foam *foam;        /* NULL: none */
    const water_table *table;
    const caustic_map *caustics; /* NULL: the bed is lit evenly, or there is none */
    bool is_below;               /* the eye is in the water */
    double fall;                 /* 1/m, curvature of the Earth: drop over the squared distance; 0: a plane */
    float deviation_m, shutter_s, exposure;
    /* slope covariance in place of the waves finer than all tiles; [0] < 0: by their spectrum */
    float roughness[3];
    /* WaterLight, and the sun below the surface (shade/water.h) */
    float L[3], sun_irradiance[3], sky_irradiance[3], downwelling[3], sun_fresnel, sky_reflectance;
    float beam[3], sunward[3];
    float crest_beam[3], crest_sunward[3], crest_wavenumber, crest_amplitude_m; /* shade/water_crest.h */
    /* the sky */
    const float *sky; /* SEA_SKY_LAYERS x SEA_SKY_HEIGHT x SEA_SKY_WIDTH x 4 */
    /* SEA_LOBE_LAYERS x SEA_LOBE_HEIGHT x SEA_LOBE_WIDTH x 4; NULL: `reflected` takes their place */
    const float *lobes;
    float horizon_mu, disc_radius; /* cosine of the horizon's zenith angle; disc_radius 0: no visible disc */
    /* prefiltered; background: of an image as environment, else NULL */
    const struct ibl_light *reflected, *background;
    float light_scale, rotation_cos, rotation_sin; /* of both */
    /* scene/identity.h; NULL: no layer of desc needs them, or there is no bed */
    const struct scene_identity *water_identity, *bed_identity;
    /* the model */
    const facet_scene *model;            /* NULL: nothing */
    const facet_render_desc *model_desc; /* lit by the sky and the sea around it, and by the sun */
    float model_low[3], model_high[3];   /* m */
    float model_water_m;                 /* mean water level there */
    float model_water_low_m, model_water_high_m;
    const sea_contact *contact;            /* SEA_CONTACT_EDGE^2 */
    float contact_low[2], contact_high[2]; /* x, z of its rectangle, m */
    bool has_shadow;                       /* of the model on the bed */
    float shadow_low[2], shadow_high[2];   /* x, z of that rectangle, m */
} water_frame;

/* desc: resolved, as for water_render(); it, its sea and scene (NULL: water only) outlive the frame, and so
 * does the cache, which nothing else may use meanwhile. On failure *out is NULL; fails as water_render(). */
facet_result water_frame_create(water_cache *cache, const facet_scene *scene, const facet_render_desc *desc,
                                water_frame **out, facet_render_stats *stats, facet_error *error);
void water_frame_destroy(water_frame *frame); /* NULL is allowed */

#endif
