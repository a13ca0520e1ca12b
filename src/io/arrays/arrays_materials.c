/* arrays_materials.c - materials and textures. Pixels become TGA files in memory, uncompressed, so that renderers, writers and
 * inspection find images as those of any file. */
#include <math.h>
#include <string.h>

#include "io/arrays/arrays.h"
#include "io/arrays/arrays_reader.h"
#include "io/image_kind.h"
#include "scene/material_table.h"

/* ---- materials ---- */

/* Floats that facet_material and scene_material share, by name. Extension and range are in scene/material_table.h. */
typedef struct material_member {
    const char *name;
    size_t from, to, count;
} material_member;

#define MEMBER(member)                                                                                       \
    {                                                                                                        \
#member, offsetof(facet_material, member), offsetof(scene_material, member),                         \
            sizeof(((facet_material *)0)->member) / sizeof(float)                                            \
    }

static const material_member MEMBERS[] = {
    MEMBER(base_color),
    MEMBER(metallic),
    MEMBER(perceptual_roughness),
    MEMBER(normal_scale),
    MEMBER(occlusion_strength),
    MEMBER(emissive),
    MEMBER(emissive_strength),
    MEMBER(alpha_cutoff),
    MEMBER(ior),
    MEMBER(specular),
    MEMBER(specular_color),
    MEMBER(glossiness),
    MEMBER(clearcoat),
    MEMBER(clearcoat_roughness),
    MEMBER(clearcoat_normal_scale),
    MEMBER(sheen_color),
    MEMBER(sheen_roughness),
    MEMBER(transmission),
    MEMBER(thickness),
    MEMBER(attenuation_distance),
    MEMBER(attenuation_color),
    MEMBER(iridescence),
    MEMBER(iridescence_ior),
    MEMBER(iridescence_thickness_minimum),
    MEMBER(iridescence_thickness_maximum),
    MEMBER(anisotropy),
    MEMBER(anisotropy_rotation),
    MEMBER(dispersion),
    MEMBER(diffuse_transmission),
    MEMBER(diffuse_transmission_color),
    MEMBER(multiscatter_color),
    MEMBER(scatter_anisotropy),
    MEMBER(diffuse_roughness),
};
enum { MEMBER_COUNT = sizeof MEMBERS / sizeof *MEMBERS };

facet_material arrays_material_default(void)
{
    const scene_material defaults = scene_material_default();
    facet_material m = {.name = NULL};
    for (int i = 0; i < MEMBER_COUNT; i++)
        memcpy((char *)&m + MEMBERS[i].from, (const char *)&defaults + MEMBERS[i].to,
               MEMBERS[i].count * sizeof(float));
    return m;
}

/* The row of a member; base_color and specular_color have two. NULL: none (glossiness of metallic-roughness). */
static const material_parameter *find_row(const material_member *member, bool is_specular_glossiness)
{
    const material_parameter *found = NULL;
    for (int i = 0; i < MATERIAL_PARAMETER_COUNT; i++) {
        const material_parameter *row = &material_parameters[i];
        bool is_of_glossiness = row->extension == SCENE_SPECULAR_GLOSSINESS;
        if (row->offset == member->to && (!found || is_of_glossiness == is_specular_glossiness))
            found = row;
    }
    return found;
}

static void read_member(io_reader *r, const json_place *at, const material_member *member,
                        const facet_material *in, scene_material *out)
{
    const scene_material defaults = scene_material_default();
    const float *values = (const float *)(const void *)((const char *)in + member->from);
    const float *unset = (const float *)(const void *)((const char *)&defaults + member->to);
    const material_parameter *row = find_row(member, in->is_specular_glossiness);
    for (size_t i = 0; i < member->count; i++) {
        bool is_infinite_distance =
            member->to == offsetof(scene_material, attenuation_distance) && values[i] == INFINITY;
        if (!(values[i] >= row->minimum && values[i] <= row->maximum) && !is_infinite_distance)
            io_fail(r, at, member->name, FACET_ERROR_ARGUMENT, "is %g, but must lie in [%g, %g]",
                    (double)values[i], (double)row->minimum, (double)row->maximum);
        if (values[i] != unset[i])
            out->extensions |= row->extension;
    }
    memcpy((char *)out + member->to, values, member->count * sizeof(float));
}

