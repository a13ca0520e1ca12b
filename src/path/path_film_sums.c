/* path_film_sums.c - the sums of a path_film (path_film_state.h): samples in fixed point, their means and deviations. */
#include "path/path_film_state.h"

#include <math.h>
#include <string.h>

#include "base/result.h"

__extension__ typedef unsigned __int128 wide;

enum { LIGHT_BITS = 56, SQUARE_BITS = 60, SHARE_BITS = 32, HALF_SQUARE_BITS = SQUARE_BITS / 2 };
static const float LARGEST_LIGHT = 0x1p46f, LARGEST_SQUARED = 0x1p21f, LARGEST_SHARE = 64.0f;
static const double LIGHT_UNIT = 0x1p-56, SQUARE_UNIT = 0x1p-60, SHARE_UNIT = 0x1p-32;

/* ---- samples in fixed point ---- */

static float limit(float x, float most)
{
    return x < most ? (x > -most ? x : -most) : most;
}

/* A finite float as mantissa * 2^exponent, without its sign. */
static uint64_t split(float x, int *exponent)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    uint32_t e = bits >> 23 & 255;
    *exponent = (e ? (int)e : 1) - 150;
    return (bits & 0x7fffff) | (e ? 0x800000 : 0);
}

/* m * 2^exponent, rounded down. */
static path_fixed shift(uint64_t m, int exponent)
{
    return exponent >= 0 ? (path_fixed)m << exponent : exponent > -64 ? (path_fixed)(m >> -exponent) : 0;
}

static path_fixed light_of(float x)
{
    int exponent;
    uint64_t m = split(limit(x, LARGEST_LIGHT), &exponent);
    path_fixed size = shift(m, exponent + LIGHT_BITS);
    return x < 0.0f ? -size : size;
}

/* Adds x^2. Returns whether that is above the largest square. */
static bool add_square(path_fixed *sum, float x)
{
    int exponent;
    uint64_t m = split(limit(x, LARGEST_SQUARED), &exponent);
    *sum += shift(m * m, 2 * exponent + SQUARE_BITS);
    return x > LARGEST_SQUARED || x < -LARGEST_SQUARED;
}

static int64_t share_of(float x)
{
    return (int64_t)((double)limit(x, LARGEST_SHARE) * 0x1p32);
}

static void add_ground(path_ground *g, const path_sample *s)
{
    static const float weights[3] = {0.2126f, 0.7152f, 0.0722f};
    float open = 0.0f, lit = 0.0f;
    bool is_there = false;
    for (int c = 0; c < 3; c++) {
        is_there = is_there || s->ground_lit[c] != 0.0f || s->ground_open[c] != 0.0f;
        open += weights[c] * limit(s->ground_open[c], LARGEST_LIGHT);
        lit += weights[c] * limit(s->ground_lit[c], LARGEST_LIGHT);
    }
    if (!is_there)
        return;
    g->samples++;
    g->open += light_of(open);
    g->blocked += light_of(open - lit);
    g->is_saturated |= add_square(&g->square, open - lit);
}

void path_pixel_add(path_pixel *p, path_ground *ground, const path_sample *s)
{
    p->samples++;
    for (int c = 0; c < 3; c++) {
        p->color[c] += light_of(s->radiance[c]);
        p->is_saturated |= add_square(&p->square[c], s->radiance[c]);
        p->albedo[c] += share_of(s->albedo[c]);
        p->normal[c] += share_of(s->normal[c]);
    }
    p->opacity += share_of(s->opacity);
    p->filter_excess += share_of(s->filter_excess);
    if (ground)
        add_ground(ground, s);
}

/* ---- sums of sums ---- */

static void add_pixel(path_pixel *p, const path_pixel *q)
{
    for (int c = 0; c < 3; c++) {
        p->color[c] += q->color[c];
        p->square[c] += q->square[c];
        p->albedo[c] += q->albedo[c];
        p->normal[c] += q->normal[c];
    }
    p->opacity += q->opacity;
    p->filter_excess += q->filter_excess;
    p->samples += q->samples;
    p->is_saturated |= q->is_saturated;
}

static void add_ground_sums(path_ground *g, const path_ground *h)
{
    g->open += h->open;
    g->blocked += h->blocked;
    g->square += h->square;
    g->samples += h->samples;
    g->is_saturated |= h->is_saturated;
}

bool path_film_add_film(path_film *f, const path_film *other)
{
    size_t count = (size_t)f->width * f->height;
    for (size_t i = 0; i < count; i++) {
        if (f->pixels[i].samples + other->pixels[i].samples > PATH_FILM_MAX_SAMPLES)
            return false;
        add_pixel(&f->pixels[i], &other->pixels[i]);
        if (f->ground)
            add_ground_sums(&f->ground[i], &other->ground[i]);
    }
    path_film_set_dropped(f, path_film_dropped(f) + path_film_dropped(other));
    return true;
}

