/* bake_make.c - see bake_make.h. */
#include "cli/bake_make.h"

#include "cli/bake_ktx.h"
#include "cli/bake_text.h"
#include "cli/failure.h"

#include <stdlib.h>
#include <string.h>

/* ---- pictures ---- */

static facet_file_format picture_format(bake_container container)
{
    switch (container) {
    case CONTAINER_EXR:
        return FACET_FORMAT_EXR;
    case CONTAINER_EXR_FLOAT:
        return FACET_FORMAT_EXR_FLOAT;
    case CONTAINER_HDR:
        return FACET_FORMAT_HDR;
    case CONTAINER_PFM:
        return FACET_FORMAT_PFM;
    case CONTAINER_JPEG:
        return FACET_FORMAT_JPEG;
    case CONTAINER_WEBP:
        return FACET_FORMAT_WEBP;
    default:
        return FACET_FORMAT_PNG;
    }
}

static facet_save_desc save_desc(const bake_making *m, facet_file_format format)
{
    return (facet_save_desc){
        .allocator = m->allocator, .thread_count = m->options->limits.thread_count, .format = format};
}

/* A picture as its container has it; with --rgbm PNG is RGBM. */
static facet_result encode_picture(const bake_making *m, const facet_image *picture, bake_file *file,
                                   facet_error *error)
{
    const facet_save_desc desc = save_desc(m, picture_format(file->container));
    if (file->container == CONTAINER_PNG && file->content != BAKE_SHEET)
        return facet_image_encode_rgbm(picture, m->options->rgbm_range, &desc, &file->bytes, &file->size,
                                       error);
    return facet_image_encode(picture, &desc, &file->bytes, &file->size, error);
}

/* A copy of a picture's RGBA with texel(context, from, to) for each texel of a row, given the row from. */
typedef void row_function(const void *context, const float *from, float *to, uint32_t width);

static facet_result map_rows(const bake_making *m, const facet_image_view *view, row_function *map,
                             const void *context, facet_image **out, facet_error *error)
{
    const size_t row = (size_t)view->width * 4, size = row * view->height * sizeof(float);
    float *pixels = m->allocator.allocate(m->allocator.user, size);
    *out = NULL;
    if (!pixels)
        return fail_with(error, FACET_ERROR_MEMORY, "out of memory: %zu bytes of a picture", size);
    for (uint32_t y = 0; y < view->height; y++)
        map(context, (const float *)((const char *)view->pixels + y * view->row_stride_bytes),
            pixels + y * row, view->width);
    const facet_image_view mapped = {
        .width = view->width, .height = view->height, .channel_count = 4, .pixels = pixels};
    facet_result result = facet_image_create(&mapped, &m->allocator, out, error);
    m->allocator.release(m->allocator.user, pixels, size);
    return result;
}

/* From right to left. */
static void mirror_row(const void *context, const float *from, float *to, uint32_t width)
{
    (void)context;
    for (uint32_t x = 0; x < width; x++)
        memcpy(to + (size_t)x * 4, from + (size_t)(width - 1 - x) * 4, 4 * sizeof(float));
}

static facet_result make_face(const bake_making *m, bake_file *file, facet_error *error)
{
    /* three.js looks up (-x, y, z): what is at +X goes to -X, and each face is seen in a mirror. */
    const uint32_t face = file->is_mirrored && file->face < 2 ? 1 - file->face : file->face;
    facet_image *picture = NULL, *mirrored = NULL;
    facet_result result = facet_cube_copy_face(m->plan->cubes[file->cube].cube, file->level, face,
                                               &m->allocator, &picture, error);
    if (result == FACET_OK && file->is_mirrored) {
        const facet_image_view view = facet_image_get_layer(picture, 0);
        result = map_rows(m, &view, mirror_row, NULL, &mirrored, error);
    }
    if (result == FACET_OK)
        result = encode_picture(m, mirrored ? mirrored : picture, file, error);
    facet_image_destroy(mirrored);
    facet_image_destroy(picture);
    return result;
}

