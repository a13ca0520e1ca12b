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

double film_log_average(const film *f, double floor)
{
    const float *p = f->layers[0].pixels;
    double sum = 0.0;
    double weight = 0.0;
    for (size_t i = 0; i < pixel_count(f); i++, p += 4) {
        if (!is_covered(p))
            continue;
        sum += (double)p[3] * log(fmax(luminance(p), floor));
        weight += (double)p[3];
    }
    return weight > 0.0 ? exp(sum / weight) : 0.0;
}

double film_average(const film *f)
{
    const float *p = f->layers[0].pixels;
    double sum = 0.0;
    double weight = 0.0;
    for (size_t i = 0; i < pixel_count(f); i++, p += 4) {
        if (!is_covered(p))
            continue;
        double L = luminance(p);
        sum += (double)p[3] * (L > 0.0 ? L : 0.0);
        weight += (double)p[3];
    }
    return weight > 0.0 ? sum / weight : 0.0;
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
