/* view_command.c - see view_command.h. Defaults of facet render are left out, for a readable line. */
#define _POSIX_C_SOURCE 200809L
#include "cli/view/view_command.h"

#include "cli/shared/output.h"
#include "cli/shared/shell_line.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEGREE 0.017453292519943295 /* pi / 180 */

/* ---- a growing list of options ---- */

void view_options_add(view_options *l, const option *o, const char *value)
{
    if (l->count == l->capacity) {
        size_t capacity = 2 * l->capacity + 16;
        view_option *grown = l->has_failed ? NULL : realloc(l->items, capacity * sizeof *grown);
        l->has_failed = !grown;
        if (!grown)
            return;
        l->items = grown;
        l->capacity = capacity;
    }
    char *copy = strdup(value);
    l->has_failed = l->has_failed || !copy;
    if (copy)
        l->items[l->count++] = (view_option){o, copy};
}

void view_options_remove(view_options *l, option_id id)
{
    size_t kept = 0;
    for (size_t i = 0; i < l->count; i++)
        if (l->items[i].option->id == id)
            free(l->items[i].value);
        else
            l->items[kept++] = l->items[i];
    l->count = kept;
}

void view_options_destroy(view_options *l)
{
    for (size_t i = 0; i < l->count; i++)
        free(l->items[i].value);
    free(l->items);
    *l = (view_options){0};
}

