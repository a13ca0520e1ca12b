/* gltf_external.h - assets that a file refers to, while they are read. */
#ifndef IO_GLTF_EXTERNAL_H
#define IO_GLTF_EXTERNAL_H

#include "io/gltf/gltf_reader.h"

/* Of all files that a model consists of. */
typedef struct gltf_asset_state {
    uint32_t file_count; /* read so far */
    uint64_t work;       /* io_reader.work of all */
    bool is_fatal;       /* an error of an asset is one of the model: a cycle, or a limit */
} gltf_asset_state;

/* What an asset sees of the file that refers to it. */
struct gltf_outer {
    io_reader *reader;
    uint32_t file;  /* the asset in its files[], whose aliases hold */
    uint32_t depth; /* of the asset: 1, 2, .. */
    gltf_asset_state *state;
    bool has_default_scene; /* set by the asset's reader */
};

/* gltf.c: reads an asset. bytes must outlive the scene. folder: as in io_reader. */
facet_result gltf_load_asset(const uri_bytes *bytes, const char *path, const char *folder, uint64_t device,
                             uint64_t number, const facet_scene_desc *desc, gltf_outer *outer,
                             facet_scene **scene, facet_error *error);

#endif
