/* camera_options.c - the camera of the options: orbit, eye, matrix, without the lens. */
#include "cli/render/render_options.h"
#include "cli/shared/failure.h"
#include "cli/shared/value.h"

#include <math.h>
#include <string.h>
#include <strings.h>

#define DEGREE 0.017453292519943295 /* pi / 180 */

typedef enum part_kind { PART_AUTO, PART_NUMBER } part_kind;

/* A field of the list: a number with its unit, or auto. */
typedef struct part {
    part_kind kind;
    double number;
    char unit[4];
} part;

/* Scans the field at *text and its separator. False: not a field. */
static bool scan_part(const char **text, part *out)
{
    const char *at = *text + strspn(*text, " \t");
    *out = (part){0};
    if (strncasecmp(at, "auto", 4) == 0) {
        at += 4;
    } else {
        out->kind = PART_NUMBER;
        if (!scan_number(&at, &out->number))
            return false;
        size_t length = strcspn(at, ", \t");
        if (length >= sizeof out->unit)
            return false;
        memcpy(out->unit, at, length);
        at += length;
    }
    if (*at && !strchr(", \t", *at))
        return false;
    at += strspn(at, " \t");
    if (*at == ',') {
        at++;
        if (!at[strspn(at, " \t")]) /* nothing after the comma */
            return false;
    }
    *text = at;
    return true;
}

/* Converts number to rad or m by its unit; the first unit is the default. False: unknown unit. */
static bool to_si(part *p, const char *const *names, const double *factors)
{
    for (int i = 0; names[i]; i++)
        if (strcasecmp(p->unit, names[i]) == 0 || (i == 0 && !p->unit[0])) {
            p->number *= factors[i];
            return true;
        }
    return false;
}

static bool to_radians(part *p)
{
    static const char *const names[] = {"deg", "rad", NULL};
    static const double factors[] = {DEGREE, 1.0};
    return to_si(p, names, factors);
}

static bool to_metres(part *p)
{
    static const char *const names[] = {"m", "cm", "mm", NULL};
    static const double factors[] = {1.0, 1e-2, 1e-3};
    return to_si(p, names, factors);
}

static bool set_radius(part *p, facet_orbit *orbit)
{
    bool is_scale = strcmp(p->unit, "%") == 0;
    if ((!is_scale && !to_metres(p)) || !(p->number > 0.0))
        return false;
    orbit->radius = is_scale ? 0.0f : (float)p->number;
    if (is_scale)
        orbit->radius_scale = (float)(p->number / 100.0);
    return true;
}

bool orbit_parse(const char *text, facet_orbit *orbit)
{
    facet_orbit parsed = *orbit;
    for (int i = 0; i < 3 && (i == 0 || text[strspn(text, " \t")]); i++) {
        part p;
        if (!scan_part(&text, &p))
            return false;
        if (p.kind == PART_AUTO)
            continue;
        if (i < 2 && !to_radians(&p))
            return false;
        if (i == 0)
            parsed.azimuth_rad =
                (float)remainder(p.number, 360.0 * DEGREE); /* 390deg equals 30deg bit by bit */
        else if (i == 1 && p.number >= 0.0 && p.number <= 180.0 * DEGREE)
            parsed.polar_rad = (float)p.number;
        else if (i == 1 || !set_radius(&p, &parsed))
            return false;
    }
    if (text[strspn(text, " \t")])
        return false;
    *orbit = parsed;
    return true;
}

bool target_parse(const char *text, double target[3], bool is_given[3])
{
    if (strcasecmp(text, "auto") == 0) {
        is_given[0] = is_given[1] = is_given[2] = false;
        return true;
    }
    part parts[3];
    for (int i = 0; i < 3; i++)
        if (!scan_part(&text, &parts[i]) || (parts[i].kind == PART_NUMBER && !to_metres(&parts[i])))
            return false;
    if (*text)
        return false;
    for (int i = 0; i < 3; i++) {
        is_given[i] = parts[i].kind == PART_NUMBER;
        if (is_given[i])
            target[i] = parts[i].number;
    }
    return true;
}

static const double SKEWEST = 1e-3; /* cosine between axes, for matrices printed with few digits */

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* Inverts an affine matrix by cofactors. False: singular. */
static bool invert(const double m[16], double out[16])
{
    double rows[3][3];
    for (int i = 0; i < 3; i++)
        cross(m + (i + 1) % 3 * 4, m + (i + 2) % 3 * 4, rows[i]);
    double determinant = dot(m, rows[0]);
    if (!(fabs(determinant) > 0.0) || !isfinite(determinant))
        return false;
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++)
            out[4 * column + row] = rows[row][column] / determinant;
        out[12 + row] = -dot(rows[row], m + 12) / determinant;
        out[4 * row + 3] = 0.0;
    }
    out[15] = 1.0;
    return true;
}

/* Parses 16 numbers, with or without the brackets of JSON. */
static bool read_numbers(const char *text, double m[16])
{
    char plain[1024];
    size_t length = strlen(text);
    if (length >= sizeof plain)
        return false;
    memcpy(plain, text, length + 1);
    for (char *at = plain; (at = strpbrk(at, "[]")); at++)
        *at = ' ';
    return value_numbers(plain, 16, m);
}

/* Normalizes the axes of the camera. Returns what was expected if they are not a rotation, else NULL. */
static const char *find_axes(const double m[16], double axes[3][3])
{
    for (int i = 0; i < 3; i++) {
        double length = sqrt(dot(m + 4 * i, m + 4 * i));
        if (!(length > 0.0) || !isfinite(length))
            return "a matrix with three axes";
        for (int k = 0; k < 3; k++)
            axes[i][k] = m[4 * i + k] / length;
    }
    for (int i = 0; i < 3; i++)
        if (fabs(dot(axes[i], axes[(i + 1) % 3])) > SKEWEST)
            return "a camera's matrix: its axes are not at right angles";
    double third[3];
    cross(axes[0], axes[1], third);
    return dot(third, axes[2]) > 0.0 ? NULL : "a camera's matrix: it mirrors";
}

