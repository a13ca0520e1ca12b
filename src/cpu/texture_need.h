/* texture_need.h - which textures an image needs, and at which resolution. */
#ifndef CPU_TEXTURE_NEED_H
#define CPU_TEXTURE_NEED_H

#include "draw/render_geometry.h"
#include "draw/texture.h"

/* Options that matter to texture footprints. */
typedef struct texture_need_desc {
    uint32_t width, height;      /* of the whole image: a crop reads the same mips */
    float footprint;             /* side of the square that a shade represents, pixels */
    const facet_ogl1_desc *ogl1; /* options of legacy materials; NULL: none */
    float opacity_footprint;     /* of alpha for coverage tests */
    bool keeps_all_texels;       /* no part of the image is less sharp than its footprints */
    bool is_opacity_only;        /* rays are traced, and no hit is shaded */
    uint32_t thread_count;
} texture_need_desc;

/* Writes one use per texture of the scene. min_lod is a bound: over the triangles in the image, the mip at
 * which a texel is as large as the smaller extent of a pixel's footprint at the triangle's nearest vertex.
 * Triangles that add up to a few pixels are ignored; unless keeps_all_texels is set, or a texture decides on coverage,
 * so are footprints whose coarser mip changes the pixels that show the texture by less than half a code (RMS). Needs the vertices of set. Fails with
 * FACET_ERROR_MEMORY. */
facet_result texture_need(const facet_scene *scene, const render_geometry_set *set, const camera_rays *camera,
                          const texture_need_desc *desc, const facet_allocator *allocator, texture_use *uses,
                          facet_error *error);

#endif
