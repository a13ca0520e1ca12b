/* texture_bench_state.h - what texture_bench.c and texture_relief.c share. */
#ifndef LEGACY_TEXTURE_BENCH_STATE_H
#define LEGACY_TEXTURE_BENCH_STATE_H

#include "image/image.h"
#include "legacy/texture_bench.h"
#include "legacy/texture_texels.h"

/* A texture that is not in the scene yet. */
typedef struct made_texture {
    const char *name;     /* in the scene's arena */
    uint32_t like;        /* the texture whose sampler it has */
    unsigned char *bytes; /* a PNG file */
    size_t byte_count;
    uint32_t width, height;
    void *key; /* of what it was made */
    size_t key_size;
} made_texture;

struct texture_bench {
    facet_scene *scene;
    srgb_tables srgb;
    texels_cache *cache;
    uint32_t image_count;            /* of the scene, before anything is made */
    texture_statistics **statistics; /* per image; NULL: not looked at */
    made_texture *made;
    uint32_t made_count, shared_count;
    size_t made_capacity;
};

/* The texture that was made of the same; SCENE_NONE: none. */
uint32_t bench_find(texture_bench *bench, const void *key, size_t size);
/* Encodes a picture and keeps it; takes over key where it succeeds. */
facet_result bench_keep(texture_bench *bench, const struct image *picture, const char *name, uint32_t like,
                        void *key, size_t key_size, uint32_t *texture, facet_error *error);

#endif