static facet_result make_level(const bake_making *m, bake_file *file, facet_error *error)
{
    facet_image *picture = NULL;
    facet_result result = facet_cube_unfold(m->plan->cubes[file->cube].cube, file->level, file->projection, 0,
                                            &m->allocator, &picture, error);
    if (result == FACET_OK)
        result = encode_picture(m, picture, file, error);
    facet_image_destroy(picture);
    return result;
}

/* ---- cube maps ---- */

static facet_ktx2_desc ktx2_desc(const bake_making *m, const bake_file *file)
{
    return (facet_ktx2_desc){.allocator = m->allocator,
                             .thread_count = m->options->limits.thread_count,
                             .format = file->texels,
                             .zstd_level = m->options->zstd_level};
}

static size_t texel_size(facet_texel_format format)
{
    return format == FACET_TEXEL_RGBA32F   ? 16
           : format == FACET_TEXEL_RGBA16F ? 8
                                           : 4; /* those of cube maps */
}

static facet_result make_cube(const bake_making *m, bake_file *file, facet_error *error)
{
    const bake_cube *baked = &m->plan->cubes[file->cube];
    const facet_ktx2_desc desc = ktx2_desc(m, file);
    unsigned char *ktx2 = NULL;
    size_t ktx2_size = 0;
    facet_result result = facet_cube_encode_ktx2(baked->cube, &desc, &ktx2, &ktx2_size, error);
    if (result != FACET_OK || file->container == CONTAINER_KTX2) {
        file->bytes = ktx2;
        file->size = ktx2_size;
        return result == FACET_OK && file->is_mirrored
                   ? bake_ktx2_mirror(ktx2, ktx2_size, texel_size(file->texels), error)
                   : result;
    }
    bake_text harmonics = {0};
    if (baked->desc.lobe == FACET_LOBE_GGX)
        bake_text_sh_numbers(&harmonics, m->plan->sh[FACET_SH_FOLDED]);
    if (harmonics.has_failed)
        result = fail_with(error, FACET_ERROR_MEMORY, "out of memory: harmonics");
    if (result == FACET_OK)
        result = bake_ktx1_from_ktx2(ktx2, ktx2_size, harmonics.data, &file->bytes, &file->size, error);
    file->is_text = true;
    free(harmonics.data);
    facet_bytes_destroy(ktx2);
    return result;
}

/* ---- text ---- */

static facet_result take_text(bake_file *file, bake_text *text, facet_error *error)
{
    file->bytes = (unsigned char *)text->data;
    file->size = text->size;
    file->is_text = true;
    return text->has_failed ? fail_with(error, FACET_ERROR_MEMORY, "%s: out of memory", file->path)
                            : FACET_OK;
}

static facet_result make_sh(const bake_making *m, bake_file *file, facet_error *error)
{
    bake_text text = {0};
    char symbol[128];
    const float(*sh)[9][3] = m->plan->sh;
    const char *source = bake_input_name(m->options);
    bake_text_symbol(file->path, symbol, sizeof symbol);
    if (file->container == CONTAINER_JSON)
        bake_text_sh_json(&text, sh, source, m->options->harmonics.is_windowed);
    else if (file->container == CONTAINER_HEADER)
        bake_text_sh_header(&text, sh, source, symbol);
    else
        bake_text_sh_filament(&text, sh[FACET_SH_FOLDED]);
    return take_text(file, &text, error);
}

/* ---- tables ---- */

static const char *table_meaning(facet_dfg_kind kind)
{
    static const char *const meanings[] = {
        [FACET_DFG_SCHLICK] = "Scale and bias of F0 (split sum), GGX with Schlick's masking, k = alpha / 2",
        [FACET_DFG_CORRELATED] = "Scale and bias of F0 (split sum), GGX with height-correlated Smith masking",
        [FACET_DFG_MULTISCATTER] = "Integral of Fc and of 1, GGX, height-correlated: Filament's layout",
        [FACET_DFG_CHARLIE] = "Albedo of sheen, Charlie with Estevez and Kulla's masking",
        [FACET_DFG_CHARLIE_NEUBELT] = "Albedo of sheen, Charlie with Neubelt's masking",
        [FACET_DFG_GGX_AVERAGE] = "Albedo of GGX averaged over the cosine; equal along x",
        [FACET_DFG_FILAMENT] =
            "Integral of Fc and of 1, GGX; albedo of sheen with Neubelt's masking: Filament's"};
    return meanings[kind];
}

