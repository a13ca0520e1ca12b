/* report.c - see report.h. */
#include "report/report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "image/srgb.h"
#include "legacy/fit.h"
#include "plot/chart.h"
#include "report/html.h"
#include "report/spheres.h"
#include "scene/legacy.h"

/* ---- curves: reflectance of both models of a converted material over the light angle ---- */

enum { CURVES_WIDTH = 900, CURVES_HEIGHT = 270 };

enum { VIEWS = 3, STEPS = 361 }; /* every half degree: a lobe of shininess 1000 is 8 degrees wide */
static const double PI = 3.14159265358979323846;
static const double VIEW_ANGLES[VIEWS] = {0.0, 30.0, 60.0};
static const char *const VIEW_TITLES[VIEWS] = {"seen at 0\xc2\xb0", "seen at 30\xc2\xb0",
                                               "seen at 60\xc2\xb0"};

static double luminance(const float rgb[3])
{
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

typedef struct pair {
    ogl1_surface ogl1;
    pbr_surface pbr;
    bool is_from_ogl1;
} pair;

/* x, and y of source and result. */
static void sample(const pair *p, double view_degrees, double *x, double *source, double *made)
{
    double view = view_degrees * PI / 180.0;
    const float V[3] = {(float)sin(view), 0.0f, (float)cos(view)};
    for (int i = 0; i < STEPS; i++) {
        x[i] = -90.0 + 180.0 * i / (STEPS - 1);
        double angle = x[i] * PI / 180.0;
        const float L[3] = {(float)sin(angle), 0.0f, (float)fmax(cos(angle), 0.0)};
        float old[3];
        float new[3];
        ogl1_radiance(&p->ogl1, V, L, old);
        pbr_radiance(&p->pbr, PBR_CORRELATED, V, L, new);
        source[i] = luminance(p->is_from_ogl1 ? old : new);
        made[i] = luminance(p->is_from_ogl1 ? new : old);
    }
}

static bool make_panel(const pair *p, int view, arena *memory, chart_panel *panel)
{
    double *x = arena_alloc(memory, STEPS, sizeof *x);
    double *source = arena_alloc(memory, STEPS, sizeof *source);
    double *made = arena_alloc(memory, STEPS, sizeof *made);
    chart_curve *curves = arena_zalloc(memory, 2, sizeof *curves);
    if (!x || !source || !made || !curves)
        return false;
    sample(p, VIEW_ANGLES[view], x, source, made);
    curves[0] =
        (chart_curve){.name = p->is_from_ogl1 ? "OpenGL 1" : "PBR", .count = STEPS, .x = x, .y = source};
    curves[1] = (chart_curve){.name = p->is_from_ogl1 ? "PBR" : "OpenGL 1",
                              .count = STEPS,
                              .x = x,
                              .y = made,
                              .style = {.color = 1, .dash = 1}};
    *panel = (chart_panel){.kind = CHART_XY,
                           .title = VIEW_TITLES[view],
                           .note = "",
                           .x = {.label = "light, degrees", .has_range = true, .minimum = -90, .maximum = 90},
                           .y = {.label = view == 0 ? "luminance" : ""},
                           .curve_count = 2,
                           .curves = curves,
                           .has_legend = view == 0};
    return true;
}

/* An SVG file: luminance under light of 1 at view angles of 0, 30 and 60 degrees, the source solid, the
 * result dashed. For materials with has_surfaces. A block of mem_alloc(). Fails as chart_draw(). */
static facet_result draw_curves(const facet_scene *scene, uint32_t material, unsigned char **bytes,
                                size_t *size, facet_error *error)
{
    const material_conversion *m = &scene->conversion->materials[material];
    pair p = {.is_from_ogl1 = scene->conversion->to != FACET_MATERIAL_MODEL_OGL1};
    p.ogl1 = m->ogl1_surface;
    p.pbr = m->pbr_surface;
    *bytes = NULL;
    *size = 0;
    arena *memory = arena_create(&scene->allocator);
    chart_panel *panels = memory ? arena_zalloc(memory, VIEWS, sizeof *panels) : NULL;
    bool is_made = panels != NULL;
    for (int i = 0; i < VIEWS && is_made; i++)
        is_made = make_panel(&p, i, memory, &panels[i]);
    const chart c = {.memory = memory,
                     .title = "",
                     .width = CURVES_WIDTH,
                     .height = CURVES_HEIGHT,
                     .columns = VIEWS,
                     .panel_count = VIEWS,
                     .panels = panels};
    facet_result result = is_made
                              ? chart_draw(&c, FACET_PLOT_FORMAT_SVG, &scene->allocator, bytes, size, error)
                              : fail_memory(error, "report", 0);
    arena_destroy(memory);
    return result;
}

enum { SPHERE_SIZE = 128 };
static const char *const GRADES[] = {"good", "fair", "poor", "bad"};

typedef struct page {
    const facet_scene *scene;
    const scene_conversion *conversion;
    text *out;
    sphere_stage *stage; /* NULL: no legacy materials to show */
    bool has_curves;     /* false: cairo is missing */
} page;

static bool has_error(const facet_conversion *c)
{
    return !isnan(c->error_graded);
}

/* ---- the head ---- */

static void add_summary(const page *p)
{
    uint32_t grades[4] = {0}, graded = 0;
    double sum = 0.0;
    for (uint32_t i = 0; i < p->conversion->material_count; i++) {
        const facet_conversion *c = &p->conversion->materials[i].summary;
        if (!has_error(c))
            continue;
        grades[c->grade]++;
        sum += c->error;
        graded++;
    }
    text_add(p->out, "<h1>Materials of ");
    text_add_html(p->out, p->scene->source);
    text_addf(p->out, "</h1>\n<p class=\"dim\">%u converted to %s by facet %s</p>\n<p>",
              p->conversion->material_count,
              p->conversion->to == FACET_MATERIAL_MODEL_OGL1                  ? "OpenGL 1"
              : p->conversion->to == FACET_MATERIAL_MODEL_SPECULAR_GLOSSINESS ? "specular-glossiness"
                                                                              : "physically based ones",
              facet_version());
    for (int i = 0; i < 4; i++)
        text_addf(p->out, "<b class=\"%s\">%u %s</b>%s", GRADES[i], grades[i], GRADES[i],
                  i < 3 ? " &middot; " : "");
    if (graded) {
        text_add(p->out, " &middot; mean error <b>");
        html_number(p->out, sum / graded);
        text_add(p->out, "</b>");
    }
    text_add(p->out,
             "</p>\n<p class=\"dim\">E is the difference of the radiance of both models, as a share of "
             "that of the source (root mean square over lights from the hemisphere and views at 0&deg;, "
             "30&deg; and 60&deg;). E on a screen is the same with both clamped to what a screen shows. E "
             "as drawn is the same with OpenGL 1 as its programs draw it: they add display values, not "
             "light, which darkens the shadow side. The grade is of E as drawn where the conversion aims "
             "at such a program, else of E on a screen: below 0.05 good, 0.12 fair, 0.30 poor. \"Without "
             "extensions\" is the error in viewers that lack them, \"usual formula\" that of what most "
             "converters write.</p>\n");
}

static void add_warnings(text *out, const conversion_warning *warnings, uint32_t count)
{
    if (count == 0)
        return;
    text_add(out, "<ul>\n");
    for (uint32_t i = 0; i < count; i++) {
        text_add(out, "<li>");
        text_add_html(out, warnings[i].text);
        text_add(out, " <code class=\"dim\">");
        text_add_html(out, warnings[i].code);
        text_add(out, "</code></li>\n");
    }
    text_add(out, "</ul>\n");
}

/* ---- one material ---- */

static void begin_row(text *out, const char *name)
{
    text_addf(out, "<tr><th>%s</th><td>", name);
}

/* A row that marks the values above as factors. */
static void add_texture_row(text *out)
{
    text_add(out, "<tr><th></th><td class=\"dim\">times a texture</td></tr>\n");
}

static void add_color(text *out, const char *name, const float color[3], bool is_linear)
{
    begin_row(out, name);
    text_add(out, "<span class=\"swatch\" style=\"background:rgb(");
    for (int i = 0; i < 3; i++) {
        double c = fmin(fmax((double)color[i], 0.0), 1.0);
        text_addf(out, "%s%.0f", i ? "," : "", 255.0 * (is_linear ? srgb_encode(c) : c));
    }
    text_add(out, ")\"></span>");
    for (int i = 0; i < 3; i++) {
        text_add(out, i ? " " : "");
        html_number(out, (double)color[i]);
    }
    text_add(out, "</td></tr>\n");
}

static void add_number(text *out, const char *name, float value)
{
    begin_row(out, name);
    html_number(out, (double)value);
    text_add(out, "</td></tr>\n");
}

static bool is_black(const float color[3])
{
    return color[0] == 0.0f && color[1] == 0.0f && color[2] == 0.0f;
}

static void add_legacy_values(text *out, const legacy_material *m, facet_legacy_colors colors)
{
    bool is_linear = colors == FACET_LEGACY_COLORS_LINEAR;
    text_addf(out, "<table><tr><th colspan=\"2\">OpenGL 1, %s values</th></tr>\n",
              is_linear ? "linear" : "sRGB");
    if (!is_black(m->ambient))
        add_color(out, "ambient", m->ambient, is_linear);
    add_color(out, "diffuse", m->diffuse, is_linear);
    if (legacy_has_map(m, LEGACY_DIFFUSE_MAP))
        add_texture_row(out);
    add_color(out, "specular", m->specular, is_linear);
    if (legacy_has_map(m, LEGACY_SPECULAR_MAP))
        add_texture_row(out);
    add_number(out, "shininess", m->shininess);
    if (legacy_has_map(m, LEGACY_SHININESS_MAP))
        add_texture_row(out);
    if (!is_black(m->emission))
        add_color(out, "emission", m->emission, is_linear);
    if (m->opacity != 1.0f)
        add_number(out, "opacity", m->opacity);
    if (m->illum >= 0)
        add_number(out, "illum", (float)m->illum);
    if (!m->is_lit)
        text_add(out, "<tr><th>lit</th><td>no</td></tr>\n");
    text_add(out, "</table>\n");
}

static void add_pbr_values(text *out, const char *title, const scene_material *m)
{
    text_addf(out, "<table><tr><th colspan=\"2\">%s</th></tr>\n", title);
    add_color(out, "base color", m->base_color, true);
    if (scene_material_has(m, SCENE_BASE_COLOR_TEXTURE))
        add_texture_row(out);
    if (m->extensions & SCENE_SPECULAR_GLOSSINESS) {
        add_number(out, "glossiness", m->glossiness);
    } else {
        add_number(out, "metallic", m->metallic);
        add_number(out, "roughness", m->perceptual_roughness);
        if (scene_material_has(m, SCENE_METALLIC_ROUGHNESS_TEXTURE))
            add_texture_row(out);
    }
    if (m->extensions & SCENE_SPECULAR)
        add_number(out, "specular factor", m->specular);
    if (m->extensions & (SCENE_SPECULAR | SCENE_SPECULAR_GLOSSINESS))
        add_color(out, "specular color", m->specular_color, true);
    if (scene_material_has(m, SCENE_SPECULAR_TEXTURE) || scene_material_has(m, SCENE_SPECULAR_COLOR_TEXTURE))
        add_texture_row(out);
    if (m->extensions & SCENE_IOR)
        add_number(out, "ior", m->ior);
    if (!is_black(m->emissive))
        add_color(out, "emissive", m->emissive, true);
    if (m->base_color[3] != 1.0f)
        add_number(out, "alpha", m->base_color[3]);
    if (m->transmission > 0.0f)
        add_number(out, "transmission", m->transmission);
    if (m->clearcoat > 0.0f)
        add_number(out, "clearcoat", m->clearcoat);
    if (m->extensions & SCENE_UNLIT)
        text_add(out, "<tr><th>unlit</th><td>yes</td></tr>\n");
    text_add(out, "</table>\n");
}

/* Source and result, in this order. */
static void add_values(const page *p, const material_conversion *m)
{
    bool has_legacy = scene_has_legacy_materials(p->scene) && !m->source;
    bool is_back = p->conversion->to == FACET_MATERIAL_MODEL_OGL1;
    if (m->source)
        add_pbr_values(p->out, "glTF, source", m->source);
    if (has_legacy && !is_back)
        add_legacy_values(p->out, &m->legacy, p->scene->legacy->colors);
    add_pbr_values(p->out, "glTF, linear values", &m->pbr);
    if (has_legacy && is_back)
        add_legacy_values(p->out, &m->legacy, p->scene->legacy->colors);
}

static void add_errors(text *out, const facet_conversion *c)
{
    const struct {
        const char *name;
        double value;
    } rows[] = {{"E", c->error},
                {"E on a screen", c->error_display},
                {"E as drawn", c->error_drawn},
                {"seen at 0&deg;", c->error_views[0]},
                {"seen at 30&deg;", c->error_views[1]},
                {"seen at 60&deg;", c->error_views[2]},
                {"without extensions", c->error_core},
                {"usual formula", c->error_naive}};
    text_addf(out, "<table><tr><th colspan=\"2\">error</th></tr>\n<tr><th>method</th><td>%s, %s</td></tr>\n",
              c->method, c->profile);
    if (has_error(c) && !isnan(c->error_drawn) && c->grade_drawn != c->grade)
        text_addf(out, "<tr><th>as drawn</th><td><span class=\"grade %s\">%s</span></td></tr>\n",
                  GRADES[c->grade_drawn], GRADES[c->grade_drawn]);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (isnan(rows[i].value))
            continue;
        text_addf(out, "<tr><th>%s</th><td class=\"n\">", rows[i].name);
        html_number(out, rows[i].value);
        text_add(out, "</td></tr>\n");
    }
    text_add(out, "</table>\n");
}

