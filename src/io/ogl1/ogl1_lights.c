/* ogl1_lights.c - reads lights as arguments of light3d() or as listed by scene3d(), and the fog of bg3d(). */
#include <math.h>
#include <string.h>

#include "io/ogl1/ogl1_reader.h"

enum { RGL_LIGHTS = 8, MAX_LIGHTS = 1024 };

static bool is_among(const char *key, const char *const *names, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(key, names[i]) == 0)
            return true;
    return false;
}

/* Reports unknown members, once per name. */
static void report_unknown(io_reader *r, const json_place *at, const char *what, const char *const *known,
                           size_t count)
{
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)at->value, key, value)
    {
        if (!is_among(key, known, count) && ogl1_member(at, key).value)
            io_warn(r, NULL, NULL, "\"%.60s\" is not a parameter of %s; it is dropped", key, what);
    }
}

static const char *const LIGHT_KEYS[] = {
    "theta",         "phi",           "x",        "y",      "z",         "ambient", "diffuse",   "specular",
    "viewpoint.rel", "viewpoint_rel", "vertices", "colors", "viewpoint", "finite",  "direction", "id",
    "type"};
static const char *const FOG_KEYS[] = {"fogtype",  "fogScale", "fogscale", "color", "colors", "col",
                                       "material", "sphere",   "back",     "id",    "type",   "centers"};

/* ---- lights ---- */

/* Unit vectors are kept to the bit, so that written files read back equal; others are normalized. */
static bool set_direction(io_reader *r, const json_place *at, const char *key, const float v[3],
                          legacy_light *out)
{
    double length =
        sqrt((double)v[0] * (double)v[0] + (double)v[1] * (double)v[1] + (double)v[2] * (double)v[2]);
    bool is_unit = fabs(length - 1.0) < 1e-6;
    if (!(length > 0.0))
        return io_fail(r, at, key, FACET_ERROR_INVALID, "is not a direction: its length is 0");
    for (int k = 0; k < 3; k++)
        out->position[k] = is_unit ? v[k] : (float)((double)v[k] / length);
    return true;
}

/* theta and phi in degrees; (0, 15) if both are absent. */
static void read_angles(io_reader *r, const json_place *at, legacy_light *out)
{
    const double to_rad = 3.14159265358979323846 / 180.0;
    double theta = 0.0;
    double phi = 15.0;
    ogl1_number(r, at, "theta", &theta);
    ogl1_number(r, at, "phi", &phi);
    /* Angles of many turns would lose precision as floats. */
    legacy_light_direction((float)(fmod(theta, 360.0) * to_rad), (float)(fmod(phi, 360.0) * to_rad),
                           out->position);
    for (int k = 0; k < 3; k++)
        out->position[k] += 0.0f; /* 0 times a negative cosine is -0, which JSON does not keep */
}

/* x alone may hold all three coordinates, as for xyz.coords(). False: there is no x. */
static bool read_point(io_reader *r, const json_place *at, legacy_light *out)
{
    json_place x = ogl1_member(at, "x");
    if (!x.value)
        return false;
    out->is_point = true;
    if (json_is_array(x.value))
        return ogl1_vector(r, at, "x", out->position);
    static const char *const axes[3] = {"x", "y", "z"};
    for (int k = 0; k < 3; k++)
        if (!ogl1_number_in(r, at, axes[k], -(double)SCENE_FARTHEST, (double)SCENE_FARTHEST,
                            &out->position[k]))
            return io_fail(r, at, axes[k], FACET_ERROR_INVALID, "is missing beside the other coordinates");
    return true;
}

static void read_position(io_reader *r, const json_place *at, legacy_light *out)
{
    float v[3];
    if (ogl1_vector(r, at, "vertices", v)) { /* of scene3d() */
        ogl1_bool(r, at, "finite", &out->is_point);
        if (out->is_point)
            memcpy(out->position, v, sizeof v);
        else
            set_direction(r, at, "vertices", v, out);
    } else if (ogl1_vector(r, at, "direction", v)) {
        set_direction(r, at, "direction", v, out);
    } else if (io_is_ok(r) && !read_point(r, at, out)) {
        read_angles(r, at, out);
    }
}