static void read_use(io_reader *r, const json_place *at, const facet_texture_use *in, uint32_t texture_count,
                     scene_texture_ref *out)
{
    bool has_scale = in->scale[0] != 0.0f || in->scale[1] != 0.0f;
    if (!arrays_check_index(r, at, "texture", in->texture, texture_count, "textures") ||
        !arrays_check_floats(r, at, "offset", in->offset, 2) ||
        !arrays_check_floats(r, at, "rotation_rad", &in->rotation_rad, 1) ||
        !arrays_check_floats(r, at, "scale", in->scale, 2))
        return;
    out->texture = in->texture;
    out->texcoord = in->texcoord;
    memcpy(out->offset, in->offset, sizeof out->offset);
    out->rotation_rad = in->rotation_rad;
    if (has_scale)
        memcpy(out->scale, in->scale, sizeof out->scale);
    scene_texture_ref_update(out);
}

/* Rules beyond the ranges of single numbers, and which extensions count: those of the glTF reader. */
static void settle_extensions(io_reader *r, const json_place *at, const facet_material *in,
                              scene_material *out)
{
    if (in->ior != 0.0f && in->ior < 1.0f)
        io_fail(r, at, "ior", FACET_ERROR_ARGUMENT, "is %g, but must be 0 or at least 1", (double)in->ior);
    if (!(in->attenuation_distance > 0.0f))
        io_fail(r, at, "attenuation_distance", FACET_ERROR_ARGUMENT, "is %g, but must be above 0",
                (double)in->attenuation_distance);
    if (fabsf(in->scatter_anisotropy) >= 1.0f)
        io_fail(r, at, "scatter_anisotropy", FACET_ERROR_ARGUMENT, "is %g, but must lie between -1 and 1",
                (double)in->scatter_anisotropy);
    if (in->is_unlit)
        out->extensions = SCENE_UNLIT;
    else if (in->is_specular_glossiness)
        out->extensions = SCENE_SPECULAR_GLOSSINESS | (out->extensions & SCENE_EMISSIVE_STRENGTH);
    else
        out->extensions &= ~(uint32_t)SCENE_SPECULAR_GLOSSINESS;
}

static void read_material(io_reader *r, const json_place *at, const facet_material *in,
                          uint32_t texture_count, scene_material *out)
{
    static const scene_alpha_mode modes[] = {SCENE_ALPHA_OPAQUE, SCENE_ALPHA_MASK, SCENE_ALPHA_BLEND};
    *out = scene_material_default();
    out->name = arrays_copy_text(r, in->name);
    out->is_double_sided = in->is_double_sided;
    if ((unsigned)in->alpha_mode >= sizeof modes / sizeof *modes) {
        io_fail(r, at, "alpha_mode", FACET_ERROR_ARGUMENT, "is %d, which is no facet_alpha_mode",
                (int)in->alpha_mode);
        return;
    }
    out->alpha_mode = modes[in->alpha_mode];
    for (int i = 0; i < MEMBER_COUNT; i++)
        read_member(r, at, &MEMBERS[i], in, out);
    for (uint32_t i = 0; i < FACET_TEXTURE_SLOT_COUNT; i++) {
        ARRAYS_PLACE(array, use, at, "textures", i);
        if (!in->textures[i].is_used)
            continue;
        read_use(r, &use, &in->textures[i], texture_count, &out->textures[i]);
        out->extensions |= material_textures[i].extension;
    }
    settle_extensions(r, at, in, out);
}

