/* gltf_textures.c - images, located but not decoded, and textures with their samplers (glTF 2.0 sections
 * 3.8, 5.18,
 * 5.29; KHR_texture_basisu, EXT_texture_astc, EXT_texture_webp, EXT_texture_avif, MSFT_texture_dds). A missing image is reported and
 * rendered white, as in other viewers. */
#include <string.h>

#include "image/ktx2.h"
#include "io/gltf/gltf_reader.h"
#include "io/image_kind.h"

/* ---- images ---- */

/* The MIME type in the file; NULL: none. The bytes decide. */
static const char *get_mime_type(io_reader *r, const json_place *at)
{
    const char *type = io_get_string(r, at, "mimeType", NULL);
    return io_leave_out(r, "the format is detected from the bytes") ? NULL : type;
}

static bool find_bytes(io_reader *r, const json_place *at, scene_image *out)
{
    const char *uri = io_get_string(r, at, "uri", NULL);
    uint32_t view = io_get_index(r, at, "bufferView", r->gltf->view_count, "buffer view");
    if (!io_is_ok(r))
        return false;
    const char *mime_type = get_mime_type(r, at);
    if (!uri && view == SCENE_NONE) {
        io_warn(r, at, NULL, "has neither a uri nor a bufferView; white is used");
        return false;
    }
    if (uri && view != SCENE_NONE)
        io_note(r, at, NULL, "has a bufferView beside the uri, which is used");
    if (view != SCENE_NONE && !mime_type)
        io_note(r, at, "mimeType", "is missing beside the bufferView");
    if (view != SCENE_NONE && r->gltf->views[view].stride)
        io_note(r, at, "bufferView", "has a byteStride, which means nothing for an image");
    if (!uri && !gltf_has_view_source(r, view)) {
        io_warn(r, at, "bufferView", "is in a buffer without bytes; white is used");
        return false;
    }
    if (uri) {
        uri_bytes bytes;
        if (!gltf_load_uri(r, uri, &bytes)) {
            if (bytes.result == FACET_ERROR_MEMORY)
                return io_fail(r, at, "uri", bytes.result, "%s", bytes.message);
            io_warn_each(r, at, "uri", "%s; white is used", bytes.message);
            return false;
        }
        out->bytes = bytes.data;
        out->size = bytes.size;
    } else {
        out->bytes = gltf_get_view_bytes(r, at, view);
        out->size = r->gltf->views[view].length;
    }
    return out->bytes != NULL;
}

/* The requirements of KHR_texture_basisu and EXT_texture_astc, and how deviations are handled. */
static void check_ktx2(io_reader *r, const json_place *at, const scene_image *i)
{
    ktx2 k;
    if (ktx2_open(i->bytes, i->size, "", &k, NULL) != FACET_OK)
        return; /* read_size() reports it */
    bool is_astc = k.format->kind == KTX2_ASTC && gltf_is_extension_listed(r, "EXT_texture_astc");
    if (!is_astc && k.format->kind != KTX2_ETC1S && k.format->decode != uastc_decode)
        io_note(r, at, NULL, "holds %s, where KHR_texture_basisu has ETC1S or UASTC", k.format->name);
    if (k.is_cube)
        io_warn(r, at, NULL, "is a cube; its first face is used");
    else if (k.is_array)
        io_warn(r, at, NULL, "is an array; its first layer is used");
    if (k.is_right_to_left || k.is_bottom_up)
        io_warn(r, at, NULL, "has a KTXorientation other than \"rd\"; it is flipped to that");
    if (memcmp(k.swizzle, "rgba", 4) != 0)
        io_warn(r, at, NULL, "has a KTXswizzle other than \"rgba\"; it is applied");
    if (k.is_premultiplied)
        io_warn(r, at, NULL, "has premultiplied alpha, which glTF does not define");
}

/* From the header of the image. If it cannot be read for the format of an extension, the image is unusable
 * and a texture uses its other source. */
static void read_size(io_reader *r, const json_place *at, const image_kind *kind, scene_image *out)
{
    image header;
    facet_error error;
    facet_result result = image_probe(out->bytes, out->size, "the image", &header, NULL, &error);
    if (result == FACET_OK) {
        out->width = header.width;
        out->height = header.height;
    } else if (result == FACET_ERROR_MEMORY) {
        io_fail(r, at, NULL, result, "%s", error.message);
    } else if (kind->gltf_extension || kind->is_converted) {
        io_warn_each(r, at, NULL, "%s", error.message);
    }
}

static void read_image(io_reader *r, const json_place *at, scene_image *out)
{
    const char *name = io_get_name(r, at);
    const char *uri = io_get_string(r, at, "uri", NULL);
    *out = (scene_image){.name = name, .mime_type = ""};
    if (uri && strncmp(uri, "data:", 5) != 0) {
        out->uri = arena_strdup(r->scene->arena, uri);
        if (!out->uri) {
            io_fail_memory(r, "image", strlen(uri));
            return;
        }
        if (name[0] == 0)
            out->name = out->uri;
    }
    if (!find_bytes(r, at, out)) {
        out->bytes = NULL;
        out->size = 0;
        return;
    }
    const image_kind *kind = image_kind_of_bytes(out->bytes, out->size);
    if (kind)
        out->mime_type = kind->mime_type;
    const char *said = json_string_value(json_object_get(at->value, "mimeType"));
    if (out->mime_type[0] == 0)
        io_warn(r, at, NULL, "is no " IMAGE_KINDS_TEXT " file; white is used");
    else if (said && strcmp(said, out->mime_type) != 0)
        io_note(r, at, "mimeType", "says \"%.40s\", but the image is %s", said, out->mime_type);
    if (!kind)
        return;
    if (kind->gltf_extension && !gltf_is_extension_listed(r, kind->gltf_extension))
        io_note(r, at, NULL, "is a %s file, which needs %s", kind->name, kind->gltf_extension);
    if (kind->is_converted && !kind->gltf_extension)
        io_note(r, at, NULL, "is a %s file, which glTF does not allow; it is read all the same", kind->name);
    if (kind->codec == IMAGE_CODEC_KTX2)
        check_ktx2(r, at, out);
    read_size(r, at, kind, out);
}

