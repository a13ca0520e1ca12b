/* ocean_settings.c - see ocean_settings.h. */
#include "ocean_settings.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/result.h"
#include "image/srgb.h"

static const double DEGREE = 0.017453292519943295; /* pi / 180 */

/* The options that a page can set: those that change an image drawn by OpenGL, without a file. */
static const option_id settable[] = {
    OPT_PRESET,       OPT_WIND,     OPT_FETCH,        OPT_SWELL,    OPT_SPECTRUM, OPT_SPREADING,
    OPT_CHOPPINESS,   OPT_SEED,     OPT_TILE_SAMPLES, OPT_CASCADES, OPT_WATER,    OPT_CHLOROPHYLL,
    OPT_ABSORPTION,   OPT_SALINITY, OPT_TEMPERATURE,  OPT_IOR,      OPT_DEPTH,    OPT_BED_SLOPE,
    OPT_BED_COLOR,    OPT_SUN,      OPT_TURBIDITY,    OPT_EXPOSURE, OPT_EV100,    OPT_TONE_MAPPING,
    OPT_EYE_HEIGHT,   OPT_HEADING,  OPT_EYE,          OPT_TARGET,   OPT_FOV,      OPT_BEFORE,
    OPT_BEFORE_AFTER, OPT_STAGE,    OPT_ROUGHNESS,    OPT_NORMALS,  OPT_MASKING,  OPT_FRESNEL,
    OPT_NO_GLINTS,    OPT_NO_FOAM,  OPT_NO_CAUSTICS,  OPT_CLAMP,    OPT_SAMPLES,  OPT_TIME,
    OPT_LOOP};
enum { SETTABLE = sizeof settable / sizeof *settable };

static bool is_settable(const option *o)
{
    for (size_t i = 0; i < SETTABLE; i++)
        if (settable[i] == o->id)
            return true;
    return false;
}

/* ---- parsing ---- */

static facet_result give(command_line *line, option_id id, const char *text, facet_error *error)
{
    const option *o = option_find_id(&ocean_verb, id);
    return command_line_set(line, o, option_takes_value(o) ? text : NULL, SOURCE_COMMAND_LINE, error);
}

/* Parses all texts, as if they were a command line. */
static facet_result parse(ocean_settings *s, facet_error *error)
{
    command_line line = {.verb = &ocean_verb};
    ocean_options options;
    TRY(give(&line, OPT_OUTPUT, "sea.png", error));
    TRY(give(&line, OPT_RENDERER, "gl", error));
    for (int id = 0; id < OPTION_ID_COUNT; id++)
        if (s->texts[id])
            TRY(give(&line, (option_id)id, s->texts[id], error));
    TRY(ocean_options_read(&line, &options, error));
    s->line = line;
    s->run.options = options;
    s->run.base.line = &s->line;
    return FACET_OK;
}

facet_result ocean_settings_reset(ocean_settings *s, facet_error *error)
{
    for (int id = 0; id < OPTION_ID_COUNT; id++) {
        free(s->texts[id]);
        s->texts[id] = NULL;
    }
    return parse(s, error);
}

facet_result ocean_settings_set(ocean_settings *s, const char *name, const char *text, facet_error *error)
{
    const option *o = option_find(&ocean_verb, name, strlen(name));
    if (!o || !is_settable(o))
        return fail(error, FACET_ERROR_ARGUMENT, "%s: it is not an option of this page", name);
    char *next = text ? strdup(text) : NULL, *last = s->texts[o->id];
    if (text && !next)
        return fail_memory(error, "an option", strlen(text) + 1);
    s->texts[o->id] = next;
    facet_result result = parse(s, error);
    if (result != FACET_OK)
        s->texts[o->id] = last;
    free(result == FACET_OK ? last : next);
    return result;
}

/* ---- as text ---- */

void ocean_settings_write(const ocean_settings *s, text *out)
{
    text_json_begin_object(out, NULL);
    for (size_t i = 0; i < SETTABLE; i++)
        if (s->texts[settable[i]])
            text_json_string(out, option_find_id(&ocean_verb, settable[i])->name, s->texts[settable[i]]);
    text_json_end_object(out);
}

static void add_word(text *out, const char *word)
{
    static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789,.:+-_/%=";
    bool is_plain = *word && strspn(word, plain) == strlen(word);
    text_add(out, is_plain ? " " : " '");
    text_add(out, word);
    text_add(out, is_plain ? "" : "'");
}

