/* usdz_write.c - a scene as .usdz: the text of the scene, then its images. */
#include <stdio.h>
#include <string.h>

#include "base/result.h"
#include "image/image.h"
#include "io/file_set.h"
#include "io/image_kind.h"
#include "io/usd/usd.h"
#include "io/usd/usd_writer.h"
#include "io/usd/usdz_zip.h"

enum { PATH_SIZE = 32 };

/* An image as the archive has it. */
typedef struct archived {
    char path[PATH_SIZE];
    const unsigned char *bytes;
    size_t size;
    unsigned char *made; /* block of mem_alloc(); NULL: the bytes are the scene's */
} archived;

/* PNG and JPEG as they are, others as PNG. The path is "" where the image cannot be read. */
static facet_result archive_image(const facet_scene *scene, uint32_t index, const facet_log *log,
                                  archived *out, facet_error *error)
{
    const scene_image *source = &scene->images[index];
    const image_kind *kind = source->bytes ? image_kind_of_bytes(source->bytes, source->size) : NULL;
    const bool is_kept = kind && (kind->codec == IMAGE_CODEC_PNG || kind->codec == IMAGE_CODEC_JPEG);
    image decoded;
    char name[256];
    *out = (archived){.bytes = source->bytes, .size = source->size};
    if (!kind)
        return FACET_OK;
    snprintf(name, sizeof name, "image %u \"%s\"", index, source->name);
    if (!is_kept) {
        const image_decode_desc desc = {.allocator = scene->allocator,
                                        .thread_count = scene->thread_count,
                                        .max_size = scene->max_texture_size};
        const image_encode_desc encode = {.allocator = scene->allocator, .thread_count = scene->thread_count};
        facet_result result = image_decode(source->bytes, source->size, name, &desc, &decoded, error);
        if (result == FACET_OK) {
            result = image_encode(&decoded, IMAGE_CODEC_PNG, &encode, &out->made, &out->size, error);
            image_destroy(&decoded);
        }
        if (result != FACET_OK && result != FACET_ERROR_MEMORY)
            log_warning(log, "%s; it is left out", error->message);
        if (result != FACET_OK)
            return result == FACET_ERROR_MEMORY ? result : FACET_OK;
        out->bytes = out->made;
    }
    snprintf(out->path, sizeof out->path, "textures/image%u.%s", index,
             is_kept ? kind->file_extension : "png");
    return FACET_OK;
}

static void write_text(usd_writer *w, const char *generator)
{
    const facet_scene *s = w->scene;
    text_add(&w->out, "#usda 1.0\n(\n    customLayerData = {\n        string creator = \"");
    for (const char *c = generator; *c; c++)
        text_addf(&w->out, "%c", *c == '"' || *c == '\\' || (unsigned char)*c < 32 ? '_' : *c);
    text_addf(&w->out,
              "\"\n    }\n    defaultPrim = \"Root\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n"
              "    timeCodesPerSecond = %d\n    framesPerSecond = %d\n",
              (int)USD_FPS, (int)USD_FPS);
    if (s->animation_count) {
        text_add(&w->out, "    startTimeCode = ");
        usd_float(w, s->animations[0].begin_s * USD_FPS);
        text_add(&w->out, "\n    endTimeCode = ");
        usd_float(w, s->animations[0].end_s * USD_FPS);
        text_add(&w->out, "\n");
    }
    text_add(&w->out, ")\n\ndef Xform \"Root\"\n{\n");
    usd_write_materials(w);
    for (uint32_t i = 0; i < s->node_count; i++)
        if (!s->scene_count && s->nodes[i].parent == SCENE_NONE)
            usd_write_node(w, i);
    const scene_root *root =
        s->scene_count ? &s->scenes[s->default_scene == SCENE_NONE ? 0 : s->default_scene] : NULL;
    for (uint32_t i = 0; root && i < root->node_count; i++)
        usd_write_node(w, root->nodes[i]);
    text_add(&w->out, "}\n");
}

