/* material_fit.c - parameters of a measured BRDF by the Levenberg-Marquardt method within [0, 1]. See
 * material.h. */
#include <math.h>
#include <string.h>

#include "base/result.h"
#include "plot/material.h"
#include "plot/merl.h"
#include "plot/plot_build.h"

enum {
    PARAMETERS = 7, /* roughness; diffuse and specular color */
    VIEWS = 6,      /* 0 to 75 degrees */
    RINGS = 60,     /* polar angles of the half vector, spaced as the cells of the file */
    SPOKES = 8,     /* azimuths of the half vector, half a circle: BRDFs are isotropic */
    PER_VIEW = RINGS * SPOKES,
    RESIDUALS = VIEWS * PER_VIEW * 3,
    ITERATIONS = 40
};

typedef struct directions {
    float V[VIEWS][3];
    float L[VIEWS][PER_VIEW][3];
} directions;

typedef struct fit_state {
    facet_plot_model model;
    directions at;
    double target[RESIDUALS]; /* log(1 + f cos); NAN: excluded */
    double residual[RESIDUALS], trial[RESIDUALS];
    double jacobian[PARAMETERS][RESIDUALS];
    double values[PER_VIEW][3];
} fit_state;

static void make_directions(directions *at)
{
    for (int v = 0; v < VIEWS; v++) {
        double theta_v = (double)v * 15.0 * PLOT_DEGREE;
        float *V = at->V[v];
        plot_direction(theta_v, 0.0, V);
        for (int i = 0; i < PER_VIEW; i++) {
            double theta_h = merl_theta_h(((double)(i / SPOKES) + 0.5) * MERL_THETA_H / RINGS);
            float H[3];
            plot_direction(theta_h, ((double)(i % SPOKES) + 0.5) * PLOT_PI / SPOKES, H);
            double VdotH = 0.0;
            for (int c = 0; c < 3; c++)
                VdotH += (double)V[c] * (double)H[c];
            for (int c = 0; c < 3; c++)
                at->L[v][i][c] = (float)(2.0 * VdotH * (double)H[c] - (double)V[c]);
        }
    }
}

/* log(1 + f cos) of m in all directions, minus target if there is one. */
static void evaluate(fit_state *s, const material *m, const double *target, double *out)
{
    for (int v = 0; v < VIEWS; v++) {
        material_brdf_cos(m, s->at.V[v], PER_VIEW, (const float(*)[3])s->at.L[v], s->values);
        for (int i = 0; i < PER_VIEW; i++)
            for (int c = 0; c < 3; c++) {
                size_t k = (size_t)((v * PER_VIEW + i) * 3 + c);
                out[k] = log1p(fmax(s->values[i][c], 0.0)) - (target ? target[k] : 0.0);
            }
    }
}

/* The target without directions near the horizon and unmeasured ones. */
static void take_target(fit_state *s, const material *measured)
{
    const float lowest = (float)cos(80.0 * PLOT_DEGREE);
    for (int v = 0; v < VIEWS; v++) {
        material_brdf_cos(measured, s->at.V[v], PER_VIEW, (const float(*)[3])s->at.L[v], s->values);
        for (int i = 0; i < PER_VIEW; i++)
            for (int c = 0; c < 3; c++) {
                bool is_kept = s->at.L[v][i][2] > lowest && s->values[i][c] >= 0.0;
                s->target[(v * PER_VIEW + i) * 3 + c] = is_kept ? log1p(s->values[i][c]) : (double)NAN;
            }
    }
}

static material candidate(facet_plot_model model, const double p[PARAMETERS])
{
    material m = {.label = "", .energy = FACET_ENERGY_GLTF};
    if (model == FACET_PLOT_MODEL_PBR) {
        pbr_surface s = {.perceptual_roughness = (float)p[0], .specular = 1.0f};
        for (int c = 0; c < 3; c++) {
            s.base_color[c] = (float)p[1 + c];
            s.specular_color[c] = (float)p[4 + c];
        }
        m.parameters = material_from_pbr(&s);
    } else {
        ogl1_surface s = {.shininess = shininess_from_perceptual_roughness((float)p[0])};
        for (int c = 0; c < 3; c++) {
            s.diffuse[c] = (float)p[1 + c];
            s.specular[c] = (float)p[4 + c];
        }
        m.parameters = material_from_ogl1(&s);
    }
    return m;
}

/* Residuals of parameters into out; returns the sum of their squares. */
static double residuals(fit_state *s, const double p[PARAMETERS], double *out)
{
    material m = candidate(s->model, p);
    evaluate(s, &m, s->target, out);
    double sum = 0.0;
    for (int k = 0; k < RESIDUALS; k++) {
        if (isnan(s->target[k]))
            out[k] = 0.0;
        sum += out[k] * out[k];
    }
    return sum;
}

