/* gl_sea_block.h - the parameters of one image of a sea, as in sea_block.glsl: std140. */
#ifndef GL_GL_SEA_BLOCK_H
#define GL_GL_SEA_BLOCK_H

#include "draw/camera_rays.h"
#include "gl/sea/gl_sea_mesh.h"
#include "water/water_frame.h"

enum { GL_SEA_PATCHES = 128, GL_SEA_FOOTPRINTS = 64 }; /* corners of patches per axis around the eye */

/* Images of a model whose near plane is the water: what the eye's mirror image sees on the eye's side,
 * and, for an eye in the water, what is above it. */
enum { GL_SEA_MIRRORED, GL_SEA_WINDOW, GL_SEA_CUTS };

enum { GL_SEA_BALLS = 4 }; /* bounding spheres of parts of a model */

typedef struct gl_sea_block {
    float axes[WAVES_MAX_TILES][4], places[WAVES_MAX_TILES][4], lengths[WAVES_MAX_TILES][4];
    int32_t counts[4];
    float eye[4], ray[4], clip[4], fan[4], fan_ends[4], fan_level[4], shift[4];
    float residual[GL_SEA_FOOTPRINTS][4], moments[GL_SEA_FOOTPRINTS][4], total[4], rough[4];
    float foam_axes[FOAM_READINGS][4], foam_places[FOAM_READINGS][4];
    float foam_hidden[WAVES_MAX_LEVELS][4];
    float absorption[4], scattering[4], backscattering[4], reflectance[4], pure_share[4];
    float sun[4], sun_irradiance[4], sky_irradiance[4], downwelling[4], beam[4], sunward[4];
    float crest_beam[4], crest_sunward[4];
    float bed[4], bed_slope[4], sky_at[4], caustic_axis[4], caustics[CAUSTIC_LAYERS][4];
    int32_t style[4];
    /* of a model: gl_sea_model.c */
    float cut[GL_SEA_CUTS][16], cut_axis[GL_SEA_CUTS][4], cut_plane[GL_SEA_CUTS][4];
    float model_depth[4], model_middle[4], model_half[4], model_balls[GL_SEA_BALLS][4], contact[4], shadow[4];
} gl_sea_block;

void gl_sea_block_fill(const water_frame *frame, const camera_rays *camera, const gl_sea_fan *fan,
                       gl_sea_block *block);

#endif
