/* gltf_textures.c - images, found but not decoded, and textures with their samplers (glTF 2.0 sections 3.8, 5.18,
 * 5.29). A picture that cannot be had costs a warning and is white, as viewers do it. */
#include <string.h>

#include "image/image.h"
#include "io/gltf_reader.h"

/* ---- images ---- */

/* What facet can decode, and "image/ktx2" to be able to say what it is. */
static const char *mime_type_of(image_codec codec)
{
    switch (codec) {
    case IMAGE_CODEC_PNG:
        return "image/png";
    case IMAGE_CODEC_JPEG:
        return "image/jpeg";
    case IMAGE_CODEC_WEBP:
        return "image/webp";
    case IMAGE_CODEC_KTX2:
        return "image/ktx2";
    default:
        return "";
    }
}

static bool find_bytes(reader *r, const json_place *at, scene_image *out)
{
    const char *uri = get_string(r, at, "uri", NULL);
    uint32_t view = get_index(r, at, "bufferView", r->view_count, "buffer view");
    const char *mime_type = get_string(r, at, "mimeType", NULL);
    if (!reader_is_ok(r))
        return false;
    if ((uri != NULL) == (view != SCENE_NONE)) {
        reader_warn(r, at, NULL, "must have either a uri or a bufferView");
        if (!uri)
            return false;
    }
    if (view != SCENE_NONE && !mime_type)
        reader_warn(r, at, "mimeType", "is missing beside the bufferView");
    if (view != SCENE_NONE && r->views[view].stride)
        reader_warn(r, at, "bufferView", "has a byteStride, which means nothing for an image");
    if (!uri && !has_view_source(r, view)) {
        reader_warn(r, at, "bufferView", "is in a buffer without bytes; white is used");
        return false;
    }
    if (uri) {
        uri_bytes bytes;
        if (!load_uri(r, uri, &bytes)) {
            if (bytes.result == FACET_ERROR_MEMORY)
                return reader_fail(r, at, "uri", bytes.result, "%s", bytes.message);
            reader_warn(r, at, "uri", "%s; white is used", bytes.message);
            return false;
        }
        out->bytes = bytes.data;
        out->size = bytes.size;
    } else {
        out->bytes = get_view_bytes(r, at, view);
        out->size = r->views[view].length;
    }
    return out->bytes != NULL;
}

static void read_image(reader *r, const json_place *at, scene_image *out)
{
    const char *name = get_name(r, at);
    const char *uri = get_string(r, at, "uri", NULL);
    *out = (scene_image){.name = name, .mime_type = ""};
    if (name[0] == 0 && uri && strncmp(uri, "data:", 5) != 0) {
        out->name = arena_strdup(r->scene->arena, uri);
        if (!out->name) {
            reader_fail_memory(r, "image", strlen(uri));
            return;
        }
    }
    if (!find_bytes(r, at, out)) {
        out->bytes = NULL;
        out->size = 0;
        return;
    }
    image_codec codec = image_codec_detect(out->bytes, out->size);
    out->mime_type = mime_type_of(codec);
    const char *said = get_string(r, at, "mimeType", NULL);
    if (out->mime_type[0] == 0)
        reader_warn(r, at, NULL, "is no PNG, JPEG or WebP file; white is used");
    else if (said && strcmp(said, out->mime_type) != 0)
        reader_warn(r, at, "mimeType", "says \"%.40s\", but the image is %s", said, out->mime_type);
    if (codec == IMAGE_CODEC_WEBP && !is_extension_listed(r, "EXT_texture_webp"))
        reader_warn(r, at, NULL, "is a WebP file, which needs EXT_texture_webp");
    image header;
    if (out->mime_type[0] && codec != IMAGE_CODEC_KTX2 &&
        image_probe(out->bytes, out->size, out->name, &header, &codec, NULL) == FACET_OK) {
        out->width = header.width;
        out->height = header.height;
    }
}

void read_images(reader *r, const json_place *root)
{
    json_place array = get_array(r, root, "images");
    size_t count = get_count(&array);
    r->scene->images = reader_alloc(r, "images", count, sizeof *r->scene->images);
    for (size_t i = 0; i < count && reader_is_ok(r); i++) {
        json_place at = get_element_object(r, &array, i);
        read_image(r, &at, &r->scene->images[i]);
        r->scene->image_count = (uint32_t)(i + 1);
    }
}

