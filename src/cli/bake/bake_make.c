/* bake_make.c - see bake_plan.h. */
#include "cli/bake/bake_plan.h"

#include "cli/bake/bake_names.h"
#include "cli/shared/failure.h"
#include "cli/shared/output.h"

#include <jansson.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- what formats cut off ---- */

float bake_file_limit(const bake_file *file)
{
    static const float largest[] = {[FACET_TEXEL_FORMAT_RGBA16F] = 65504.0f,
                                    [FACET_TEXEL_FORMAT_RGB9E5] = 65408.0f,
                                    [FACET_TEXEL_FORMAT_B10G11R11] = 64512.0f,
                                    [FACET_TEXEL_FORMAT_RGBA32F] = 0.0f};
    if (file->container == CONTAINER_KTX2)
        return file->texels < sizeof largest / sizeof *largest ? largest[file->texels]
                                                               : 0.0f; /* r, rg: of tables */
    return file->container == CONTAINER_KTX1 ? 64512.0f : file->container == CONTAINER_EXR ? 65504.0f : 0.0f;
}

double bake_cut_share(const facet_cube *cube, uint32_t level, float limit)
{
    double whole = 0.0, cut = 0.0;
    const uint32_t size = facet_cube_get_size(cube, level);
    for (uint32_t face = 0; face < 6; face++) {
        const facet_image_view view = facet_cube_get_face(cube, level, face);
        for (uint32_t i = 0; i < size * size; i++) {
            const float *texel =
                (const float *)((const char *)view.pixels + i / size * view.row_stride_bytes) +
                (size_t)(i % size) * view.channel_count;
            const double s = (2.0 * (i % size) + 1.0) / size - 1.0, t = (2.0 * (i / size) + 1.0) / size - 1.0;
            const double weight = pow(1.0 + s * s + t * t, -1.5);
            for (int k = 0; k < 3; k++) {
                whole += weight * (double)texel[k];
                cut += texel[k] > limit ? weight * (double)(texel[k] - limit) : 0.0;
            }
        }
    }
    return whole > 0.0 ? cut / whole : 0.0;
}

/* ---- text ---- */

/* A growing text; release it with free(data). {0} initially. */
typedef struct bake_text {
    char *data;
    size_t size, capacity;
    bool has_failed; /* out of memory */
} bake_text;

static const struct {
    const char *name, *meaning;
} forms[3] = {
    {"radiance", "L_lm, the integral of radiance times Y_lm: what three.js' LightProbe takes"},
    {"irradiance", "E_lm = A_l L_lm with A = pi, 2 pi / 3, pi / 4: irradiance is the sum of E_lm Y_lm"},
    {"folded", "irradiance / pi = the sum of c times 1, y, z, x, xy, yz, 3z^2 - 1, zx, x^2 - y^2: Filament's "
               "pre-scaled harmonics"},
};
static const char *const orders[9] = {"L00", "L1-1", "L10", "L11", "L2-2", "L2-1", "L20", "L21", "L22"};
static const char basis[] =
    "real spherical harmonics without the sign of Condon and Shortley, +Y up, linear Rec.709";

static __attribute__((format(printf, 2, 3))) void add(bake_text *t, const char *format, ...)
{
    va_list arguments;
    for (int attempt = 0; attempt < 2 && !t->has_failed; attempt++) {
        size_t room = t->capacity - t->size;
        va_start(arguments, format);
        int n = vsnprintf(t->data ? t->data + t->size : NULL, room, format, arguments);
        va_end(arguments);
        if (n < 0) {
            t->has_failed = true;
        } else if ((size_t)n < room) {
            t->size += (size_t)n;
            return;
        } else {
            size_t capacity = 2 * t->capacity + (size_t)n + 1024;
            char *grown = realloc(t->data, capacity);
            t->has_failed = !grown;
            t->data = grown ? grown : t->data;
            t->capacity = grown ? capacity : t->capacity;
        }
    }
}