void gltf_read_images(io_reader *r, const json_place *root)
{
    json_place array = io_get_array(r, root, "images");
    size_t count = io_get_count(&array);
    r->scene->images = io_alloc(r, "images", count, sizeof *r->scene->images);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &array, i);
        scene_image *out = &r->scene->images[i];
        read_image(r, &at, out);
        if (io_leave_out(r, "white is used"))
            *out = (scene_image){.name = out->name ? out->name : "", .mime_type = "", .uri = out->uri};
        r->scene->image_count = (uint32_t)(i + 1);
    }
}

/* ---- samplers: the numbers are OpenGL's ---- */

static scene_wrap get_wrap(io_reader *r, const json_place *sampler, const char *key)
{
    uint64_t value = io_get_uint(r, sampler, key, UINT32_MAX, 10497);
    if (value == 33071)
        return SCENE_WRAP_CLAMP;
    if (value == 33648)
        return SCENE_WRAP_MIRROR;
    if (value != 10497)
        io_warn(r, sampler, key, "%llu is not one of 10497, 33071, 33648; textures repeat",
                (unsigned long long)value);
    return SCENE_WRAP_REPEAT;
}

void gltf_read_texture_sampler(io_reader *r, const json_place *sampler, scene_texture *out)
{
    out->wrap_u = get_wrap(r, sampler, "wrapS");
    out->wrap_v = get_wrap(r, sampler, "wrapT");
    uint64_t mag = io_get_uint(r, sampler, "magFilter", UINT32_MAX, 9729);
    uint64_t min = io_get_uint(r, sampler, "minFilter", UINT32_MAX, 9987);
    if (mag != 9728 && mag != 9729)
        io_warn(r, sampler, "magFilter", "%llu is neither 9728 nor 9729", (unsigned long long)mag);
    if (min != 9728 && min != 9729 && (min < 9984 || min > 9987)) {
        io_warn(r, sampler, "minFilter", "%llu is not a filter", (unsigned long long)min);
        min = 9987;
    }
    out->mag_filter = mag == 9728 ? SCENE_FILTER_NEAREST : SCENE_FILTER_LINEAR;
    out->min_filter = min == 9728 || min == 9984 || min == 9986 ? SCENE_FILTER_NEAREST : SCENE_FILTER_LINEAR;
    out->mip_filter = min < 9984 ? SCENE_MIP_NONE : min <= 9985 ? SCENE_MIP_NEAREST : SCENE_MIP_LINEAR;
}

/* ---- textures ---- */

static bool is_readable(const scene_image *source)
{
    return source->width > 0 || strcmp(source->mime_type, "image/png") == 0 ||
           strcmp(source->mime_type, "image/jpeg") == 0;
}

/* The source of an extension of a texture, or, name NULL, of the texture itself. */
static uint32_t get_source(io_reader *r, const json_place *at, const char *name)
{
    json_place extension = name ? io_get_extension(r, at, name) : *at;
    return io_get_index(r, &extension, "source", r->scene->image_count, "image");
}

/* The first readable source wins; extensions come before the fallback. */
static void find_source(io_reader *r, const json_place *at, scene_texture *out)
{
    static const char *const names[] = {
        "KHR_texture_basisu", "EXT_texture_astc", "EXT_texture_webp", "EXT_texture_avif", NULL,
        "MSFT_texture_dds"};
    bool has_source = false;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        uint32_t source = get_source(r, at, names[i]); /* all sources, so that each is checked */
        if (source == SCENE_NONE)
            continue;
        has_source = true;
        if (out->image == SCENE_NONE && is_readable(&r->scene->images[source]))
            out->image = source;
    }
    if (!io_is_ok(r) || out->image != SCENE_NONE)
        return;
    if (!has_source)
        io_warn(r, at, NULL, "has no source; white is used");
}

static void read_texture(io_reader *r, const json_place *root, const json_place *at, scene_texture *out)
{
    *out = (scene_texture){.name = io_get_name(r, at), .image = SCENE_NONE};
    json_place samplers = io_get_array(r, root, "samplers");
    json_place none = {0};
    uint32_t sampler = io_get_index(r, at, "sampler", (uint32_t)io_get_count(&samplers), "sampler");
    json_place element = sampler == SCENE_NONE ? none : io_get_element_object(r, &samplers, sampler);
    gltf_read_texture_sampler(r, &element, out);
    if (io_leave_out(r, "the texture has the default sampler"))
        gltf_read_texture_sampler(r, &none, out);
    find_source(r, at, out);
    if (io_leave_out(r, "white is used"))
        out->image = SCENE_NONE;
}

void gltf_read_textures(io_reader *r, const json_place *root)
{
    json_place array = io_get_array(r, root, "textures");
    size_t count = io_get_count(&array);
    io_get_array(r, root, "samplers"); /* checked even if unused */
    io_leave_out(r, "textures have the default sampler");
    r->scene->textures = io_alloc(r, "textures", count, sizeof *r->scene->textures);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &array, i);
        read_texture(r, root, &at, &r->scene->textures[i]);
        r->scene->texture_count = (uint32_t)(i + 1);
    }
}