void arrays_read_materials(io_reader *r, const facet_arrays_desc *in)
{
    _Static_assert((int)FACET_TEXTURE_SLOT_COUNT == (int)SCENE_TEXTURE_SLOT_COUNT &&
                       (int)FACET_TEXTURE_SLOT_SPECULAR_GLOSSINESS == (int)SCENE_SPECULAR_GLOSSINESS_TEXTURE,
                   "facet_texture_slot is in the order of scene_texture_slot");
    if (!arrays_check_array(r, NULL, "materials", in->materials, in->material_count))
        return;
    r->scene->materials = io_alloc(r, "materials", in->material_count, sizeof *r->scene->materials);
    for (uint32_t i = 0; i < in->material_count && io_is_ok(r); i++) {
        ARRAYS_PLACE(array, at, NULL, "materials", i);
        read_material(r, &at, &in->materials[i], in->texture_count, &r->scene->materials[i]);
        r->scene->material_count = i + 1;
    }
}

/* ---- textures ---- */

enum { TGA_HEADER_SIZE = 18, TGA_COLOR = 2, TGA_GREY = 3, TGA_TOP_DOWN = 0x20 };

/* Texels as TGA stores them: grey, BGR or BGRA. */
static void store_texels(const unsigned char *in, uint32_t count, uint32_t channel_count, unsigned char *out)
{
    switch (channel_count) {
    case 1:
        memcpy(out, in, count);
        break;
    case 2:
        for (size_t i = 0; i < count; i++) {
            memset(out + 4 * i, in[2 * i], 3);
            out[4 * i + 3] = in[2 * i + 1];
        }
        break;
    default:
        for (size_t i = 0; i < count; i++) {
            const unsigned char *texel = in + channel_count * i;
            unsigned char *stored = out + channel_count * i;
            stored[0] = texel[2];
            stored[1] = texel[1];
            stored[2] = texel[0];
            if (channel_count == 4)
                stored[3] = texel[3];
        }
    }
}

/* The pixels as a TGA file (Truevision TGA 2.0, 1991); false: an error is recorded. */
static bool encode_pixels(io_reader *r, const json_place *at, const facet_texture_desc *in, scene_image *out)
{
    enum { LARGEST = UINT16_MAX };
    const size_t row = (size_t)in->width * in->channel_count;
    const size_t stride = in->row_stride_bytes ? in->row_stride_bytes : row;
    const size_t stored = in->channel_count == 2 ? 4 : in->channel_count;
    if (in->channel_count < 1 || in->channel_count > 4)
        return io_fail(r, at, "channel_count", FACET_ERROR_ARGUMENT, "is %u, but must be 1 to 4",
                       in->channel_count);
    if (in->width < 1 || in->width > LARGEST || in->height < 1 || in->height > LARGEST)
        return io_fail(r, at, NULL, FACET_ERROR_ARGUMENT,
                       "has %u x %u pixels, but width and height must lie in [1, %d]", in->width, in->height,
                       (int)LARGEST);
    if (stride < row)
        return io_fail(r, at, "row_stride_bytes", FACET_ERROR_ARGUMENT, "is %zu, but a row has %zu bytes",
                       stride, row);
    size_t size = TGA_HEADER_SIZE + stored * in->width * in->height;
    unsigned char *bytes = io_alloc_raw(r, "texture", size, 1);
    if (!bytes)
        return false;
    const unsigned char header[TGA_HEADER_SIZE] = {
        [2] = stored == 1 ? TGA_GREY : TGA_COLOR,    [12] = (unsigned char)(in->width & 255),
        [13] = (unsigned char)(in->width >> 8),      [14] = (unsigned char)(in->height & 255),
        [15] = (unsigned char)(in->height >> 8),     [16] = (unsigned char)(8 * stored),
        [17] = TGA_TOP_DOWN | (stored == 4 ? 8 : 0),
    };
    memcpy(bytes, header, sizeof header);
    for (size_t y = 0; y < in->height; y++)
        store_texels((const unsigned char *)in->pixels + stride * y, in->width, in->channel_count,
                     bytes + TGA_HEADER_SIZE + stored * in->width * y);
    out->bytes = bytes;
    out->size = size;
    return true;
}