/* ---- samplers: the numbers are OpenGL's ---- */

static scene_wrap get_wrap(reader *r, const json_place *sampler, const char *key)
{
    uint64_t value = get_uint(r, sampler, key, UINT32_MAX, 10497);
    if (value == 33071)
        return SCENE_WRAP_CLAMP;
    if (value == 33648)
        return SCENE_WRAP_MIRROR;
    if (value != 10497)
        reader_warn(r, sampler, key, "%llu is none of 10497, 33071, 33648; textures repeat",
                    (unsigned long long)value);
    return SCENE_WRAP_REPEAT;
}

static void read_sampler(reader *r, const json_place *sampler, scene_texture *out)
{
    out->wrap_u = get_wrap(r, sampler, "wrapS");
    out->wrap_v = get_wrap(r, sampler, "wrapT");
    uint64_t mag = get_uint(r, sampler, "magFilter", UINT32_MAX, 9729);
    uint64_t min = get_uint(r, sampler, "minFilter", UINT32_MAX, 9987);
    if (mag != 9728 && mag != 9729)
        reader_warn(r, sampler, "magFilter", "%llu is neither 9728 nor 9729", (unsigned long long)mag);
    if (min != 9728 && min != 9729 && (min < 9984 || min > 9987)) {
        reader_warn(r, sampler, "minFilter", "%llu is no filter", (unsigned long long)min);
        min = 9987;
    }
    out->mag_filter = mag == 9728 ? SCENE_FILTER_NEAREST : SCENE_FILTER_LINEAR;
    out->min_filter = min == 9728 || min == 9984 || min == 9986 ? SCENE_FILTER_NEAREST : SCENE_FILTER_LINEAR;
    out->mip_filter = min < 9984 ? SCENE_MIP_NONE : min <= 9985 ? SCENE_MIP_NEAREST : SCENE_MIP_LINEAR;
}

/* ---- textures ---- */

static bool is_readable(const scene_image *source)
{
    return source->bytes && source->mime_type[0] && strcmp(source->mime_type, "image/ktx2") != 0;
}

static void read_texture(reader *r, const json_place *root, const json_place *at, scene_texture *out)
{
    *out = (scene_texture){.name = get_name(r, at), .image = SCENE_NONE};
    json_place samplers = get_array(r, root, "samplers");
    json_place none = {0};
    uint32_t sampler = get_index(r, at, "sampler", (uint32_t)get_count(&samplers), "sampler");
    json_place element = sampler == SCENE_NONE ? none : get_element_object(r, &samplers, sampler);
    read_sampler(r, &element, out);

    /* The first source that can be read wins, the extension's before the fallback. */
    json_place webp = get_extension(r, at, "EXT_texture_webp");
    json_place basisu = get_extension(r, at, "KHR_texture_basisu");
    uint32_t sources[3] = {get_index(r, &webp, "source", r->scene->image_count, "image"),
                           get_index(r, at, "source", r->scene->image_count, "image"),
                           get_index(r, &basisu, "source", r->scene->image_count, "image")};
    bool has_source = false;
    bool has_ktx2 = false;
    for (int i = 0; i < 3 && out->image == SCENE_NONE; i++) {
        if (sources[i] == SCENE_NONE)
            continue;
        const scene_image *source = &r->scene->images[sources[i]];
        has_source = true;
        has_ktx2 |= strcmp(source->mime_type, "image/ktx2") == 0;
        if (is_readable(source))
            out->image = sources[i];
    }
    if (!reader_is_ok(r) || out->image != SCENE_NONE)
        return;
    if (has_ktx2)
        reader_warn(r, at, NULL, "has only a KTX2 image, which is not read yet; white is used");
    else if (!has_source)
        reader_warn(r, at, NULL, "has no source; white is used");
}

void read_textures(reader *r, const json_place *root)
{
    json_place array = get_array(r, root, "textures");
    size_t count = get_count(&array);
    get_array(r, root, "samplers"); /* checked even where nothing uses it */
    r->scene->textures = reader_alloc(r, "textures", count, sizeof *r->scene->textures);
    for (size_t i = 0; i < count && reader_is_ok(r); i++) {
        json_place at = get_element_object(r, &array, i);
        read_texture(r, root, &at, &r->scene->textures[i]);
        r->scene->texture_count = (uint32_t)(i + 1);
    }
}