/* Differences towards the inside of [0, 1]; the single precision of shade/ needs steps of 1e-3. */
static void differentiate(fit_state *s, const double p[PARAMETERS])
{
    for (int j = 0; j < PARAMETERS; j++) {
        double moved[PARAMETERS];
        memcpy(moved, p, sizeof moved);
        double step = p[j] > 0.5 ? -1e-3 : 1e-3;
        moved[j] += step;
        residuals(s, moved, s->jacobian[j]);
        for (int k = 0; k < RESIDUALS; k++)
            s->jacobian[j][k] = (s->jacobian[j][k] - s->residual[k]) / step;
    }
}

/* Solves A x = b in place by Gaussian elimination with pivoting; A is positive definite except for rounding. */
static bool solve(double A[PARAMETERS][PARAMETERS], double b[PARAMETERS])
{
    for (int i = 0; i < PARAMETERS; i++) {
        int best = i;
        for (int r = i + 1; r < PARAMETERS; r++)
            if (fabs(A[r][i]) > fabs(A[best][i]))
                best = r;
        if (!(fabs(A[best][i]) > 1e-300))
            return false;
        for (int c = 0; c < PARAMETERS; c++) {
            double swap = A[i][c];
            A[i][c] = A[best][c];
            A[best][c] = swap;
        }
        double swap = b[i];
        b[i] = b[best];
        b[best] = swap;
        for (int r = 0; r < PARAMETERS; r++) {
            if (r == i)
                continue;
            double factor = A[r][i] / A[i][i];
            for (int c = i; c < PARAMETERS; c++)
                A[r][c] -= factor * A[i][c];
            b[r] -= factor * b[i];
        }
    }
    for (int i = 0; i < PARAMETERS; i++)
        b[i] /= A[i][i];
    return true;
}

/* Normal equations of the free parameters: those at a bound whose gradient points outwards stay. */
static bool step_of(const fit_state *s, const double p[PARAMETERS], double damping, double step[PARAMETERS])
{
    double A[PARAMETERS][PARAMETERS] = {{0}};
    for (int i = 0; i < PARAMETERS; i++) {
        double gradient = 0.0;
        for (int k = 0; k < RESIDUALS; k++)
            gradient += s->jacobian[i][k] * s->residual[k];
        step[i] = -gradient;
        for (int j = i; j < PARAMETERS; j++) {
            double sum = 0.0;
            for (int k = 0; k < RESIDUALS; k++)
                sum += s->jacobian[i][k] * s->jacobian[j][k];
            A[i][j] = A[j][i] = sum;
        }
    }
    for (int i = 0; i < PARAMETERS; i++) {
        bool is_held = (p[i] <= 0.0 && step[i] < 0.0) || (p[i] >= 1.0 && step[i] > 0.0);
        for (int j = 0; is_held && j < PARAMETERS; j++)
            A[i][j] = A[j][i] = 0.0;
        if (is_held || !(A[i][i] > 0.0)) {
            A[i][i] = 1.0;
            step[i] = 0.0;
        } else
            A[i][i] *= 1.0 + damping;
    }
    return solve(A, step);
}

/* Marquardt 1963, starting from p, which is replaced; returns the sum of squares. */
static double descend(fit_state *s, double p[PARAMETERS])
{
    double damping = 1e-2;
    double sum = residuals(s, p, s->residual);
    for (int iteration = 0; iteration < ITERATIONS && damping < 1e8; iteration++) {
        differentiate(s, p);
        bool is_better = false;
        double before = sum;
        while (!is_better && damping < 1e8) {
            double moved[PARAMETERS], step[PARAMETERS];
            if (!step_of(s, p, damping, step))
                return sum;
            for (int i = 0; i < PARAMETERS; i++) /* roughness 0.02 is narrower than the cells resolve */
                moved[i] = fmin(fmax(p[i] + step[i], i == 0 ? 0.02 : 0.0), 1.0);
            double trial = residuals(s, moved, s->trial);
            is_better = trial < sum;
            damping *= is_better ? 0.2 : 4.0;
            if (is_better) {
                sum = trial;
                memcpy(p, moved, sizeof moved);
                memcpy(s->residual, s->trial, sizeof s->residual);
            }
        }
        if (before - sum < 1e-9 * before)
            break;
    }
    return sum;
}

facet_result material_fit(const material *measured, facet_plot_model model, const facet_allocator *allocator,
                          facet_plot_material *out, double *rms, facet_error *error)
{
    fit_state *s = mem_alloc(allocator, 1, sizeof *s);
    if (!s)
        return fail_memory(error, "fit of a measured BRDF", sizeof *s);
    s->model = model;
    make_directions(&s->at);
    take_target(s, measured);
    double norm = 0.0;
    for (int k = 0; k < RESIDUALS; k++)
        norm += isnan(s->target[k]) ? 0.0 : s->target[k] * s->target[k];
    double best = HUGE_VAL;
    for (int start = 0; start < 4; start++) {
        static const double roughness[4] = {0.08, 0.2, 0.4, 0.75};
        double p[PARAMETERS] = {roughness[start], 0.3, 0.3, 0.3, 0.2, 0.2, 0.2};
        double sum = descend(s, p);
        if (sum < best) {
            best = sum;
            *out = candidate(model, p).parameters;
        }
    }
    *rms = norm > 0.0 ? sqrt(best / norm) : 0.0;
    mem_free(s);
    return FACET_OK;
}
