/* glint.h - glints: few of the facets in a pixel mirror the sun, and how many is chance. Their expected number follows from the
 * spectrum of the waves that are not seen; the sun's reflection is multiplied with a variate of mean 1 and of the variance that the
 * number has, which stays with the water and changes as fast as its waves do.
 *
 *   density = p(s) m4 / (2 sqrt 3),  m4 = int k^4 of the spectrum   glints per m^2; Longuet-Higgins 1960
 *   X = sum of Poisson(n) marks, each exponential, over n           mean 1, variance 2 / n
 *
 * A Gamma variate of the shape n / 2 has the same two moments and takes its place where n is large. */
#ifndef SHADE_GLINT_H
#define SHADE_GLINT_H

/* Expected numbers above which X is 1, and from which on it goes there: 18 % to 13 % of deviation. */
#define GLINT_COUNT_MAX 128.0f
#define GLINT_COUNT_FADE 64.0f

/* ---- how many ---- */

/* Expected number of glints in `area` m^2 of the sea with the normal N and slopes C (water_surface.h) that mirror the sun
 * where the half vector is H. m4 in 1/m^2, of the waves in C. exposure: time that the shutter is open over that which a glint
 * lives. */
FN float glint_count(int normals, vec3 C, vec3 N, vec3 H, float m4, float area, float exposure)
{
    vec2 d = slope_from_normal(vec3(H[0], max(H[1], 1e-4f), H[2])) - slope_from_normal(N);
    return slope_density(normals, C, d) * m4 * 0.288675135f * area * (1.0f + exposure);
}

/* ---- chance ---- */

/* 32 bits that look random: PCG-RXS-M-XS (O'Neill 2014; Jarzynski and Olano 2020). */
FN uint glint_hash(uint x)
{
    uint state = x * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}
FN uint glint_hash2(uint a, uint b)
{
    return glint_hash(a ^ (glint_hash(b) + 2654435769u));
}

/* In (0, 1), and normally distributed. */
FN float glint_uniform(uint key)
{
    return (float(key >> 8u) + 0.5f) * (1.0f / 16777216.0f);
}
FN float glint_normal(uint key)
{
    return inverse_normal(glint_uniform(key));
}

/* Gamma variate of shape k >= 1 and mean k from a normal one: the cube of Wilson and Hilferty 1931, over its own mean. Its variance is
 * within 0.5 % of k. */
FN float gamma_variate(float k, float normal)
{
    float b = 1.0f / (3.0f * sqrt(k));
    float a = 1.0f - b * b;
    float t = max(a + b * normal, 0.0f);
    return k * t * t * t / (a * (a * a + 3.0f * b * b));
}

/* Sum of Poisson(mean) exponential variates: expectation mean, variance 2 mean. Up to 8 the number is drawn by inversion. */
FN float glint_sum(uint key, float mean)
{
    uint size = glint_hash(key ^ 1779033703u);
    if (mean > 8.0f)
        return 2.0f * gamma_variate(0.5f * mean, glint_normal(size));
    float u = glint_uniform(key);
    float p = exp(-mean);
    if (u < p)
        return 0.0f;
    float below = p;
    float count = 0.0f;
    for (int i = 1; i <= 28 && u >= below; ++i) {
        count += 1.0f;
        p *= mean / count;
        below += p;
    }
    return gamma_variate(count, glint_normal(size));
}

/* ---- where and when ---- */

/* Cells and slots beyond are one: they are numbered by integers. */
#define GLINT_FAR 1e9f

/* Cell of the water that a footprint takes for its own. rest: where the water is at rest (m), so that glints ride the waves; width: of
 * the footprint along x and z (m). Cells are powers of two wide; between two of them the choice is by chance, once per wider cell, as a
 * mean of two would have half the variance. */
FN uint glint_cell(vec2 rest, vec2 width)
{
    vec2 level = vec2(log2(max(width[0], 1e-6f)), log2(max(width[1], 1e-6f)));
    vec2 fine = floor(level);
    vec2 size = vec2(exp2(fine[0] + 1.0f), exp2(fine[1] + 1.0f));
    vec2 at = clamp(floor(vec2(rest[0] / size[0], rest[1] / size[1])), -GLINT_FAR, GLINT_FAR);
    uint wide =
        glint_hash2(glint_hash2(uint(int(at[0])), uint(int(at[1]))), uint(int(fine[0]) * 64 + int(fine[1])));
    vec2 more = level - fine;
    float step_x = sel(more[0] > glint_uniform(wide), 1.0f, 2.0f);
    float step_z = sel(more[1] > glint_uniform(glint_hash(wide)), 1.0f, 2.0f);
    vec2 within = clamp(vec2(rest[0] / size[0] - at[0], rest[1] / size[1] - at[1]), 0.0f, 0.999f);
    vec2 part = floor(within * vec2(step_x, step_z));
    return glint_hash2(wide, uint(int(part[0] + 2.0f * part[1] + 4.0f * step_x + 16.0f * step_z)));
}

/* X of a cell at a time, for the expected number `count`; lifetime (s) of a glint. Glints of one slot of two lifetimes go one
 * by one as those of the next come, so X is made of Poisson(count) of them at any time. */
FN float glint_variate(uint cell, float count, float time_s, float lifetime_s)
{
    if (count > GLINT_COUNT_MAX)
        return 1.0f;
    float t = time_s / (2.0f * lifetime_s) + glint_uniform(glint_hash(cell ^ 3144134277u));
    float slot = clamp(floor(t), -GLINT_FAR, GLINT_FAR);
    float share = clamp(t - slot, 0.0f, 1.0f);
    float n = max(count, 1e-6f);
    uint now = glint_hash2(cell, uint(int(slot)));
    uint next = glint_hash2(cell, uint(int(slot) + 1));
    float X = (glint_sum(now, n * (1.0f - share)) + glint_sum(next, n * share)) / n;
    float fade = clamp((GLINT_COUNT_MAX - n) / (GLINT_COUNT_MAX - GLINT_COUNT_FADE), 0.0f, 1.0f);
    return mix(1.0f, X, fade);
}

#endif