/* ---- what sums can be ---- */

static bool is_light(path_fixed sum, uint32_t samples)
{
    path_fixed most = ((path_fixed)samples << (LIGHT_BITS + 46)) + 1;
    return sum <= most && sum >= -most;
}

static bool is_square(path_fixed sum, uint32_t samples)
{
    return sum >= 0 && sum <= (path_fixed)samples << (SQUARE_BITS + 42);
}

static bool is_share(int64_t sum, uint32_t samples)
{
    int64_t most = (int64_t)samples << (SHARE_BITS + 6);
    return sum <= most && sum >= -most;
}

static bool is_sound_ground(const path_ground *g, const path_pixel *p)
{
    return g->samples <= p->samples && g->is_saturated <= 1 && !g->unused[0] && !g->unused[1] &&
           is_light(g->open, g->samples) && is_light(g->blocked, g->samples) &&
           is_square(g->square, g->samples);
}

static bool is_sound_pixel(const path_pixel *p)
{
    uint32_t n = p->samples;
    bool is = n <= PATH_FILM_MAX_SAMPLES && p->is_saturated <= 1 && !p->unused[0] && !p->unused[1];
    for (int c = 0; c < 3 && is; c++)
        is = is_light(p->color[c], n) && is_square(p->square[c], n) && is_share(p->albedo[c], n) &&
             is_share(p->normal[c], n);
    return is && is_share(p->opacity, n) && is_share(p->filter_excess, n);
}

bool path_film_is_sound(const path_film *f)
{
    for (size_t i = 0; i < (size_t)f->width * f->height; i++)
        if (!is_sound_pixel(&f->pixels[i]) || (f->ground && !is_sound_ground(&f->ground[i], &f->pixels[i])))
            return false;
    return true;
}

/* ---- means and deviations ---- */

static double mean_of(path_fixed sum, uint32_t samples)
{
    return samples ? (double)sum / (double)samples * LIGHT_UNIT : 0.0;
}

/* The mean of (x - mean)^2, of n samples with these sums. With m, the mean in units of 2^-30, it is
 *     (sum of x^2 - 2 m sum of x + n m^2) / n - (mean - m)^2,
 * where the first two products are computed modulo 2^128 in units of 2^-60, in which the whole fits: nothing cancels. */
static double spread_of(path_fixed square, path_fixed sum, uint32_t n, bool is_saturated)
{
    if (n == 0)
        return 0.0;
    double mean = mean_of(sum, n);
    if (is_saturated)
        return fmax((double)square / (double)n * SQUARE_UNIT - mean * mean, 0.0);
    enum { REST = LIGHT_BITS - HALF_SQUARE_BITS };
    path_fixed coarse = sum >> REST, m = coarse / (path_fixed)n;
    path_fixed rest = sum - coarse * ((path_fixed)1 << REST);
    wide whole = (wide)square - 2 * (wide)m * (wide)coarse + (wide)n * (wide)m * (wide)m;
    double m_light = (double)m * 0x1p-30;
    double deviations = (double)(path_fixed)whole * SQUARE_UNIT - 2.0 * m_light * ((double)rest * LIGHT_UNIT);
    double offset = (double)(sum - m * ((path_fixed)1 << REST) * (path_fixed)n) / (double)n * LIGHT_UNIT;
    double spread = deviations / (double)n - offset * offset;
    return spread > 0x1p-58 ? spread : 0.0; /* less is the rounding of squares */
}

float path_pixel_mean(const path_pixel *p, int c)
{
    if (c < 3)
        return (float)mean_of(p->color[c], p->samples);
    return (float)path_pixel_share(p, p->opacity);
}

double path_pixel_share(const path_pixel *p, int64_t sum)
{
    return p->samples ? (double)sum / (double)p->samples * SHARE_UNIT : 0.0;
}

double path_pixel_spread(const path_pixel *p, int c)
{
    return spread_of(p->square[c], p->color[c], p->samples, p->is_saturated);
}

double path_ground_open(const path_ground *g)
{
    return mean_of(g->open, g->samples);
}

double path_ground_blocked(const path_ground *g)
{
    return mean_of(g->blocked, g->samples);
}

double path_ground_spread(const path_ground *g)
{
    return spread_of(g->square, g->blocked, g->samples, g->is_saturated);
}

void path_ground_set_blocked(path_ground *g, double blocked, double spread)
{
    double n = (double)g->samples;
    g->blocked = (path_fixed)(fmin(fmax(blocked, -0x1p46), 0x1p46) * n * 0x1p56);
    g->square = (path_fixed)(fmin(spread + blocked * blocked, 0x1p42) * n * 0x1p60);
    g->is_saturated = 1;
}