static void add_option(view_options *l, option_id id, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
static void add_option(view_options *l, option_id id, const char *format, ...)
{
    char value[4200];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(value, sizeof value, format, arguments);
    va_end(arguments);
    view_options_add(l, option_find_id(verb_find("render"), id), value);
}

/* Appends a choice by index, unless it is the first. */
static void add_choice(view_options *l, option_id id, int choice)
{
    const option *o = option_find_id(verb_find("render"), id);
    if (choice > 0)
        view_options_add(l, o, o->choices[choice]);
}

/* The conversion of an option's number to the renderer's. */
typedef double reading(double written);

static double read_float(double x)
{
    return (double)(float)x;
}

static double read_double(double x)
{
    return x;
}

static double read_degrees(double x)
{
    return (double)(float)(x * DEGREE);
}

static double read_percent(double x)
{
    return (double)(float)(x / 100.0);
}

static double read_factor(double x)
{
    return (double)(float)log2(x);
}

/* Writes decimals, with an exponent for tiny and huge values. */
static void write_digits(double value, int digits, char out[48])
{
    int exponent = value != 0.0 ? (int)floor(log10(fabs(value))) : 0;
    int decimals = digits - 1 - exponent;
    if (exponent < -4 || exponent > 9)
        snprintf(out, 48, "%.*g", digits, value);
    else
        snprintf(out, 48, "%.*f", decimals > 0 ? decimals : 0, value);
}

/* Writes the fewest digits near about that are read as wanted. */
static void write_number(double about, double wanted, reading *read, char out[48])
{
    if (wanted == read(0.0))
        about = 0.0; /* without a sign */
    for (int digits = 1; digits <= 17; digits++) {
        write_digits(about, digits, out);
        if (read(strtod(out, NULL)) == wanted)
            return;
    }
}

static void write_float(float x, char out[48])
{
    write_number((double)x, (double)x, read_float, out);
}

static void write_degrees(float radians, char out[48])
{
    write_number((double)radians / DEGREE, (double)radians, read_degrees, out);
}

/* Writes a coordinate of the file with the fewest digits that give the same position relative to the origin. */
static void write_coordinate(float x, double origin, char out[48])
{
    double place = origin + (double)x;
    if (place == 0.0)
        place = 0.0; /* without a sign */
    for (int digits = 1; digits <= 17; digits++) {
        write_digits(place, digits, out);
        if ((float)(strtod(out, NULL) - origin) == x)
            return;
    }
}

/* ---- parts of an image ---- */

static void add_float(view_options *l, option_id id, float x)
{
    char word[48];
    write_float(x, word);
    add_option(l, id, "%s", word);
}

static void add_degrees(view_options *l, option_id id, float radians)
{
    char word[48];
    write_degrees(radians, word);
    add_option(l, id, "%s", word);
}

/* An orbit whose distance is left to framing; nothing for the default one. */
static void add_framed_orbit(view_options *l, const facet_orbit *orbit)
{
    const facet_orbit usual = facet_orbit_default();
    char words[3][48];
    bool is_scaled = orbit->radius_scale != usual.radius_scale;
    if (!is_scaled && orbit->azimuth_rad == usual.azimuth_rad && orbit->polar_rad == usual.polar_rad)
        return;
    write_degrees(orbit->azimuth_rad, words[0]);
    write_degrees(orbit->polar_rad, words[1]);
    write_number(100.0 * (double)orbit->radius_scale, (double)orbit->radius_scale, read_percent, words[2]);
    add_option(l, OPT_ORBIT, is_scaled ? "%s,%s,%s%%" : "%s,%s", words[0], words[1], words[2]);
}

static void add_camera(view_options *l, const render_options *o, const facet_view_image *p)
{
    const facet_orbit *orbit = p->orbit;
    if (!orbit) {
        add_option(l, OPT_CAMERA, "%u", p->camera);
        return;
    }
    char words[3][48];
    if (orbit->radius > 0.0f) {
        write_degrees(orbit->azimuth_rad, words[0]);
        write_degrees(orbit->polar_rad, words[1]);
        write_float(orbit->radius, words[2]);
        add_option(l, OPT_ORBIT, "%s,%s,%s", words[0], words[1], words[2]);
    } else {
        add_framed_orbit(l, orbit);
    }
    for (int i = 0; i < 3; i++)
        write_coordinate(orbit->target[i], p->origin[i], words[i]);
    if (orbit->has_target)
        add_option(l, OPT_TARGET, "%s,%s,%s", words[0], words[1], words[2]);
    if (orbit->fov_y_rad != facet_orbit_default().fov_y_rad)
        add_degrees(l, OPT_FOV, orbit->fov_y_rad);
    if (orbit->is_orthographic)
        add_option(l, OPT_ORTHO, "%s", "");
    if (o->orbit.is_z_up)
        add_option(l, OPT_UP, "z");
}

static void add_light(view_options *l, const command_line *c, const facet_view_image *p)
{
    const facet_render_desc *d = p->render;
    const char *name = p->environment ? p->environment : option_text(c, OPT_ENV, NULL);
    if (name)
        add_option(l, OPT_ENV, "%s", name);
    if (d->environment_rotation_rad != 0.0f)
        add_degrees(l, OPT_ENV_ROTATION, d->environment_rotation_rad);
    if (d->environment_ev != 0.0f) {
        char factor[48];
        write_number(exp2((double)d->environment_ev), (double)d->environment_ev, read_factor, factor);
        add_option(l, OPT_ENV_INTENSITY, "%s", factor);
    }
    if (d->ignores_scene_lights)
        add_option(l, OPT_LIGHTS, "none");
    if (d->ground == FACET_GROUND_SHADOW)
        add_option(l, OPT_GROUND, "shadow");
}

static void add_background(view_options *l, const command_line *c, const facet_render_desc *d)
{
    if (d->background == FACET_BACKGROUND_TRANSPARENT)
        add_option(l, OPT_BACKGROUND, "transparent");
    else if (d->background == FACET_BACKGROUND_ENVIRONMENT)
        add_option(l, OPT_BACKGROUND, "env");
    else if (is_given(c, OPT_BACKGROUND)) /* the color is the given one, or white */
        add_option(l, OPT_BACKGROUND, "%s", option_text(c, OPT_BACKGROUND, "white"));
    if (d->background == FACET_BACKGROUND_ENVIRONMENT && d->background_blur > 0.0f)
        add_float(l, OPT_BACKGROUND_BLUR, d->background_blur);
}

static void add_color(view_options *l, const facet_render_desc *d)
{
    const option *o = option_find_id(verb_find("render"), OPT_TONE_MAPPING);
    if (d->exposure_ev != 0.0f)
        add_float(l, OPT_EXPOSURE, d->exposure_ev);
    if (d->tonemap != FACET_TONEMAP_NEUTRAL && d->shading == FACET_SHADING_GLTF)
        view_options_add(l, o, o->choices[d->tonemap]);
}

static void add_gl(view_options *l, const facet_gl_desc *gl)
{
    add_choice(l, OPT_CHANNEL, (int)gl->channel);
    add_choice(l, OPT_BRDF, (int)gl->brdf);
    add_choice(l, OPT_TRANSPARENCY, (int)gl->transparency);
    if (gl->has_shadows)
        add_option(l, OPT_SHADOWS, "%s", "");
    if (gl->bloom > 0.0f)
        add_float(l, OPT_BLOOM, gl->bloom);
}

static void add_rendering(view_options *l, const facet_render_desc *d)
{
    facet_renderer_info info = facet_renderer_get_info(d->renderer);
    bool is_path = info.features & FACET_RENDERER_FEATURE_PATH;
    add_option(l, OPT_RENDERER, "%s", info.name);
    add_choice(l, OPT_ENERGY, (int)d->energy);
    if (is_path || d->samples != 4)
        add_option(l, OPT_SAMPLES, "%u", d->samples);
    if (is_path && d->path.denoises)
        add_option(l, OPT_DENOISE, "%s", "");
    if (info.features & FACET_RENDERER_FEATURE_GL)
        add_gl(l, &d->gl);
}

static void add_pose(view_options *l, const command_line *c, const facet_pose_desc *p)
{
    const char *animation = option_text(c, OPT_ANIMATION, "");
    if (p->has_scene_index)
        add_option(l, OPT_SCENE, "%u", p->scene_index);
    if (p->has_variant)
        add_option(l, OPT_VARIANT, "%u", p->variant);
    if (p->animation_count == 0)
        return;
    if (p->animation_count > 1)
        add_option(l, OPT_ANIMATION, "%s", strcmp(animation, "all") == 0 ? animation : "all");
    else
        add_option(l, OPT_ANIMATION, "%u", p->animations[0]);
    char time[48];
    write_number(p->time_s, p->time_s, read_double, time);
    add_option(l, OPT_TIME, "%s", time);
}

/* ---- what no key changes ---- */

/* Whether an option is written above, or concerns the window only. */
static bool is_known(option_id id)
{
    return option_is_among(id, OPTION_IDS(VIEW_OPTIONS, OPT_SIZE, OPT_QUALITY, OPT_SAMPLES, OPT_RENDERER,
                                          OPT_DENOISE, OPT_THREADS, OPT_TIME_LIMIT, OPT_QUIET, OPT_VERBOSE,
                                          OPT_HELP, OPT_HELP_ALL, OPT_SCRIPT, OPT_HTML, OPT_NO_CLOBBER,
                                          OPT_TITLE, OPT_CONTROLS, OPT_JSON, OPT_CONFIG, OPT_ENV_CACHE));
}

/* Whether only path tracing accepts the option. */
static bool is_of_paths(option_id id)
{
    return option_is_among(id, OPTION_IDS(PATH_OPTIONS));
}

static void add_others(view_options *l, const command_line *c, bool is_path)
{
    const option *o;
    for (size_t i = 0; (o = option_at(c->verb, i)); i++) {
        bool is_left_out = is_known(o->id) || !is_given(c, o->id) || (is_of_paths(o->id) && !is_path);
        if (!is_left_out)
            add_option(l, o->id, "%s", option_text(c, o->id, ""));
    }
}

void view_options_of(const command_line *c, const render_options *options, const facet_view_image *p,
                     view_options *out)
{
    const facet_render_desc *d = p->render;
    add_rendering(out, d);
    add_camera(out, options, p);
    add_pose(out, c, &d->pose);
    add_light(out, c, p);
    add_background(out, c, d);
    add_color(out, d);
    add_others(out, c, facet_renderer_get_info(d->renderer).features & FACET_RENDERER_FEATURE_PATH);
}

/* A name with a leading dash would be an option; "-" is standard input. */
static void add_file(shell_line *l, const char *path)
{
    char word[4300];
    snprintf(word, sizeof word, "./%s", path);
    shell_line_add_word(l, path[0] == '-' && path[1] ? word : path);
}

char *view_command(const command_line *c, const render_options *options, const facet_view_image *p)
{
    shell_line l = {0};
    view_options list = {0};
    char stem[1024];
    char output[1100], size[32];
    if (!output_name_stem(p->model ? p->model : "facet", stem, sizeof stem))
        memcpy(stem, "model", 6);
    snprintf(output, sizeof output, "%s.png", stem);
    snprintf(size, sizeof size, "%ux%u", p->render->width, p->render->height);
    shell_line_add_word(&l, "facet");
    shell_line_add_word(&l, "render");
    if (p->model)
        add_file(&l, p->model);
    shell_line_add_word(&l, "-o");
    add_file(&l, output);
    add_option(&list, OPT_SIZE, "%s", size);
    view_options_of(c, options, p, &list);
    for (size_t i = 0; i < list.count; i++)
        shell_line_add_option(&l, list.items[i].option, list.items[i].value);
    bool has_failed = l.has_failed || list.has_failed;
    view_options_destroy(&list);
    if (!has_failed)
        return l.text;
    free(l.text);
    return NULL;
}