/* ---- harmonics ---- */

static json_t *coefficients_json(const float c[9][3])
{
    json_t *list = json_array();
    for (int i = 0; i < 9; i++)
        json_array_append_new(list,
                              json_pack("[f, f, f]", (double)c[i][0], (double)c[i][1], (double)c[i][2]));
    return list;
}

static void bake_text_sh_json(bake_text *t, const float sh[3][9][3], const char *source, bool is_windowed)
{
    json_t *name = report_string_json(source), *order = json_array(), *list = json_array();
    for (int i = 0; i < 9; i++)
        json_array_append_new(order, json_string(orders[i]));
    for (int form = 0; form < 3; form++)
        json_array_append_new(list,
                              json_pack("{s:s, s:s, s:o}", "form", forms[form].name, "meaning",
                                        forms[form].meaning, "coefficients", coefficients_json(sh[form])));
    json_t *root = json_pack("{s:s, s:s, s:o, s:s, s:o, s:b, s:o}", "generator", "facet", "version",
                             facet_version(), "source", name, "basis", basis, "order", order, "windowed",
                             (int)is_windowed, "forms", list);
    char *text = root ? json_dumps(root, JSON_INDENT(1) | JSON_REAL_PRECISION(9)) : NULL;
    if (text)
        add(t, "%s\n", text);
    else
        t->has_failed = true;
    free(text);
    json_decref(root);
}

/* A name that may hold anything, within a comment of C. */
static void add_in_comment(bake_text *t, const char *name)
{
    for (; *name; name++)
        if ((unsigned char)*name < ' ' || (name[0] == '*' && name[1] == '/') ||
            (name[0] == '?' && name[1] == '?'))
            add(t, "_");
        else
            add(t, "%c", *name);
}

static void bake_text_sh_header(bake_text *t, const float sh[3][9][3], const char *source, const char *symbol)
{
    add(t, "/* ");
    add_in_comment(t, source);
    add(t, " as nine spherical harmonics, by facet %s.\n *\n * Basis: %s. Order:", facet_version(), basis);
    for (int i = 0; i < 9; i++)
        add(t, " %s", orders[i]);
    add(t, " */\n");
    for (int form = 0; form < 3; form++) {
        add(t, "\n/* %s */\nstatic const float %s_%s[9][3] = {\n", forms[form].meaning, symbol,
            forms[form].name);
        for (int i = 0; i < 9; i++)
            add(t, "    {%.8ef, %.8ef, %.8ef}, /* %s */\n", (double)sh[form][i][0], (double)sh[form][i][1],
                (double)sh[form][i][2], orders[i]);
        add(t, "};\n");
    }
}

static void bake_text_sh_filament(bake_text *t, const float folded[9][3])
{
    for (int i = 0; i < 9; i++)
        add(t, "(%18.15f, %18.15f, %18.15f); // %s, irradiance, pre-scaled base\n", (double)folded[i][0],
            (double)folded[i][1], (double)folded[i][2], orders[i]);
}

/* ---- tables ---- */

static void bake_text_table(bake_text *t, const facet_image_view *table, uint32_t channel_count,
                            const char *what, const char *symbol)
{
    add(t,
        "/* %s, by facet %s.\n *\n * [y][x][channel]: x is N.V and y perceptual roughness, both from 0, at "
        "texel middles:\n * N.V = (x + 0.5) / %u, perceptual roughness = (y + 0.5) / %u. */\n",
        what, facet_version(), table->width, table->height);
    add(t, "static const float %s[%u][%u][%u] = {\n", symbol, table->height, table->width, channel_count);
    for (uint32_t y = 0; y < table->height; y++) {
        const float *row = (const float *)((const char *)table->pixels + y * table->row_stride_bytes);
        add(t, "    {");
        for (uint32_t x = 0; x < table->width; x++) {
            const float *texel = row + (size_t)x * table->channel_count;
            for (uint32_t i = 0; i < channel_count; i++)
                add(t, "%s%.8ef%s", i ? ", " : "{", (double)texel[i], i + 1 == channel_count ? "}" : "");
            add(t, "%s", x + 1 == table->width ? "},\n" : x % 4 == 3 ? ",\n     " : ", ");
        }
    }
    add(t, "};\n");
}