static facet_result add_spheres(page *p, uint32_t material, facet_error *error)
{
    static const char *const captions[SPHERE_STYLE_COUNT] = {"OpenGL 1, on its screen",
                                                             "OpenGL 1, in linear light", "glTF"};
    bool is_back = p->conversion->to == FACET_MATERIAL_MODEL_OGL1; /* the source comes first */
    for (int i = 0; i < SPHERE_STYLE_COUNT; i++) {
        int style = is_back ? SPHERE_STYLE_COUNT - 1 - i : i;
        unsigned char *bytes = NULL;
        size_t size = 0;
        TRY(sphere_draw(p->stage, material, (sphere_style)style, 2 * SPHERE_SIZE, &bytes, &size, error));
        text_add(p->out, "<figure>");
        html_image(p->out, "image/png", bytes, size, SPHERE_SIZE, SPHERE_SIZE, captions[style]);
        text_addf(p->out, "<figcaption>%s</figcaption></figure>\n", captions[style]);
        mem_free(bytes);
    }
    return FACET_OK;
}

/* Without cairo a line above says so once. */
static facet_result add_curves(page *p, uint32_t material, facet_error *error)
{
    unsigned char *bytes = NULL;
    size_t size = 0;
    facet_error why = {0};
    if (!p->has_curves)
        return FACET_OK;
    facet_result result = draw_curves(p->scene, material, &bytes, &size, &why);
    if (result == FACET_ERROR_MEMORY)
        return fail(error, result, "%s", why.message);
    p->has_curves = result == FACET_OK;
    if (!p->has_curves) {
        text_add(p->out, "<p class=\"dim\">No curves: ");
        text_add_html(p->out, why.message);
        text_add(p->out, "</p>\n");
        return FACET_OK;
    }
    text_add(p->out, "<div class=\"curves\">");
    html_image(p->out, "image/svg+xml", bytes, size, CURVES_WIDTH, CURVES_HEIGHT,
               "luminance of both models over the angle of the light");
    text_add(p->out, "</div>\n");
    mem_free(bytes);
    return FACET_OK;
}

