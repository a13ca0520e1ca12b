/* camera_matrix.c - see camera_matrix.h. */
#include "cli/render/camera_matrix.h"

#include <math.h>
#include <string.h>

#include "cli/shared/failure.h"
#include "cli/shared/value.h"

static const double SKEWEST = 1e-3; /* cosine between axes, of matrices that were printed with few digits */

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* The inverse of an affine matrix, by cofactors. False: there is none. */
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

/* What the numbers are read as: 16 of them, with or without the brackets of JSON. */
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

/* Unit axes of the camera, and whether they are a rotation. */
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
    double away = fmax(1.0, sqrt(dot(m + 12, m + 12))); /* far enough for the digits of a float */
    for (int i = 0; i < 3; i++) {
        out->eye[i] = m[12 + i];
        out->target[i] = m[12 + i] - away * axes[2][i];
        out->has_target[i] = true;
        out->up[i] = (float)axes[1][i];
    }
    out->has_eye = true;
    return FACET_OK;
}

facet_result camera_matrix_read(const command_line *c, render_options *out, facet_error *error)
{
    static const option_id others[] = {OPT_CAMERA, OPT_ORBIT, OPT_EYE,     OPT_TARGET,
                                       OPT_UP,     OPT_ORTHO, OPT_FRAMING, OPT_TURNTABLE};
    bool is_view = is_given(c, OPT_VIEW_MATRIX);
    option_id id = is_view ? OPT_VIEW_MATRIX : OPT_CAMERA_MATRIX;
    if (!is_given(c, id))
        return FACET_OK;
    if (is_view && is_given(c, OPT_CAMERA_MATRIX))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "--view-matrix: it does not go together with --camera-matrix; give one of them");
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (is_given(c, others[i]))
            return fail(error, FACET_ERROR_ARGUMENT,
                        "--%s: it does not go together with --%s; give one of them",
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
