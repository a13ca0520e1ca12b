/* facet/part.h - one image rendered by several processes: parts, their files, and merging them into the image that one
 * process would have rendered, to the last bit. docs/parts.md */
#ifndef FACET_PART_H
#define FACET_PART_H

#include "base.h"
#include "image.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- making a part ---- */

typedef enum facet_part_split {
    FACET_PART_SPLIT_TILES,  /* a rectangle of the image */
    FACET_PART_SPLIT_SAMPLES /* all pixels with a range of their samples; FACET_RENDERER_KIND_PATH */
} facet_part_split;

/* Part of an image, in facet_render_desc. {0}: the whole image.
 *
 * The image that facet_render() returns for a part is unfinished: layers of radiance, or of sums over samples, without
 * tone mapping, background and denoising. facet_image_save() and facet_image_encode() write it as OpenEXR, with all that
 * facet_part_merge() needs to finish it. Not for FACET_RENDERER_KIND_GL, nor adaptive sampling (path.noise), where a
 * pixel's samples depend on pixels of other parts; a part has no time for less than all of its samples. */
typedef struct facet_part_desc {
    uint32_t index, count; /* index < count; count 0: the whole image */
    facet_part_split split;
    /* desc.tonemap is meant for display-referred files; linear ones (OpenEXR, HDR, PFM) get none */
    bool has_display_tonemap;
    /* Kept in the file, for a message about parts that are missing: how to make a part. NULL: "" */
    const char *command;
} facet_part_desc;

/* ---- the file of a part ---- */

enum { FACET_PART_COMMAND_SIZE = 8192 };

typedef struct facet_part_info {
    uint32_t index, count;
    facet_part_split split;
    uint32_t width, height;              /* of the whole image, in pixels */
    uint32_t rectangle[4];               /* x, y, width, height of the part in it */
    uint32_t first_sample, sample_count; /* per pixel */
    facet_tonemap tonemap;
    bool has_display_tonemap;
    bool has_layers; /* layers beside the image */
    char settings
        [65]; /* hash of all that the image depends on, 64 hexadecimal digits: that of the other parts */
    char digest[17];  /* hash of the values */
    char version[32]; /* of facet */
    char machine[64]; /* instruction set of ray intersection, vendor of the processor */
    char command[FACET_PART_COMMAND_SIZE];
} facet_part_info;

/* Reads what a file says about itself, not its values. FACET_ERROR_READ; FACET_ERROR_INVALID: it is no part, or damaged. */
FACET_API facet_result facet_part_read_info(const char *path, facet_part_info *info, facet_error *error);

/* ---- merging ---- */

/* {0}: as the parts say. */
typedef struct facet_merge_desc {
    facet_allocator allocator;
    facet_log log; /* parts that are there twice, parts of processors of different vendors */
    facet_progress progress;
    uint32_t thread_count; /* 0: facet_thread_count() */
    bool has_tonemap;      /* tonemap replaces that of the parts */
    facet_tonemap tonemap;
} facet_merge_desc;

/* Merges parts, in any order, into the image that facet_render() returns without facet_render_desc.part. A part that is
 * there twice counts once. FACET_ERROR_ARGUMENT: parts are missing, or differ in settings, version, instruction set or
 * split; FACET_ERROR_INVALID: a file is damaged. */
FACET_API facet_result facet_part_merge(const char *const *paths, size_t path_count,
                                        const facet_merge_desc *desc, facet_image **image,
                                        facet_error *error);

#ifdef __cplusplus
}
#endif

#endif