/* Motion that is not that of nodes in the first animation. */
static bool loses_motion(const facet_scene *s)
{
    for (uint32_t i = 0; s->animation_count && i < s->animations[0].channel_count; i++)
        if (s->animations[0].channels[i].kind != SCENE_TARGET_NODE)
            return true;
    return s->animation_count > 1;
}

static void warn_losses(const usd_writer *w, const char *path, const facet_log *log)
{
    static const char *const names[] = {"skins (meshes are in their bind pose)",
                                        "morph targets",
                                        "points and lines",
                                        "cameras",
                                        "lights",
                                        "material variants",
                                        "animation other than linear keys of nodes in the first animation",
                                        "material layers other than clearcoat",
                                        "vertex colors"};
    char list[512] = "";
    for (size_t i = 0, used = 0; i < sizeof names / sizeof *names; i++)
        if (w->losses >> i & 1)
            used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", used ? ", " : "", names[i]);
    if (w->losses)
        log_warning(log, "%s: lacks what facet does not write as USD: %s", path, list);
}

static facet_result write_file(const facet_scene *scene, const char *path, usdz_zip *zip,
                               const facet_scene_save_desc *desc, facet_error *error)
{
    if (!usdz_zip_finish(zip))
        return zip->files.has_failed || zip->directory.has_failed
                   ? fail_memory(error, path, zip->files.length)
                   : fail(error, FACET_ERROR_LIMIT, "%s: would be larger than 4 GiB", path);
    file_set set = file_set_begin(scene, path, desc);
    facet_result result = file_set_add(&set, NULL, zip->files.data, zip->files.length, error);
    if (result == FACET_OK)
        result = file_set_commit(&set, error);
    file_set_destroy(&set);
    return result;
}

facet_result usdz_save(const facet_scene *scene, const char *path, const char *generator,
                       const facet_scene_save_desc *desc, facet_error *error)
{
    const facet_scene_save_desc defaults = {0};
    facet_error own;
    error = error ? error : &own;
    desc = desc ? desc : &defaults;
    archived *images = mem_zalloc(&scene->allocator, (size_t)scene->image_count + 1, sizeof *images);
    const char **paths = mem_zalloc(&scene->allocator, (size_t)scene->image_count + 1, sizeof *paths);
    usd_writer w = {
        .scene = scene, .images = paths, .nodes = usd_nodes_create(scene), .out.allocator = scene->allocator};
    usdz_zip zip = {.files.allocator = scene->allocator, .directory.allocator = scene->allocator};
    facet_result result = images && paths && w.nodes
                              ? FACET_OK
                              : fail_memory(error, path,
                                            (size_t)scene->image_count * sizeof *images +
                                                (size_t)scene->node_count * sizeof *w.nodes);
    for (uint32_t i = 0; i < scene->image_count && result == FACET_OK; i++) {
        result = archive_image(scene, i, &desc->log, &images[i], error);
        paths[i] = images[i].path[0] ? images[i].path : NULL;
    }
    if (result == FACET_OK) {
        write_text(&w, generator);
        w.losses |= loses_motion(scene) ? USD_LOST_MOTION : 0u;
        w.losses |= scene->variant_count ? USD_LOST_VARIANTS : 0u;
        if (w.out.has_failed)
            result = fail_memory(error, path, w.out.length);
    }
    if (result == FACET_OK) {
        usdz_zip_add(&zip, "model.usda", w.out.data, w.out.length);
        for (uint32_t i = 0; i < scene->image_count; i++)
            if (paths[i])
                usdz_zip_add(&zip, paths[i], images[i].bytes, images[i].size);
        result = write_file(scene, path, &zip, desc, error);
    }
    if (result == FACET_OK)
        warn_losses(&w, path, &desc->log);
    for (uint32_t i = 0; images && i < scene->image_count; i++)
        mem_free(images[i].made);
    mem_free(images);
    mem_free(paths);
    mem_free(w.nodes);
    text_destroy(&w.out);
    text_destroy(&zip.files);
    text_destroy(&zip.directory);
    return result;
}
