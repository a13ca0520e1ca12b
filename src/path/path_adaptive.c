/* path_adaptive.c - which pixels need more samples. Nothing is remembered from one judgement to the next: it depends on the
 * samples alone, so that a picture that was interrupted goes on as one that was not. */
#include "path/path_film_state.h"

#include <math.h>

#include "base/parallel.h"

/* ---- the noise of a pixel ---- */

/* What a standard error becomes on a display. A display shows roughly the square root v^(1/2) of linear light v, 1 being
 * white, whose slope is 1 / (2 v^(1/2)): the normalisation of Dammertz et al. 2010 ("A Hierarchical Automatic Stopping
 * Condition for Monte Carlo Global Illumination", equation 1). The floor keeps black from asking for infinitely many
 * samples; with it the slope ends at 10, near the 12.9 of the sRGB curve's foot. */
static double displayed(double error, double value)
{
    return error / (2.0 * sqrt((value > 0.0 ? value : 0.0) + 0.0025));
}

/* The square of the standard error of what a display shows, where 1 is all that it can show. The errors of the channels
 * are added up with the weights of luminance as if they went together, as those of light mostly do, so that colored noise
 * of even luminance is noise as well. The shadow on the ground is judged as over white. */
static double pixel_noise_square(const path_film *f, size_t i)
{
    static const double weights[3] = {0.2126, 0.7152, 0.0722};
    const path_pixel *p = &f->pixels[i];
    double error = 0.0, value = 0.0;
    for (int c = 0; c < 3; c++) {
        error += weights[c] * sqrt((double)p->spread[c] / ((double)p->samples - 1.0));
        value += weights[c] * (double)p->mean[c];
    }
    double noise = displayed(error * (double)f->scale, value * (double)f->scale);
    double square = noise * noise;
    if (f->ground) {
        const path_ground *g = &f->ground[i];
        double share = (double)path_ground_share(g, p);
        double shadow = displayed(share * (double)path_ground_error(g),
                                  1.0 - (double)p->mean[3] - share * (double)path_ground_opacity(g));
        square += shadow * shadow;
    }
    return square < 1e30 ? square : 1e30;
}

/* ---- blocks ---- */

typedef struct judging {
    path_film *film;
    float noise;
} judging;

/* The mean square over a block; infinite while a pixel of it has too few samples to be judged. */
static float block_noise_square(const path_film *f, uint32_t column, uint32_t row)
{
    uint32_t x_end = (column + 1) * PATH_FILM_BLOCK, y_end = (row + 1) * PATH_FILM_BLOCK;
    x_end = x_end < f->width ? x_end : f->width;
    y_end = y_end < f->height ? y_end : f->height;
    double sum = 0.0;
    uint32_t count = 0;
    for (uint32_t y = row * PATH_FILM_BLOCK; y < y_end; y++)
        for (uint32_t x = column * PATH_FILM_BLOCK; x < x_end; x++, count++) {
            size_t i = (size_t)y * f->width + x;
            if (f->pixels[i].samples < (float)PATH_FILM_FEWEST_SAMPLES)
                return INFINITY;
            sum += pixel_noise_square(f, i);
        }
    return (float)(sum / count);
}

static void measure_blocks(void *context, size_t begin, size_t end)
{
    const judging *j = context;
    uint32_t columns = j->film->block_columns;
    for (size_t b = begin; b < end; b++)
        j->film->block_noise[b] =
            block_noise_square(j->film, (uint32_t)(b % columns), (uint32_t)(b / columns));
}

/* The mean square over a block and those around it: what few samples of one block have not met yet, a neighbor may have. */
static float region_noise_square(const path_film *f, uint32_t column, uint32_t row)
{
    uint32_t left = column ? column - 1 : 0, right = column + 1 < f->block_columns ? column + 1 : column;
    uint32_t top = row ? row - 1 : 0, bottom = row + 1 < f->block_rows ? row + 1 : row;
    float sum = 0.0f, count = 0.0f;
    for (uint32_t y = top; y <= bottom; y++)
        for (uint32_t x = left; x <= right; x++, count += 1.0f)
            sum += f->block_noise[(size_t)y * f->block_columns + x];
    return sum / count;
}

static void judge_blocks(void *context, size_t begin, size_t end)
{
    const judging *j = context;
    path_film *f = j->film;
    float limit = j->noise * j->noise;
    for (size_t b = begin; b < end; b++) {
        uint32_t column = (uint32_t)(b % f->block_columns), row = (uint32_t)(b / f->block_columns);
        f->block_is_done[b] = f->block_noise[b] <= limit && region_noise_square(f, column, row) <= limit;
    }
}

/* ---- the picture ---- */

static float share_done(const path_film *f)
{
    uint64_t done = 0;
    for (uint32_t row = 0; row < f->block_rows; row++)
        for (uint32_t column = 0; column < f->block_columns; column++) {
            if (!f->block_is_done[(size_t)row * f->block_columns + column])
                continue;
            uint32_t width = f->width - column * PATH_FILM_BLOCK, height = f->height - row * PATH_FILM_BLOCK;
            done += (uint64_t)(width < PATH_FILM_BLOCK ? width : PATH_FILM_BLOCK) *
                    (height < PATH_FILM_BLOCK ? height : PATH_FILM_BLOCK);
        }
    return (float)((double)done / ((double)f->width * f->height));
}

void path_film_set_scale(path_film *f, float scale)
{
    f->scale = scale;
}

void path_film_update(path_film *f, float noise, uint32_t thread_count)
{
    judging j = {.film = f, .noise = noise};
    size_t count = (size_t)f->block_columns * f->block_rows;
    if (noise > 0.0f) {
        parallel_for(thread_count, count, 16, measure_blocks, &j);
        parallel_for(thread_count, count, 256, judge_blocks, &j);
    } else {
        for (size_t b = 0; b < count; b++)
            f->block_is_done[b] = false;
    }
    f->share_done = share_done(f);
}

bool path_film_needs_more(const path_film *f, size_t pixel)
{
    size_t column = pixel % f->width / PATH_FILM_BLOCK, row = pixel / f->width / PATH_FILM_BLOCK;
    return !f->block_is_done[row * f->block_columns + column];
}

float path_film_share_done(const path_film *f)
{
    return f->share_done;
}