static void read_light_colors(io_reader *r, const json_place *at, legacy_light *out)
{
    static const char *const names[3] = {"ambient", "diffuse", "specular"};
    float *const colors[3] = {out->ambient, out->diffuse, out->specular};
    json_place rows = ogl1_member(at, "colors"); /* of scene3d() */
    if (rows.value && !(json_array_size(rows.value) == 3 && json_is_array(json_array_get(rows.value, 0)))) {
        io_fail(r, &rows, NULL, FACET_ERROR_INVALID, "must have three rows: ambient, diffuse, specular");
        return;
    }
    for (size_t k = 0; k < 3 && io_is_ok(r); k++) {
        float rgba[4];
        json_place row = io_get_element(&rows, k);
        if ((rows.value && ogl1_color_value(r, &row, rgba)) || ogl1_color(r, at, names[k], rgba))
            memcpy(colors[k], rgba, 3 * sizeof *rgba);
    }
}

static void read_light(io_reader *r, const json_place *at, legacy_light *out)
{
    *out = legacy_light_default();
    read_position(r, at, out);
    read_light_colors(r, at, out);
    static const char *const names[] = {"viewpoint.rel", "viewpoint_rel", "viewpoint"};
    for (size_t i = 0; i < 3; i++)
        ogl1_bool(r, at, names[i], &out->is_viewpoint_relative);
    if (io_is_ok(r))
        report_unknown(r, at, "light3d()", LIGHT_KEYS, sizeof LIGHT_KEYS / sizeof *LIGHT_KEYS);
}

/* Whether value is a single light, not a list of named ones. */
static bool is_light(const json_t *value)
{
    for (size_t i = 0; i < sizeof LIGHT_KEYS / sizeof *LIGHT_KEYS; i++) {
        const json_t *member = json_object_get(value, LIGHT_KEYS[i]);
        if (member && !json_is_object(member))
            return true;
    }
    return false;
}

void ogl1_read_lights(ogl1_document *d, const json_place *root)
{
    io_reader *r = &d->r;
    json_place at;
    if (!io_has_member(root, "lights"))
        return;
    ogl1_list list = ogl1_list_begin(r, root, "lights", is_light);
    d->has_lights = true;
    if (list.count == 0 && io_is_ok(r))
        io_warn(r, &list.at, NULL, "is empty; rgl's default light is used");
    if (list.count > RGL_LIGHTS)
        io_warn(r, &list.at, NULL, "has %zu lights; OpenGL 1 supports %d", list.count, RGL_LIGHTS);
    if (list.count > MAX_LIGHTS)
        io_fail(r, &list.at, NULL, FACET_ERROR_LIMIT, "has %zu lights, more than %d", list.count, MAX_LIGHTS);
    d->lights = io_alloc(r, "lights", list.count, sizeof *d->lights);
    while (ogl1_list_next(r, &list, &at))
        read_light(r, &at, &d->lights[d->light_count++]);
}

/* ---- fog ---- */

static void read_fog_color(io_reader *r, const json_place *at, legacy_fog *fog)
{
    float rgba[4];
    json_place material = ogl1_object(r, at, "material"); /* of scene3d() */
    if (ogl1_color(r, at, "color", rgba) || ogl1_color(r, at, "col", rgba) ||
        ogl1_color(r, &material, "color", rgba) || ogl1_color(r, at, "colors", rgba))
        memcpy(fog->color, rgba, sizeof fog->color);
}

static void read_one_fog(ogl1_document *d, const json_place *root, const char *key)
{
    static const char *const types[] = {"none", "linear", "exp", "exp2", NULL};
    io_reader *r = &d->r;
    json_place at = ogl1_object(r, root, key);
    int type = LEGACY_FOG_NONE;
    if (!at.value)
        return;
    if (!d->has_fog)
        d->fog = (legacy_fog){.scale = 1.0f};
    d->has_fog = true;
    if (ogl1_choice(r, &at, "fogtype", types, &type))
        d->fog.mode = (legacy_fog_mode)type;
    ogl1_number_in(r, &at, ogl1_member(&at, "fogScale").value ? "fogScale" : "fogscale", 1e-6, 1e6,
                   &d->fog.scale);
    read_fog_color(r, &at, &d->fog);
    if (io_is_ok(r))
        report_unknown(r, &at, "bg3d()", FOG_KEYS, sizeof FOG_KEYS / sizeof *FOG_KEYS);
}

/* "fog" takes precedence over "background". */
void ogl1_read_fog(ogl1_document *d, const json_place *root)
{
    read_one_fog(d, root, "background");
    read_one_fog(d, root, "fog");
}
