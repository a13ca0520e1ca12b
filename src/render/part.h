/* part.h - parts of an image: which pixels and samples they have, what their files say, and merging. A part is a film
 * before everything that needs the whole image: exposure of path traced light, denoising, tone mapping, background. */
#ifndef RENDER_PART_H
#define RENDER_PART_H

#include "base/file.h"
#include "render/renderer_set.h"

/* ---- making a part ---- */

/* Restricts a resolved desc to its part: crop, or a range of samples. FACET_ERROR_ARGUMENT: the image cannot be divided
 * like that. */
facet_result part_narrow(const facet_render_desc *whole, facet_render_desc *part, facet_error *error);
/* The AOVs of a part's film beside the sums. */
uint32_t part_aovs(const facet_render_desc *desc);
/* Adds the texts of the file to the film of a part. whole: desc before part_narrow(), with its camera. */
facet_result part_describe(renderer_set *set, const facet_render_desc *whole, const facet_render_desc *part,
                           uint64_t dropped, film *f, facet_error *error);

/* ---- what the texts say ---- */

/* All that merging needs beside the values. */
typedef struct part_header {
    facet_part_info info;
    uint32_t samples; /* per pixel, of the whole image */
    facet_renderer_kind renderer;
    uint32_t aovs;
    bool has_ground;
    uint64_t dropped;
    /* finishing */
    float exposure_ev;
    bool denoises;
    facet_background background;
    float background_color[3];
    facet_shading shading;
    bool is_ogl1_linear;
} part_header;

/* Opens the file of a part. FACET_ERROR_READ: it cannot be read, or is no regular file; a part is read several times. */
facet_result part_open(const char *path, const facet_allocator *allocator, file_bytes *file,
                       facet_error *error);
/* FACET_ERROR_INVALID: the bytes are no part. */
facet_result part_header_read(const unsigned char *bytes, size_t size, const char *path, part_header *out,
                              facet_error *error);
/* A hash of the values in a rectangle of the film's layers, the first layer_count of them. */
uint64_t part_digest(const film *f, const uint32_t rectangle[4]);

/* What the image depends on. FACET_ERROR_MEMORY, and as the pose. */
facet_result part_key_create(renderer_set *set, const facet_render_desc *whole, char hex[65],
                             facet_error *error);
/* The machine, as far as pixels depend on it: "portable, GenuineIntel"; "own BVH". */
void part_describe_machine(const facet_render_desc *desc, char *text, size_t size);

/* ---- merging ---- */

/* As facet_part_merge(), into a film that is tone-mapped over its background. desc: not NULL, with a thread count. */
facet_result part_merge(const char *const *paths, size_t path_count, const facet_merge_desc *desc, film *out,
                        facet_render_stats *stats, facet_error *error);

#endif