static facet_result set_camera(const command_line *c, option_id id, const double m[16], render_options *out,
                               facet_error *error)
{
    double axes[3][3];
    const char *expected = find_axes(m, axes);
    if (expected)
        return option_fail(c, id, expected, error);
    double away = fmax(1.0, sqrt(dot(m + 12, m + 12))); /* within the digits of a float */
    for (int i = 0; i < 3; i++) {
        out->eye[i] = m[12 + i];
        out->target[i] = m[12 + i] - away * axes[2][i];
        out->has_target[i] = true;
        out->up[i] = (float)axes[1][i];
    }
    out->has_eye = true;
    return FACET_OK;
}

/* --camera-matrix (from the camera's space to the world, as the matrix of a glTF node) or --view-matrix (its inverse): 16
 * numbers, column by column. Writes eye, target and up of out, if one is given. Fails with
 * FACET_ERROR_ARGUMENT, also for a matrix that is not a rotation with a translation, is mirrored, or is
 * written row by row. */
static facet_result camera_matrix_read(const command_line *c, render_options *out, facet_error *error)
{
    static const option_id others[] = {OPT_CAMERA, OPT_ORBIT, OPT_EYE,     OPT_TARGET,
                                       OPT_UP,     OPT_ORTHO, OPT_FRAMING, OPT_TURNTABLE};
    bool is_view = is_given(c, OPT_VIEW_MATRIX);
    option_id id = is_view ? OPT_VIEW_MATRIX : OPT_CAMERA_MATRIX;
    if (!is_given(c, id))
        return FACET_OK;
    if (is_view && is_given(c, OPT_CAMERA_MATRIX))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--view-matrix: it excludes --camera-matrix; give one of them");
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (is_given(c, others[i]))
            return fail(error, FACET_ERROR_ARGUMENT, "--%s: it excludes --%s; give one of them",
                        option_find_id(c->verb, id)->name, option_find_id(c->verb, others[i])->name);
    double m[16], inverse[16];
    if (!read_numbers(option_text(c, id, ""), m))
        return option_fail(c, id, "16 numbers, column by column", error);
    if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0)
        return option_fail(c, id,
                           m[12] == 0.0 && m[13] == 0.0 && m[14] == 0.0
                               ? "in column-major order, as in glTF (the translation is numbers 13 to 15)"
                               : "a matrix with the last row 0 0 0 1",
                           error);
    if (is_view && !invert(m, inverse))
        return option_fail(c, id, "a matrix that has an inverse", error);
    return set_camera(c, id, is_view ? inverse : m, out, error);
}

/* ---- camera ---- */

static facet_result read_orbit(const command_line *c, render_options *out, facet_error *error)
{
    facet_orbit *orbit = &out->orbit;
    *orbit = facet_orbit_default();
    orbit->is_z_up = option_choice(c, OPT_UP, 0) == 1;
    orbit->is_orthographic = is_given(c, OPT_ORTHO);
    orbit->includes_far_parts = option_choice(c, OPT_FRAMING, 0) == 1;
    const char *text = option_text(c, OPT_ORBIT, NULL);
    if (text && !orbit_parse(text, orbit))
        return option_fail(
            c, OPT_ORBIT,
            "AZIMUTH,POLAR,RADIUS such as 30,75,105% or \"30deg 75deg 2m\" (polar: 0 to 180 degrees)", error);
    text = option_text(c, OPT_TARGET, "auto");
    if (!target_parse(text, out->target, out->has_target))
        return option_fail(c, OPT_TARGET, "X,Y,Z in metres, or auto", error);
    text = option_text(c, OPT_FOV, "auto");
    double fov = (double)orbit->fov_y_rad;
    if (strcasecmp(text, "auto") != 0 &&
        (!value_angle(text, &fov) || fov < 0.1 * DEGREE || fov > 179.0 * DEGREE))
        return option_fail(c, OPT_FOV, "an angle from 0.1 to 179 degrees", error);
    orbit->fov_y_rad = (float)fov;
    return FACET_OK;
}

facet_result camera_options_read(const command_line *c, render_options *out, facet_error *error)
{
    static const option_id orbit_options[] = {OPT_ORBIT, OPT_TARGET, OPT_FOV,     OPT_EYE,
                                              OPT_UP,    OPT_ORTHO,  OPT_FRAMING, OPT_TURNTABLE};
    out->camera = option_text(c, OPT_CAMERA, NULL);
    for (size_t i = 0; out->camera && i < sizeof orbit_options / sizeof *orbit_options; i++)
        if (is_given(c, orbit_options[i]))
            return fail(error, FACET_ERROR_ARGUMENT,
                        "--camera: a camera of the file excludes --%s; give one of them",
                        option_find_id(c->verb, orbit_options[i])->name);
    TRY(read_orbit(c, out, error));
    out->turntable = (uint32_t)option_number(c, OPT_TURNTABLE, 0.0);
    out->has_eye = is_given(c, OPT_EYE);
    if (!out->has_eye)
        return camera_matrix_read(c, out, error);
    if (!value_numbers(option_text(c, OPT_EYE, ""), 3, out->eye))
        return option_fail(c, OPT_EYE, "X,Y,Z in metres", error);
    if (is_given(c, OPT_ORBIT) || out->turntable)
        return fail(error, FACET_ERROR_ARGUMENT, "--eye: it excludes --%s; give one of them",
                    out->turntable ? "turntable" : "orbit");
    return FACET_OK;
}