static void read_image(io_reader *r, const json_place *at, const facet_texture_desc *in, scene_image *out)
{
    const uint32_t default_limit = 16384;
    const uint32_t limit = r->scene->max_texture_size ? r->scene->max_texture_size : default_limit;
    image header;
    facet_error error;
    *out = (scene_image){.name = arrays_copy_text(r, in->name), .mime_type = ""};
    if (in->bytes) {
        out->bytes = arrays_copy(r, "texture", in->bytes, in->size, 1);
        out->size = in->size;
    } else if (!in->pixels) {
        io_fail(r, at, NULL, FACET_ERROR_ARGUMENT, "has neither bytes nor pixels");
    } else if (!encode_pixels(r, at, in, out)) {
        return;
    }
    if (!io_is_ok(r))
        return;
    const image_kind *kind = image_kind_of_bytes(out->bytes, out->size);
    if (!kind) {
        io_fail(r, at, "bytes", FACET_ERROR_INVALID, "is no " IMAGE_KINDS_TEXT " file");
        return;
    }
    out->mime_type = kind->mime_type;
    facet_result result = image_probe(out->bytes, out->size, "the image", &header, NULL, &error);
    if (result != FACET_OK) {
        io_fail(r, at, "bytes", result, "%s", error.message);
        return;
    }
    out->width = header.width;
    out->height = header.height;
    if (out->width > limit || out->height > limit)
        io_fail(r, at, NULL, FACET_ERROR_LIMIT, "has %u x %u texels; at most %u along an edge are allowed",
                out->width, out->height, limit);
}

static void read_texture(io_reader *r, const json_place *at, const facet_texture_desc *in, uint32_t index,
                         scene_texture *out)
{
    static const scene_wrap wraps[] = {SCENE_WRAP_REPEAT, SCENE_WRAP_CLAMP, SCENE_WRAP_MIRROR};
    static const scene_filter filters[] = {SCENE_FILTER_LINEAR, SCENE_FILTER_NEAREST};
    static const scene_mip_filter mips[] = {SCENE_MIP_LINEAR, SCENE_MIP_NEAREST, SCENE_MIP_NONE};
    if ((unsigned)in->wrap_u > 2 || (unsigned)in->wrap_v > 2 || (unsigned)in->mag_filter > 1 ||
        (unsigned)in->min_filter > 1 || (unsigned)in->mip_filter > 2) {
        io_fail(r, at, NULL, FACET_ERROR_ARGUMENT, "has a wrap mode or filter that does not exist");
        return;
    }
    *out = (scene_texture){.name = r->scene->images[index].name,
                           .image = index,
                           .wrap_u = wraps[in->wrap_u],
                           .wrap_v = wraps[in->wrap_v],
                           .mag_filter = filters[in->mag_filter],
                           .min_filter = filters[in->min_filter],
                           .mip_filter = mips[in->mip_filter]};
}

void arrays_read_textures(io_reader *r, const facet_arrays_desc *in)
{
    if (!arrays_check_array(r, NULL, "textures", in->textures, in->texture_count))
        return;
    r->scene->images = io_alloc(r, "textures", in->texture_count, sizeof *r->scene->images);
    r->scene->textures = io_alloc(r, "textures", in->texture_count, sizeof *r->scene->textures);
    for (uint32_t i = 0; i < in->texture_count && io_is_ok(r); i++) {
        ARRAYS_PLACE(array, at, NULL, "textures", i);
        read_image(r, &at, &in->textures[i], &r->scene->images[i]);
        r->scene->image_count = i + 1;
        read_texture(r, &at, &in->textures[i], i, &r->scene->textures[i]);
        r->scene->texture_count = i + 1;
    }
}