/* What PNG's sRGB encoding turns into the table's numbers, in the channels where they are wanted. */
static void linear_row(const void *context, const float *from, float *to, uint32_t width)
{
    const int channel = *(const int *)context;
    for (size_t i = 0; i < (size_t)width * 4; i += 4)
        for (int k = 0; k < 4; k++) {
            float number = channel < 0 ? from[i + (size_t)k] : k == channel ? from[i] : 0.0f;
            number = number < 0.0f ? 0.0f : number > 1.0f ? 1.0f : number;
            to[i + (size_t)k] = k == 3 ? 1.0f : facet_linear_from_srgb(number);
        }
}

static facet_result encode_linear_png(const bake_making *m, const facet_image_view *view, bake_file *file,
                                      facet_error *error)
{
    const facet_save_desc desc = save_desc(m, FACET_FORMAT_PNG16);
    facet_image *picture = NULL;
    facet_result result = map_rows(m, view, linear_row, &file->table_channel, &picture, error);
    if (result == FACET_OK)
        result = facet_image_encode(picture, &desc, &file->bytes, &file->size, error);
    facet_image_destroy(picture);
    return result;
}

static facet_result encode_table(const bake_making *m, const facet_image *table, bake_file *file,
                                 facet_error *error)
{
    const facet_image_view view = facet_image_get_layer(table, 0);
    if (file->container == CONTAINER_KTX2) {
        const facet_ktx2_desc desc = ktx2_desc(m, file);
        return facet_image_encode_ktx2(table, &desc, &file->bytes, &file->size, error);
    }
    if (file->container == CONTAINER_PNG)
        return encode_linear_png(m, &view, file, error);
    if (file->container == CONTAINER_HEADER) {
        bake_text text = {0};
        char symbol[128];
        bake_text_symbol(strcmp(file->path, "-") == 0 ? "dfg" : file->path, symbol, sizeof symbol);
        bake_text_table(&text, &view, facet_dfg_get_channel_count(file->table), table_meaning(file->table),
                        symbol);
        return take_text(file, &text, error);
    }
    return encode_picture(m, table, file, error);
}

static facet_result make_table(const bake_making *m, bake_file *file, facet_error *error)
{
    const facet_dfg_desc desc = {.allocator = m->allocator,
                                 .progress = m->progress,
                                 .thread_count = m->options->limits.thread_count,
                                 .kind = file->table,
                                 .size = m->options->table_size};
    facet_image *table = NULL;
    facet_result result = facet_dfg_bake(&desc, &table, error);
    if (result == FACET_OK)
        result = encode_table(m, table, file, error);
    facet_image_destroy(table);
    return result;
}

/* ---- the sheet ---- */

static facet_result make_sheet(const bake_making *m, bake_file *file, facet_error *error)
{
    const bake_cube *baked = &m->plan->cubes[file->cube];
    const facet_sheet_desc desc = {.allocator = m->allocator,
                                   .progress = m->progress,
                                   .thread_count = m->options->limits.thread_count,
                                   .bake = baked->desc,
                                   .tonemap = m->options->tonemap};
    facet_image *sheet = NULL;
    facet_result result = facet_cube_draw_sheet(baked->cube, m->environment, &desc, &sheet, error);
    if (result == FACET_OK)
        result = encode_picture(m, sheet, file, error);
    facet_image_destroy(sheet);
    return result;
}

facet_result bake_file_make(const bake_making *m, bake_file *file, facet_error *error)
{
    static facet_result (*const makers[])(const bake_making *, bake_file *, facet_error *) = {
        [BAKE_CUBE] = make_cube, [BAKE_LEVEL] = make_level, [BAKE_FACE] = make_face,
        [BAKE_SH] = make_sh,     [BAKE_TABLE] = make_table, [BAKE_SHEET] = make_sheet};
    return makers[file->content](m, file, error);
}
