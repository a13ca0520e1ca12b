/* gltf_write_materials.c - writes images, unchanged or as PNG where glTF has no such format, textures with
 * their samplers, and materials by the table that the reader uses. */
#include <string.h>

#include "base/result.h"
#include "io/gltf/gltf_writer.h"
#include "io/image_kind.h"
#include "scene/material_table.h"

/* ---- images ---- */

/* NULL: an image that could not be read. */
static const image_kind *kind_of(const scene_image *source)
{
    return source->bytes ? image_kind_of_mime_type(source->mime_type) : NULL;
}

/* One white texel as a PNG file, which replaces images that could not be read. */
static const unsigned char WHITE[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00,
    0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x00, 0x00, 0x00, 0x00, 0x3a, 0x7e, 0x9b, 0x55, 0x00,
    0x00, 0x00, 0x0a, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0xf8, 0x0f, 0x00, 0x01, 0x01, 0x01, 0x00,
    0x1c, 0xb0, 0x8c, 0x99, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

/* Takes ownership of made, which is NULL if the bytes belong to the scene. */
static void add_file(gltf_writer *w, json_t *object, uint32_t index, const char *extension,
                     const unsigned char *bytes, size_t size, unsigned char *made)
{
    char number[48];
    snprintf(number, sizeof number, "_image%u.%s", index, extension);
    size_t length = strlen(w->stem) + strlen(number) + 1;
    char *name = mem_alloc(w->allocator, length, 1);
    if (!name || !mem_reserve(w->allocator, (void **)&w->files, &w->file_capacity, w->file_count + 1,
                              sizeof *w->files)) {
        mem_free(name);
        mem_free(made);
        gltf_writer_fail_memory(w, length);
        return;
    }
    snprintf(name, length, "%s%s", w->stem, number);
    w->files[w->file_count++] = (gltf_written_file){.name = name, .bytes = bytes, .size = size, .made = made};
    gltf_put_uri(w, object, name);
}

/* An image as a PNG file in a block of mem_alloc(). NULL: it cannot be read, which is reported, or no
 * memory. */
static unsigned char *convert_to_png(gltf_writer *w, uint32_t index, size_t *size)
{
    const scene_image *source = &w->scene->images[index];
    image decoded;
    unsigned char *bytes = NULL;
    facet_error error;
    char name[256];
    snprintf(name, sizeof name, "image %u \"%s\"", index, source->name);
    const image_decode_desc desc = {
        .allocator = *w->allocator, .thread_count = w->thread_count, .max_size = w->scene->max_texture_size};
    facet_result result = image_decode(source->bytes, source->size, name, &desc, &decoded, &error);
    if (result == FACET_OK)
        result =
            image_encode(&decoded, IMAGE_CODEC_PNG,
                         &(image_encode_desc){.allocator = *w->allocator, .thread_count = w->thread_count},
                         &bytes, size, &error);
    image_destroy(&decoded);
    if (result == FACET_ERROR_MEMORY)
        gltf_writer_fail_memory(w, source->size);
    else if (result != FACET_OK)
        log_warning(w->log, "%s; it is written as white", error.message);
    return result == FACET_OK ? bytes : NULL;
}

void gltf_write_images(gltf_writer *w)
{
    const facet_scene *scene = w->scene;
    const image_kind *png = image_kind_of_bytes(WHITE, sizeof WHITE);
    for (uint32_t i = 0; i < scene->image_count; i++) {
        const scene_image *source = &scene->images[i];
        const image_kind *kind = kind_of(source);
        const unsigned char *bytes = source->bytes;
        size_t size = source->size;
        unsigned char *made = NULL;
        if (kind && kind->is_converted) {
            bytes = made = convert_to_png(w, i, &size);
            kind = made ? png : NULL;
        }
        if (!kind) {
            bytes = WHITE;
            size = sizeof WHITE;
            kind = png;
        }
        json_t *out = json_object();
        gltf_put_name(w, out, source->name);
        if (w->stem) {
            add_file(w, out, i, kind->file_extension, bytes, size, made);
        } else {
            gltf_put(w, out, "bufferView", json_integer(gltf_write_view(w, bytes, size, WRITE_NO_TARGET)));
            gltf_put(w, out, "mimeType", json_string(kind->mime_type));
            mem_free(made);
        }
        gltf_put_meta(w, out, &source->meta);
        gltf_append(w, gltf_put_array(w, w->root, "images"), out);
    }
}

/* ---- samplers: the numbers are OpenGL's ---- */

static int wrap_number(scene_wrap wrap)
{
    return wrap == SCENE_WRAP_CLAMP ? 33071 : wrap == SCENE_WRAP_MIRROR ? 33648 : 10497;
}

static int min_filter_number(const scene_texture *t)
{
    bool is_nearest = t->min_filter == SCENE_FILTER_NEAREST;
    switch (t->mip_filter) {
    case SCENE_MIP_NONE:
        return is_nearest ? 9728 : 9729;
    case SCENE_MIP_NEAREST:
        return is_nearest ? 9984 : 9985;
    case SCENE_MIP_LINEAR:
        break;
    }
    return is_nearest ? 9986 : 9987;
}

/* NULL: no memory */
static json_t *new_sampler(gltf_writer *w, const scene_texture *t)
{
    json_t *sampler = json_object();
    gltf_put(w, sampler, "magFilter", json_integer(t->mag_filter == SCENE_FILTER_NEAREST ? 9728 : 9729));
    gltf_put(w, sampler, "minFilter", json_integer(min_filter_number(t)));
    gltf_put(w, sampler, "wrapS", json_integer(wrap_number(t->wrap_u)));
    gltf_put(w, sampler, "wrapT", json_integer(wrap_number(t->wrap_v)));
    return sampler;
}

static uint32_t write_sampler(gltf_writer *w, const scene_texture *t)
{
    json_t *sampler = new_sampler(w, t);
    json_t *samplers = gltf_put_array(w, w->root, "samplers");
    for (size_t i = 0; i < json_array_size(samplers); i++)
        if (json_equal(json_array_get(samplers, i), sampler)) {
            json_decref(sampler);
            return (uint32_t)i;
        }
    gltf_append(w, samplers, sampler);
    return (uint32_t)json_array_size(samplers) - 1;
}

/* ---- textures ---- */

void gltf_write_textures(gltf_writer *w)
{
    const facet_scene *scene = w->scene;
    for (uint32_t i = 0; i < scene->texture_count; i++) {
        const scene_texture *texture = &scene->textures[i];
        json_t *out = json_object();
        gltf_put_name(w, out, texture->name);
        gltf_put(w, out, "sampler", json_integer(write_sampler(w, texture)));
        const image_kind *kind =
            texture->image == SCENE_NONE ? NULL : kind_of(&scene->images[texture->image]);
        if (kind && kind->gltf_extension && !kind->is_converted) {
            json_t *extension = gltf_put_extension(w, out, kind->gltf_extension);
            gltf_put_index(w, extension, "source", texture->image);
            gltf_require_extension(w, kind->gltf_extension);
        } else {
            gltf_put_index(w, out, "source", texture->image);
        }
        gltf_put_meta(w, out, &texture->meta);
        gltf_append(w, gltf_put_array(w, w->root, "textures"), out);
    }
}

/* ---- materials ---- */

/* The JSON object of a table row; borrowed. */
static json_t *object_of(gltf_writer *w, json_t *material, const char *name, uint32_t extension)
{
    if (name[0] == 0)
        return material;
    return extension ? gltf_put_extension(w, material, name) : gltf_put_object(w, material, name);
}

/* pbrSpecularGlossiness replaces pbrMetallicRoughness and shares members with it: whether a row applies to
 * the material. */
static bool is_of_kind(const scene_material *m, uint32_t extension, const char *object)
{
    if (extension == SCENE_SPECULAR_GLOSSINESS)
        return (m->extensions & SCENE_SPECULAR_GLOSSINESS) != 0;
    if (m->extensions & SCENE_SPECULAR_GLOSSINESS)
        return strcmp(object, "pbrMetallicRoughness") != 0 && extension != SCENE_SPECULAR;
    return true;
}

/* Replaces the index of the texture by the file name of its image, its sampler and its name. */
static void put_named_texture(gltf_writer *w, json_t *info, uint32_t texture)
{
    const scene_texture *t = &w->scene->textures[texture];
    const char *file = t->image == SCENE_NONE || !w->image_names ? NULL : w->image_names[t->image];
    gltf_put(w, info, "image", file ? gltf_json_text(w, file) : json_null());
    gltf_put(w, info, "sampler", new_sampler(w, t));
    gltf_put_name(w, info, t->name);
}

static json_t *new_texture_info(gltf_writer *w, const scene_texture_ref *ref)
{
    json_t *info = json_object();
    if (w->names_images)
        put_named_texture(w, info, ref->texture);
    else
        gltf_put_index(w, info, "index", ref->texture);
    if (ref->texcoord)
        gltf_put(w, info, "texCoord", json_integer(ref->texcoord));
    const float one[2] = {1, 1};
    bool is_moved = ref->offset[0] != 0.0f || ref->offset[1] != 0.0f || ref->rotation_rad != 0.0f ||
                    ref->scale[0] != 1.0f || ref->scale[1] != 1.0f;
    if (is_moved) {
        json_t *transform = gltf_put_extension(w, info, "KHR_texture_transform");
        gltf_put_floats(w, transform, "offset", ref->offset, NULL, 2);
        gltf_put_float(w, transform, "rotation", ref->rotation_rad, 0.0f);
        gltf_put_floats(w, transform, "scale", ref->scale, one, 2);
    }
    return info;
}

static void write_texture_infos(gltf_writer *w, json_t *out, const scene_material *m)
{
    for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++) {
        const material_texture *row = &material_textures[slot];
        const scene_texture_ref *ref = &m->textures[slot];
        const char *key = row->key;
        const char *object = row->object;
        uint32_t extension = row->extension;
        if (ref->texture == SCENE_NONE)
            continue;
        if (slot == SCENE_BASE_COLOR_TEXTURE && m->extensions & SCENE_SPECULAR_GLOSSINESS) {
            object = material_textures[SCENE_SPECULAR_GLOSSINESS_TEXTURE].object;
            extension = SCENE_SPECULAR_GLOSSINESS;
            key = "diffuseTexture";
        } else if (!is_of_kind(m, extension, object) || (extension && !(m->extensions & extension))) {
            continue;
        }
        gltf_put(w, object_of(w, out, object, extension), key, new_texture_info(w, ref));
    }
}

