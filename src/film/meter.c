/* meter.c - see meter.h. */
#include "film/meter.h"

#include <math.h>

static const double SATURATION = 1.2;

static size_t pixel_count(const film *f)
{
    return (size_t)f->width * f->height;
}

/* Straight, not premultiplied. */
static double luminance(const float *pixel)
{
    double L = 0.2126 * (double)pixel[0] + 0.7152 * (double)pixel[1] + 0.0722 * (double)pixel[2];
    return L / (double)pixel[3];
}

static bool is_covered(const float *pixel)
{
    return pixel[3] > 0.0f;
}

/* Mean of value(luminance, parameter), weighted by opacity. False: no pixel is covered. */
static bool mean_of(const film *f, double (*value)(double L, double parameter), double parameter,
                    double *mean)
{
    const float *p = f->layers[0].pixels;
    double sum = 0.0;
    double weight = 0.0;
    for (size_t i = 0; i < pixel_count(f); i++, p += 4) {
        if (!is_covered(p))
            continue;
        sum += (double)p[3] * value(luminance(p), parameter);
        weight += (double)p[3];
    }
    *mean = weight > 0.0 ? sum / weight : 0.0;
    return weight > 0.0;
}

static double log_above(double L, double floor)
{
    return log(fmax(L, floor));
}

static double at_least(double L, double floor)
{
    return L > floor ? L : floor;
}

double film_log_average(const film *f, double floor)
{
    double mean;
    return mean_of(f, log_above, floor, &mean) ? exp(mean) : 0.0;
}

double film_average(const film *f)
{
    double mean;
    return mean_of(f, at_least, 0.0, &mean) ? mean : 0.0;
}

double film_meter(const film *f)
{
    double mean = film_average(f);
    return mean > 0.0 ? film_log_average(f, mean / 1024.0) : 0.0;
}

bool film_is_covered(const film *f)
{
    const float *p = f->layers[0].pixels;
    for (size_t i = 0; i < pixel_count(f); i++, p += 4)
        if (is_covered(p))
            return true;
    return false;
}

bool film_is_brighter_than(const film *f, float most)
{
    const float *p = f->layers[0].pixels;
    size_t covered = 0;
    size_t beyond = 0;
    for (size_t i = 0; i < pixel_count(f); i++, p += 4) {
        float L = 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2];
        covered += p[3] > 0.0f;
        beyond += p[3] > 0.0f && L > most * p[3];
    }
    return 2 * beyond > covered;
}

double meter_ev100(double log_average)
{
    return log2(log_average / (SATURATION * METER_KEY));
}

double meter_exposure_ev(double ev100)
{
    return -ev100 - log2(SATURATION);
}
