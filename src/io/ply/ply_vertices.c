/* ply_vertices.c - numbers of a PLY file, as text or binary, and its vertices: positions, and the
 * properties of well-known names. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "image/codec.h"
#include "image/srgb.h"
#include "io/ply/ply_reader.h"

/* ---- numbers ---- */

static bool is_space(unsigned char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

static bool read_text(ply_reader *r, double *value)
{
    const char *after;
    while (r->at < r->end && is_space(*r->at))
        r->at++;
    if (r->at == r->end)
        return false;
    const char *text = (const char *)r->at;
    *value = codec_parse_number(text, (const char *)r->end, &after);
    r->at = (const unsigned char *)after;
    if (after == text) /* not a number: nan, or invalid text, counts as not finite */
        *value = (double)NAN;
    while (r->at < r->end && !is_space(*r->at))
        r->at++;
    return true;
}

/* The bits of a value of that size, independent of byte order. */
static uint64_t read_bits(const unsigned char *p, size_t size, bool is_big)
{
    uint64_t bits = 0;
    for (size_t i = 0; i < size; i++)
        bits = bits << 8 | p[is_big ? i : size - 1 - i];
    return bits;
}

bool ply_read_value(ply_reader *r, ply_type type, double *value)
{
    if (r->form == PLY_TEXT)
        return read_text(r, value);
    size_t size = ply_type_size(type);
    if ((size_t)(r->end - r->at) < size)
        return false;
    uint64_t bits = read_bits(r->at, size, r->form == PLY_BIG);
    uint32_t word = (uint32_t)bits;
    float single;
    r->at += size;
    switch (type) {
    case PLY_INT8:
        *value = (double)(bits & 0x80 ? (int)bits - 0x100 : (int)bits);
        break;
    case PLY_INT16:
        *value = (double)(bits & 0x8000 ? (int)bits - 0x10000 : (int)bits);
        break;
    case PLY_INT32:
        *value = bits & 0x80000000u ? (double)bits - 4294967296.0 : (double)bits;
        break;
    case PLY_FLOAT:
        memcpy(&single, &word, sizeof single);
        *value = (double)single;
        break;
    case PLY_DOUBLE:
        memcpy(value, &bits, sizeof *value);
        break;
    case PLY_NONE:
    case PLY_UINT8:
    case PLY_UINT16:
    case PLY_UINT32:
        *value = (double)bits;
        break;
    }
    return true;
}

uint64_t ply_max_elements(const ply_reader *r, const ply_element *e)
{
    uint64_t least = 0;
    for (size_t i = 0; i < e->property_count; i++) {
        const ply_property *p = &e->properties[i];
        least += r->form == PLY_TEXT ? 2 : ply_type_size(p->count_type != PLY_NONE ? p->count_type : p->type);
    }
    uint64_t left =
        (uint64_t)(r->end - r->at) + (r->form == PLY_TEXT); /* the last value has no blank behind it */
    return least ? left / least : 0;
}

/* ---- vertices ---- */

typedef enum vertex_value {
    VALUE_X,
    VALUE_Y,
    VALUE_Z,
    VALUE_NX,
    VALUE_NY,
    VALUE_NZ,
    VALUE_RED,
    VALUE_GREEN,
    VALUE_BLUE,
    VALUE_ALPHA,
    VALUE_U,
    VALUE_V,
    VALUE_SPLAT_RED, /* Gaussian splats: the constant spherical harmonic */
    VALUE_SPLAT_GREEN,
    VALUE_SPLAT_BLUE,
    VALUE_COUNT
} vertex_value;

static const struct {
    const char *name;
    vertex_value value;
} NAMES[] = {
    {"x", VALUE_X},
    {"y", VALUE_Y},
    {"z", VALUE_Z},
    {"nx", VALUE_NX},
    {"ny", VALUE_NY},
    {"nz", VALUE_NZ},
    {"normal_x", VALUE_NX},
    {"normal_y", VALUE_NY},
    {"normal_z", VALUE_NZ},
    {"red", VALUE_RED},
    {"green", VALUE_GREEN},
    {"blue", VALUE_BLUE},
    {"alpha", VALUE_ALPHA},
    {"r", VALUE_RED},
    {"g", VALUE_GREEN},
    {"b", VALUE_BLUE},
    {"a", VALUE_ALPHA},
    {"diffuse_red", VALUE_RED},
    {"diffuse_green", VALUE_GREEN},
    {"diffuse_blue", VALUE_BLUE},
    {"diffuse_alpha", VALUE_ALPHA},
    {"s", VALUE_U},
    {"t", VALUE_V},
    {"u", VALUE_U},
    {"v", VALUE_V},
    {"texture_u", VALUE_U},
    {"texture_v", VALUE_V},
    {"tex_u", VALUE_U},
    {"tex_v", VALUE_V},
    {"tx", VALUE_U},
    {"ty", VALUE_V},
    {"f_dc_0", VALUE_SPLAT_RED},
    {"f_dc_1", VALUE_SPLAT_GREEN},
    {"f_dc_2", VALUE_SPLAT_BLUE},
};

/* The properties of the vertex element. */
typedef struct layout {
    uint32_t values;           /* bits of vertex_value */
    vertex_value *of_property; /* VALUE_COUNT: unused; block of mem_alloc() */
    ply_type types[VALUE_COUNT];
} layout;

static bool has_all(const layout *l, vertex_value first, int count)
{
    uint32_t wanted = ((1u << count) - 1u) << first;
    return (l->values & wanted) == wanted;
}

static bool find_layout(ply_reader *r, const ply_element *e, layout *l)
{
    *l = (layout){0};
    l->of_property = mem_alloc(&r->desc->allocator, e->property_count, sizeof *l->of_property);
    if (!l->of_property)
        return ply_fail_memory(r, "properties");
    for (size_t i = 0; i < e->property_count; i++) {
        const ply_property *p = &e->properties[i];
        l->of_property[i] = VALUE_COUNT;
        for (size_t k = 0; k < sizeof NAMES / sizeof *NAMES && p->count_type == PLY_NONE; k++)
            if (strcmp(p->name, NAMES[k].name) == 0 && !(l->values >> NAMES[k].value & 1u)) {
                l->of_property[i] = NAMES[k].value;
                l->types[NAMES[k].value] = p->type;
                l->values |= 1u << NAMES[k].value;
            }
    }
    return has_all(l, VALUE_X, 2) ||
           ply_fail(r, FACET_ERROR_INVALID, "its vertices have no x and y; property float x was expected");
}

/* ---- arrays ---- */

static float *take(ply_reader *r, size_t count, size_t width)
{
    float *list = mem_zalloc(&r->desc->allocator, count, width * sizeof *list);
    if (!list)
        ply_fail_memory(r, "vertices");
    return list;
}

static bool take_arrays(ply_reader *r, const layout *l, size_t count)
{
    obj_soup *s = &r->soup;
    s->places = mem_zalloc(&r->desc->allocator, count, 3 * sizeof *s->places);
    if (!s->places)
        return ply_fail_memory(r, "vertices");
    if (has_all(l, VALUE_NX, 3))
        s->normals = take(r, count, 3);
    if (has_all(l, VALUE_RED, 3) || has_all(l, VALUE_SPLAT_RED, 3))
        s->colors = take(r, count, 4);
    if (has_all(l, VALUE_U, 2))
        s->texcoords = take(r, count, 2);
    return r->result == FACET_OK;
}

/* ---- colors ---- */

/* The largest value of a component: integers have 8 or 16 bits, floats reach 1 unless one is larger. */
static double largest_of(ply_type type, double most)
{
    bool is_float = type == PLY_FLOAT || type == PLY_DOUBLE;
    bool has_16_bits = type == PLY_UINT16 || type == PLY_INT16;
    return is_float ? most > 1.0 ? 255.0 : 1.0 : has_16_bits ? 65535.0 : 255.0;
}

static double to_unit(double value)
{
    return value > 0.0 ? value < 1.0 ? value : 1.0 : 0.0;
}

/* Converts the file's numbers to linear light. An opacity that is 0 everywhere was never set. */
static void settle_colors(ply_reader *r, const layout *l, size_t count)
{
    /* Kerbl et al. 2023, "3D Gaussian splatting": the band of order 0 is 1 / (2 sqrt(pi)), colors are 0.5
     * above it. */
    static const double Y0 = 0.28209479177387814;
    float *colors = r->soup.colors;
    bool is_splat = !has_all(l, VALUE_RED, 3);
    bool is_linear = r->desc->legacy.colors == FACET_LEGACY_COLORS_LINEAR;
    bool has_opacity = false;
    double most = 0.0;
    for (size_t i = 0; i < 4 * count; i++) {
        most = i % 4 < 3 && (double)colors[i] > most ? (double)colors[i] : most;
        has_opacity |= i % 4 == 3 && colors[i] > 0.0f;
    }
    for (size_t i = 0; i < 4 * count; i++) {
        int k = (int)(i % 4);
        double c = (double)colors[i];
        if (k == 3) {
            bool is_set = l->values >> VALUE_ALPHA & 1u && has_opacity;
            colors[i] = is_set ? (float)to_unit(c / largest_of(l->types[VALUE_ALPHA], 1.0)) : 1.0f;
            continue;
        }
        c = to_unit(is_splat ? 0.5 + Y0 * c : c / largest_of(l->types[VALUE_RED + k], most));
        colors[i] = (float)(is_linear ? c : srgb_decode(c));
    }
}

/* ---- the element ---- */

static void store_vertex(ply_reader *r, const layout *l, size_t i, const double values[VALUE_COUNT])
{
    obj_soup *s = &r->soup;
    vertex_value color = has_all(l, VALUE_RED, 3) ? VALUE_RED : VALUE_SPLAT_RED;
    for (size_t k = 0; k < 3; k++) {
        s->places[3 * i + k] = values[VALUE_X + k];
        if (s->normals)
            s->normals[3 * i + k] = (float)values[VALUE_NX + k];
        if (s->colors)
            s->colors[4 * i + k] = (float)values[color + k];
    }
    if (s->colors)
        s->colors[4 * i + 3] = (float)values[VALUE_ALPHA];
    for (size_t k = 0; s->texcoords && k < 2; k++) {
        double x = values[VALUE_U + k];
        s->texcoords[2 * i + k] = fabs(x) <= 1e30 ? (float)x : 0.0f;
    }
}

/* Reads one vertex; values of lists are ignored. False: the file ends before. */
static bool read_vertex(ply_reader *r, const ply_element *e, const layout *l, double values[VALUE_COUNT])
{
    for (size_t k = 0; k < e->property_count; k++) {
        const ply_property *p = &e->properties[k];
        double number;
        double item;
        if (!ply_read_value(r, p->count_type != PLY_NONE ? p->count_type : p->type, &number))
            return false;
        for (double n = 0; p->count_type != PLY_NONE && n < number; n++)
            if (!ply_read_value(r, p->type, &item))
                return false;
        if (l->of_property[k] != VALUE_COUNT)
            values[l->of_property[k]] = number;
    }
    return true;
}

bool ply_read_vertices(ply_reader *r, const ply_element *e)
{
    layout l;
    uint64_t most = ply_max_elements(r, e);
    size_t count = (size_t)(e->count < most ? e->count : most);
    if (r->soup.places)
        return ply_fail(r, FACET_ERROR_INVALID, "has two elements \"vertex\"");
    bool is_ok = find_layout(r, e, &l) && take_arrays(r, &l, count);
    size_t i = 0;
    double values[VALUE_COUNT] = {0};
    while (is_ok && i < count && read_vertex(r, e, &l, values))
        store_vertex(r, &l, i++, values);
    r->soup.place_count = i;
    r->soup.texcoord_count = r->soup.texcoords ? i : 0;
    if (is_ok && i < e->count)
        scene_warn(r->scene, &r->desc->log, "%s: is cut off: %llu vertices were declared, %zu are there",
                   r->scene->source, (unsigned long long)e->count, i);
    if (is_ok && r->soup.colors)
        settle_colors(r, &l, i);
    mem_free(l.of_property);
    return is_ok;
}