/* ---- images ---- */

static facet_image_format image_format(bake_container container)
{
    switch (container) {
    case CONTAINER_EXR:
        return FACET_IMAGE_FORMAT_EXR;
    case CONTAINER_EXR_FLOAT:
        return FACET_IMAGE_FORMAT_EXR_FLOAT;
    case CONTAINER_HDR:
        return FACET_IMAGE_FORMAT_HDR;
    case CONTAINER_PFM:
        return FACET_IMAGE_FORMAT_PFM;
    case CONTAINER_JPEG:
        return FACET_IMAGE_FORMAT_JPEG;
    case CONTAINER_WEBP:
        return FACET_IMAGE_FORMAT_WEBP;
    default:
        return FACET_IMAGE_FORMAT_PNG;
    }
}

static facet_image_save_desc save_desc(const bake_making *m, facet_image_format format)
{
    return (facet_image_save_desc){
        .allocator = m->allocator, .thread_count = m->options->limits.thread_count, .format = format};
}

/* Encodes an image in its container; with --rgbm PNG is RGBM. */
static facet_result encode_image(const bake_making *m, const facet_image *image, bake_file *file,
                                 facet_error *error)
{
    const facet_image_save_desc desc = save_desc(m, image_format(file->container));
    if (file->container == CONTAINER_PNG && file->content != BAKE_SHEET)
        return facet_image_encode_rgbm(image, m->options->rgbm_range, &desc, &file->bytes, &file->size,
                                       error);
    return facet_image_encode(image, &desc, &file->bytes, &file->size, error);
}

static const facet_cube *cube_of(const bake_making *m, const bake_file *file)
{
    const bake_cube *baked = &m->plan->cubes[file->cube];
    return file->is_mirrored ? baked->mirrored : baked->cube;
}

static facet_result make_face(const bake_making *m, bake_file *file, facet_error *error)
{
    facet_image *image = NULL;
    facet_result result =
        facet_cube_copy_face(cube_of(m, file), file->level, file->face, &m->allocator, &image, error);
    if (result == FACET_OK)
        result = encode_image(m, image, file, error);
    facet_image_destroy(image);
    return result;
}

