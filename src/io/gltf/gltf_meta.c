/* gltf_meta.c - what a file says beside what is drawn: extras of any object, and packets of XMP (KHR_xmp_json_ld and
 * its forerunner KHR_xmp). Kept as JSON text, so that who reads the scene needs no parser of JSON. */
#include <stdlib.h>

#include "io/gltf/gltf_reader.h"

static const char *const METADATA[] = {"KHR_xmp_json_ld", "KHR_xmp"};

/* ---- text ---- */

/* With 15 digits 0.1 is 0.1; where those are not enough to come back to the same value, with all 17. */
static size_t choose_format(const json_t *value)
{
    const size_t plain = JSON_COMPACT | JSON_ENCODE_ANY;
    const size_t exact = plain | JSON_REAL_PRECISION(17);
    char *text = json_dumps(value, plain | JSON_REAL_PRECISION(15));
    json_t *back = text ? json_loads(text, JSON_DECODE_ANY | JSON_ALLOW_NUL, NULL) : NULL;
    bool is_same = back && json_equal(value, back);
    json_decref(back);
    free(text);
    return is_same ? plain | JSON_REAL_PRECISION(15) : exact;
}

/* A value as text in the scene, members in the order of the file; NULL: an error is recorded. */
static const char *keep_text(io_reader *r, const json_t *value)
{
    size_t format = choose_format(value);
    size_t size = json_dumpb(value, NULL, 0, format);
    char *text = io_alloc_raw(r, "metadata", size + 1, 1);
    if (!text)
        return NULL;
    if (size == 0 || json_dumpb(value, text, size, format) != size) { /* jansson had no memory */
        io_fail_memory(r, "metadata", size);
        return NULL;
    }
    text[size] = 0;
    return text;
}

/* ---- objects ---- */

/* Other objects name a packet of the root by its number; a wrong one harms nobody who draws. */
static void check_packet(io_reader *r, const json_place *extension)
{
    const json_place root = {.value = r->json};
    json_place packets = io_get_extension(r, &root, extension->key);
    json_place list = io_get_array(r, &packets, "packets");
    const json_t *packet = json_object_get(extension->value, "packet");
    json_int_t index = json_is_integer(packet) ? json_integer_value(packet) : -1;
    if (packet && (index < 0 || (uint64_t)index >= io_get_count(&list)))
        io_note(r, extension, "packet", "is the number of no packet");
}

scene_meta gltf_get_meta(io_reader *r, const json_place *object)
{
    scene_meta out = {0};
    if (!io_is_ok(r) || !object->value)
        return out;
    const json_t *extras = json_object_get(object->value, "extras");
    if (extras)
        out.extras = keep_text(r, extras);
    json_t *kept = NULL;
    for (size_t i = 0; i < sizeof METADATA / sizeof *METADATA && io_is_ok(r); i++) {
        json_place at = io_get_extension(r, object, METADATA[i]);
        if (!at.value)
            continue;
        check_packet(r, &at);
        kept = kept ? kept : json_object();
        if (!kept || json_object_set(kept, METADATA[i], (json_t *)(uintptr_t)at.value) != 0)
            io_fail_memory(r, "metadata", 0);
    }
    if (kept && io_is_ok(r))
        out.extensions = keep_text(r, kept);
    json_decref(kept);
    return out;
}

void gltf_read_meta(io_reader *r, const json_place *root)
{
    facet_scene *scene = r->scene;
    json_place asset = io_get_object(r, root, "asset");
    json_place images = io_get_array(r, root, "images");
    json_place textures = io_get_array(r, root, "textures");
    scene->meta = gltf_get_meta(r, root);
    scene->asset_meta = gltf_get_meta(r, &asset);
    for (uint32_t i = 0; i < scene->image_count && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &images, i);
        scene->images[i].meta = gltf_get_meta(r, &at);
    }
    for (uint32_t i = 0; i < scene->texture_count && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &textures, i);
        scene->textures[i].meta = gltf_get_meta(r, &at);
    }
}