static facet_result add_material(page *p, uint32_t material, bool has_images, facet_error *error)
{
    const material_conversion *m = &p->conversion->materials[material];
    facet_result result = FACET_OK;
    text_add(p->out, "<section class=\"card\">\n<h2>");
    text_add_html(p->out, m->summary.name[0] ? m->summary.name : "(no name)");
    if (has_error(&m->summary))
        text_addf(p->out, "<span class=\"grade %s\">%s</span>", GRADES[m->summary.grade],
                  GRADES[m->summary.grade]);
    text_add(p->out, "</h2>\n<div class=\"row\">\n");
    if (has_images && p->stage)
        result = add_spheres(p, material, error);
    text_add(p->out, "</div>\n<div class=\"row\">\n");
    add_values(p, m);
    add_errors(p->out, &m->summary);
    text_add(p->out, "</div>\n");
    if (result == FACET_OK && has_images && m->has_surfaces)
        result = add_curves(p, material, error);
    add_warnings(p->out, m->warnings, m->warning_count);
    text_add(p->out, "</section>\n");
    return result;
}

/* ---- the page ---- */

typedef struct rank {
    double error;
    uint32_t material;
} rank;

static int compare_ranks(const void *a, const void *b)
{
    const rank *x = a, *y = b;
    if (x->error != y->error)
        return x->error > y->error ? -1 : 1;
    return x->material < y->material ? -1 : 1;
}