static void write_parameters(gltf_writer *w, json_t *out, const scene_material *m)
{
    scene_material defaults = scene_material_default();
    for (int i = 0; i < MATERIAL_PARAMETER_COUNT; i++) {
        const material_parameter *row = &material_parameters[i];
        const float *values = material_floats_const(m, row);
        if (!is_of_kind(m, row->extension, row->object) ||
            (row->extension && !(m->extensions & row->extension)) ||
            memcmp(values, material_floats_const(&defaults, row), row->count * sizeof *values) == 0)
            continue;
        json_t *object = object_of(w, out, row->object, row->extension);
        if (row->texture) /* a member of the textureInfo, which exists or is irrelevant */
            object = json_object_get(object, row->texture);
        if (object)
            gltf_put_floats(w, object, row->key, values, material_floats_const(&defaults, row), row->count);
    }
}

json_t *gltf_new_material(gltf_writer *w, const scene_material *m)
{
    static const char *const alpha_modes[] = {"OPAQUE", "MASK", "BLEND"};
    json_t *out = json_object();
    gltf_put_name(w, out, m->name);
    for (int i = 0; i < MATERIAL_EXTENSION_COUNT; i++)
        if (m->extensions & material_extensions[i].bit)
            gltf_put_extension(w, out, material_extensions[i].name);
    write_texture_infos(w, out, m);
    write_parameters(w, out, m);
    if (m->alpha_mode != SCENE_ALPHA_OPAQUE)
        gltf_put(w, out, "alphaMode", json_string(alpha_modes[m->alpha_mode]));
    if (m->alpha_mode != SCENE_ALPHA_MASK)
        json_object_del(out, "alphaCutoff");
    if (m->is_double_sided)
        gltf_put(w, out, "doubleSided", json_true());
    gltf_put_meta(w, out, &m->meta);
    return out;
}

void gltf_write_materials(gltf_writer *w)
{
    for (uint32_t i = 0; i < w->scene->material_count; i++)
        gltf_append(w, gltf_put_array(w, w->root, "materials"),
                    gltf_new_material(w, &w->scene->materials[i]));
}