static facet_result make_level(const bake_making *m, bake_file *file, facet_error *error)
{
    facet_image *image = NULL;
    facet_result result =
        facet_cube_unfold(cube_of(m, file), file->level, file->projection, 0, &m->allocator, &image, error);
    if (result == FACET_OK)
        result = encode_image(m, image, file, error);
    facet_image_destroy(image);
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

static facet_result make_cube(const bake_making *m, bake_file *file, facet_error *error)
{
    if (file->container == CONTAINER_KTX1) {
        const bool has_sh = m->plan->cubes[file->cube].desc.lobe == FACET_LOBE_GGX;
        const facet_ktx1_desc desc = {.allocator = m->allocator,
                                      .thread_count = m->options->limits.thread_count,
                                      .harmonics = has_sh ? m->plan->sh[FACET_SH_FORM_FOLDED] : NULL};
        return facet_cube_encode_ktx1(cube_of(m, file), &desc, &file->bytes, &file->size, error);
    }
    const facet_ktx2_desc desc = ktx2_desc(m, file);
    return facet_cube_encode_ktx2(cube_of(m, file), &desc, &file->bytes, &file->size, error);
}

/* ---- text ---- */

static facet_result take_text(bake_file *file, bake_text *text, facet_error *error)
{
    file->bytes = (unsigned char *)text->data;
    file->size = text->size;
    file->is_text = true;
    return text->has_failed ? fail(error, FACET_ERROR_MEMORY, "%s: out of memory", file->path) : FACET_OK;
}

static facet_result make_sh(const bake_making *m, bake_file *file, facet_error *error)
{
    bake_text text = {0};
    char symbol[128];
    const float(*sh)[9][3] = m->plan->sh;
    const char *source = bake_input_name(m->options);
    bake_symbol(file->path, symbol, sizeof symbol);
    if (file->container == CONTAINER_JSON)
        bake_text_sh_json(&text, sh, source, m->options->harmonics.is_windowed);
    else if (file->container == CONTAINER_HEADER)
        bake_text_sh_header(&text, sh, source, symbol);
    else
        bake_text_sh_filament(&text, sh[FACET_SH_FORM_FOLDED]);
    return take_text(file, &text, error);
}

/* ---- tables ---- */

static const char *table_meaning(facet_dfg_kind kind)
{
    static const char *const meanings[] = {
        [FACET_DFG_KIND_SCHLICK] =
            "Scale and bias of F0 (split sum), GGX with Schlick's masking, k = alpha / 2",
        [FACET_DFG_KIND_CORRELATED] =
            "Scale and bias of F0 (split sum), GGX with height-correlated Smith masking",
        [FACET_DFG_KIND_MULTISCATTER] = "Integral of Fc and of 1, GGX, height-correlated: Filament's layout",
        [FACET_DFG_KIND_CHARLIE] = "Albedo of sheen, Charlie with Estevez and Kulla's masking",
        [FACET_DFG_KIND_CHARLIE_NEUBELT] = "Albedo of sheen, Charlie with Neubelt's masking",
        [FACET_DFG_KIND_GGX_AVERAGE] = "Albedo of GGX averaged over the cosine; equal along x",
        [FACET_DFG_KIND_FILAMENT] =
            "Integral of Fc and of 1, GGX; albedo of sheen with Neubelt's masking: Filament's"};
    return meanings[kind];
}

/* Inverts PNG's sRGB encoding, so that the file holds the table's values, in the channels that it has. */
static void linear_row(int channel, const float *from, float *to, uint32_t width)
{
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
    const facet_image_save_desc desc = save_desc(m, FACET_IMAGE_FORMAT_PNG16);
    const size_t row = (size_t)view->width * 4, size = row * view->height * sizeof(float);
    float *pixels = m->allocator.allocate(m->allocator.user, size);
    facet_image *image = NULL;
    if (!pixels)
        return fail(error, FACET_ERROR_MEMORY, "out of memory: %zu bytes of an image", size);
    for (uint32_t y = 0; y < view->height; y++)
        linear_row(file->table_channel,
                   (const float *)((const char *)view->pixels + y * view->row_stride_bytes), pixels + y * row,
                   view->width);
    const facet_image_view linear = {
        .width = view->width, .height = view->height, .channel_count = 4, .pixels = pixels};
    facet_result result = facet_image_create(&linear, &m->allocator, &image, error);
    m->allocator.release(m->allocator.user, pixels, size);
    if (result == FACET_OK)
        result = facet_image_encode(image, &desc, &file->bytes, &file->size, error);
    facet_image_destroy(image);
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
        bake_symbol(strcmp(file->path, "-") == 0 ? "dfg" : file->path, symbol, sizeof symbol);
        bake_text_table(&text, &view, facet_dfg_get_channel_count(file->table), table_meaning(file->table),
                        symbol);
        return take_text(file, &text, error);
    }
    return encode_image(m, table, file, error);
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
                                   .tonemap = m->options->tonemap,
                                   .exposure_ev = (float)m->options->sheet_ev,
                                   .meters_exposure = m->options->meters_sheet};
    facet_image *sheet = NULL;
    facet_result result = facet_cube_draw_sheet(baked->cube, m->environment, &desc, &sheet, error);
    if (result == FACET_OK)
        result = encode_image(m, sheet, file, error);
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