static facet_result add_materials(page *p, facet_error *error)
{
    uint32_t count = p->conversion->material_count;
    rank *ranks = mem_alloc(&p->scene->allocator, count, sizeof *ranks);
    if (!ranks)
        return fail_memory(error, "report", count * sizeof *ranks);
    for (uint32_t i = 0; i < count; i++) {
        const facet_conversion *c = &p->conversion->materials[i].summary;
        ranks[i] = (rank){has_error(c) ? c->error_graded : -1.0, i};
    }
    qsort(ranks, count, sizeof *ranks, compare_ranks);
    facet_result result = FACET_OK;
    for (uint32_t i = 0; i < count && result == FACET_OK && !p->out->has_failed; i++) {
        if (i == REPORT_IMAGES)
            text_addf(p->out, "<p class=\"dim\">The remaining %u have no images.</p>\n", count - i);
        result = add_material(p, ranks[i].material, i < REPORT_IMAGES, error);
    }
    mem_free(ranks);
    return result;
}

facet_result report_html(const facet_scene *scene, text *out, facet_error *error)
{
    static const scene_conversion none = {0};
    page p = {.scene = scene,
              .conversion = scene->conversion ? scene->conversion : &none,
              .out = out,
              .has_curves = true};
    facet_result result = FACET_OK;
    if (scene_has_legacy_materials(scene))
        result = sphere_stage_create(scene, &p.stage, error);
    html_begin(out, "Converted materials");
    add_summary(&p);
    add_warnings(out, p.conversion->warnings, p.conversion->warning_count);
    if (result == FACET_OK)
        result = add_materials(&p, error);
    html_end(out);
    sphere_stage_destroy(p.stage);
    return result;
}
