/* model_needs.c - see model_needs.h. */
#include "io/model_needs.h"

#include <string.h>

#include "base/result.h"
#include "image/ktx2.h"
#include "io/file_source.h"
#include "io/gltf/gltf.h"
#include "io/model_kind.h"

const char *model_need_name(model_need need)
{
    switch (need) {
    case MODEL_NEED_DRACO:
        return "draco";
    case MODEL_NEED_WEBP:
        return "webp";
    case MODEL_NEED_AVIF:
        return "avif";
    case MODEL_NEED_EXR:
        return "exr";
    case MODEL_NEED_ZSTD:
        return "zstd";
    default:
        return "";
    }
}

unsigned model_needs_of_image(const void *bytes, size_t size)
{
    switch (image_codec_detect(bytes, size)) {
    case IMAGE_CODEC_WEBP:
        return MODEL_NEED_WEBP;
    case IMAGE_CODEC_AVIF:
        return MODEL_NEED_AVIF;
    case IMAGE_CODEC_EXR:
        return MODEL_NEED_EXR;
    case IMAGE_CODEC_KTX2: {
        ktx2 k;
        return ktx2_open(bytes, size, "", &k, NULL) == FACET_OK && k.scheme == KTX2_ZSTD ? MODEL_NEED_ZSTD
                                                                                         : 0;
    }
    default:
        return 0;
    }
}

unsigned model_needs_of_scene(const facet_scene *scene)
{
    unsigned needs = 0;
    for (uint32_t i = 0; i < scene->extension_count; i++)
        if (strcmp(scene->extensions[i].name, "KHR_draco_mesh_compression") == 0)
            needs |= MODEL_NEED_DRACO;
    for (uint32_t i = 0; i < scene->image_count; i++)
        if (scene->images[i].bytes)
            needs |= model_needs_of_image(scene->images[i].bytes, scene->images[i].size);
    return needs;
}

facet_result model_needs_of_file(const char *path, const facet_scene_desc *desc, unsigned *needs,
                                 facet_error *error)
{
    const facet_scene_desc silent = {.allocator = desc->allocator,
                                     .max_file_bytes = desc->max_file_bytes,
                                     .root = desc->root,
                                     .files = desc->files};
    facet_scene *scene;
    file_bytes file = {0};
    *needs = 0;
    TRY(model_file_open(path, desc, &file, error));
    const bool is_gltf = model_kind_detect(file.data, file.size, path) == MODEL_GLTF;
    *needs = model_needs_of_image(file.data, file.size);
    file_close(&file);
    if (!is_gltf)
        return FACET_OK;
    TRY(gltf_load_images(path, &silent, &scene, error));
    *needs = model_needs_of_scene(scene);
    scene_destroy(scene);
    return FACET_OK;
}