void ocean_settings_write_command(const ocean_settings *s, double time_s, int width, int height, text *out)
{
    text_add(out, "facet ocean");
    for (size_t i = 0; i < SETTABLE; i++) {
        const option *o = option_find_id(&ocean_verb, settable[i]);
        const char *value = s->texts[o->id];
        if (!value || o->id == OPT_TIME)
            continue;
        text_addf(out, " --%s", o->name);
        if (option_takes_value(o))
            add_word(out, value);
    }
    if (time_s != 0.0)
        text_addf(out, " --time %.10g", time_s);
    text_addf(out, " --renderer gl --size %dx%d -o sea.png", width, height);
}

/* ---- help ---- */

static void write_help_of(const option *o, text *out)
{
    text_json_begin_object(out, o->name);
    text_json_string(out, "help", o->help);
    text_json_string(out, "argument", o->argument);
    text_json_string(out, "default", o->default_text);
    if (o->kind == OPTION_NUMBER || o->kind == OPTION_INTEGER) {
        text_json_float(out, "minimum", (float)o->minimum);
        text_json_float(out, "maximum", (float)o->maximum);
    }
    if (o->choices) {
        text_json_begin_array(out, "choices");
        for (const char *const *choice = o->choices; *choice; choice++)
            text_json_string(out, NULL, *choice);
        text_json_end_array(out);
    }
    text_json_end_object(out);
}

void ocean_settings_write_help(text *out)
{
    text_json_begin_object(out, NULL);
    for (size_t i = 0; i < SETTABLE; i++)
        write_help_of(option_find_id(&ocean_verb, settable[i]), out);
    text_json_end_object(out);
}

/* ---- values ---- */

/* Options have azimuths from +Z towards +X, descs angles from +X towards +Z. */
static double azimuth(float angle)
{
    return remainder(90.0 - round((double)angle / DEGREE * 1e3) * 1e-3, 360.0);
}

static double rounded_degrees(float angle)
{
    return round((double)angle / DEGREE * 1e3) * 1e-3;
}

static void write_waves(const facet_sea_desc *d, text *out)
{
    text_json_doubles(out, "wind", (const double[]){(double)d->wind_mps, azimuth(d->wind_direction_rad)}, 2);
    text_json_float(out, "fetch", d->fetch_m); /* null: without limit */
    text_json_doubles(out, "swell",
                      (const double[]){(double)d->swell.height_m, (double)d->swell.period_s,
                                       azimuth(d->swell.direction_rad)},
                      3);
    text_json_float(out, "choppiness", d->choppiness);
    text_json_float(out, "resolution", (float)d->resolution);
}

static void write_water(const facet_sea_desc *d, text *out)
{
    const facet_water *w = &d->water;
    int type = (int)w->kind - (int)FACET_WATER_KIND_JERLOV_I;
    const option *o = option_find_id(&ocean_verb, OPT_WATER);
    bool is_jerlov =
        type >= 0 && w->kind != FACET_WATER_KIND_COEFFICIENTS && w->kind != FACET_WATER_KIND_CHLOROPHYLL;
    text_json_string(out, "water", is_jerlov ? o->choices[type] : NULL);
    if (!is_jerlov)
        text_json_float(out, "chl", w->chlorophyll_mg_m3);
    text_json_float(out, "depth", (float)d->bed.depth_m > 0.0f ? (double)d->bed.depth_m : (double)INFINITY);
    text_json_doubles(out, "bed-slope", (const double[]){(double)d->bed.slope, azimuth(d->bed.direction_rad)},
                      2);
    char color[16];
    int code[3];
    for (int i = 0; i < 3; i++)
        code[i] = (int)lround(255.0 * srgb_encode((double)d->bed.albedo[i]));
    snprintf(color, sizeof color, "#%02x%02x%02x", code[0], code[1], code[2]);
    text_json_string(out, "bed-color", color);
}

void ocean_settings_write_values(const ocean_settings *s, text *out)
{
    const ocean_options *o = &s->run.options;
    text_json_begin_object(out, NULL);
    write_waves(&o->sea, out);
    write_water(&o->sea, out);
    text_json_doubles(
        out, "sun",
        (const double[]){rounded_degrees(o->sky.sun_elevation_rad), rounded_degrees(o->sky.sun_azimuth_rad)},
        2);
    text_json_float(out, "exposure", o->render.desc.exposure_ev);
    text_json_end_object(out);
}
