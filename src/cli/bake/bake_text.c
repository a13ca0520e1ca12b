/* bake_text.c - see bake_text.h. */
#include "cli/bake/bake_text.h"

#include "cli/shared/output_name.h"
#include "cli/shared/json_report.h"

#include <jansson.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

void bake_text_sh_json(bake_text *t, const float sh[3][9][3], const char *source, bool is_windowed)
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

void bake_text_sh_header(bake_text *t, const float sh[3][9][3], const char *source, const char *symbol)
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

void bake_text_sh_filament(bake_text *t, const float folded[9][3])
{
    for (int i = 0; i < 9; i++)
        add(t, "(%18.15f, %18.15f, %18.15f); // %s, irradiance, pre-scaled base\n", (double)folded[i][0],
            (double)folded[i][1], (double)folded[i][2], orders[i]);
}

/* ---- tables ---- */

void bake_text_table(bake_text *t, const facet_image_view *table, uint32_t channel_count, const char *what,
                     const char *symbol)
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

void bake_text_symbol(const char *path, char *symbol, size_t size)
{
    char stem[256];
    size_t n = 0;
    if (!output_name_stem(path, stem, sizeof stem))
        memcpy(stem, "baked", 6);
    if (stem[0] >= '0' && stem[0] <= '9')
        symbol[n++] = '_';
    for (const char *at = stem; *at && n + 1 < size; at++) {
        bool is_good = (*at >= 'a' && *at <= 'z') || (*at >= 'A' && *at <= 'Z') || (*at >= '0' && *at <= '9');
        symbol[n++] = is_good ? *at : '_';
    }
    symbol[n] = 0;
}
