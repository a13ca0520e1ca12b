/* texture_set.h - what texture_set.c builds and texture_sample.c reads. */
#ifndef DRAW_TEXTURE_SET_H
#define DRAW_TEXTURE_SET_H

#include "draw/texture.h"
#include "draw/texture_store.h"

/* A texture of the scene: its sampler, and its image in the ways in which it is read (NULL: white). */
typedef struct texture_binding {
    const texture_pyramid *color, *data;
    scene_wrap wrap_u, wrap_v;
    scene_filter mag_filter, min_filter;
    scene_mip_filter mip_filter;
} texture_binding;

struct texture_set {
    uint32_t binding_count, image_count;
    texture_binding *bindings; /* one per scene texture */
    /* two per scene image: color, data; level_count 0: missing. The store owns the texels */
    texture_pyramid *pyramids;
    texture_store *own_store; /* NULL: not owned */
    uint64_t decoded_texels;
};

/* texture_set_create() from a store of the same scene, which must outlive the set; one set at a time. */
facet_result texture_set_create_from(texture_store *store, const facet_scene *scene, const texture_use *uses,
                                     const facet_allocator *allocator, const facet_log *log,
                                     uint32_t thread_count, texture_set **out, facet_error *error);

#endif
