/* glint.h - sun glints: few of the facets in a pixel reflect the sun, and their number is random. Its
 * expectation follows from the spectrum of the unresolved waves; the reflected sun is multiplied by a
 * variate X of mean 1 and of the variance of the reflection, which moves with the water and changes as
 * fast as its waves do.
 *
 *   density = p(s) m4 / (2 sqrt 3),  m4 = int k^4 of the spectrum   glints per m^2; Longuet-Higgins 1960
 *   X = sum of Poisson(n) marks, each exponential, over n           mean 1, variance 2 / n
 *
 * The sun is a disc: a fraction c of the facets reflects it, and a glint is as large as the area over
 * which facets stay within it. A smaller patch of water is either entirely within or not at all, with the
 * variance (1
 * - c) / c, 0 where the disc is resolved. */
#ifndef SHADE_GLINT_H
#define SHADE_GLINT_H

/* X is 1 above GLINT_COUNT_MAX expected glints, and fades to it from GLINT_COUNT_FADE on: 18 % to 13 % of
 * deviation. */
#define GLINT_COUNT_MAX 128.0f
#define GLINT_COUNT_FADE 64.0f
/* X is 1 below this number as well: no image has so many pixels that one would show a glint. */
#define GLINT_COUNT_MIN 1e-6f
/* Expected numbers from which glints lose their positions in a cell, and above which they have none. */
#define GLINT_COUNT_APART 0.5f
#define GLINT_COUNT_EVEN 2.0f

/* ---- how many ---- */

/* Number n for the variance 2 / n of sunlight from `area` m^2 of the sea with the normal N and slopes C
 * (water_surface.h), the half vector H and the sun's slopes S (sun_slopes()). m4 in 1/m^2, of the waves in C.
 * exposure: shutter time over the lifetime of a glint.
 *   c = 2 pi sqrt |S| p,  2 / n = (1 - c) / c t / (1 + t)^2,  t = area (1 + exposure) / a
 *   a = 4 pi 2 sqrt 3 / m4 / (1 / sqrt |S| + 2 / (C_xx + C_zz))
 * a is twice the area over which facets reflect the disc, but no larger than waves are. For many glints, t
 * > 1, and a point sun n is the number of glints, p m4 / (2 sqrt 3) area. Glints larger than a pixel, t <
 * 1, are equal in neighboring pixels and not random: such smooth water reflects the disc itself, blurred
 * by its slopes. */
FN float glint_count(int normals, vec3 C, vec3 S, vec3 N, vec3 H, float m4, float area, float exposure)
{
    vec2 d = slope_from_normal(vec3(H[0], max(H[1], 1e-4f), H[2])) - slope_from_normal(N);
    float disc = sqrt(max(S[0] * S[1] - S[2] * S[2], 1e-30f));
    float hidden = 0.5f * (C[0] + C[1]);
    float c = 2.0f * PI * disc * sun_density(normals, C, S, d);
    float t = max(area * (1.0f + exposure) * m4 * (1.0f / disc + 1.0f / hidden) * 0.022972037f, 1e-6f);
    return 2.0f * c / max(1.0f - c, 1e-6f) * (2.0f + t + 1.0f / t);
}

/* ---- random variates ---- */

/* A 32-bit hash: PCG-RXS-M-XS (O'Neill 2014; Jarzynski and Olano 2020). */
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

/* Uniform in (0, 1), and normally distributed. */
FN float glint_uniform(uint key)
{
    return (float(key >> 8u) + 0.5f) * (1.0f / 16777216.0f);
}
FN float glint_normal(uint key)
{
    return inverse_normal(glint_uniform(key));
}

/* Gamma variate of shape k >= 1 and mean k from a normal one: the cube of Wilson and Hilferty 1931, over its
 * own mean. Its variance is within 0.5 % of k. */
FN float gamma_variate(float k, float normal)
{
    float b = 1.0f / (3.0f * sqrt(k));
    float a = 1.0f - b * b;
    float t = max(a + b * normal, 0.0f);
    return k * t * t * t / (a * (a * a + 3.0f * b * b));
}

/* Sum of Poisson(n) exponential variates over n: expectation 1, variance 2 / n. It is 0 with the probability
 * e^-n, and otherwise a Gamma variate with the remaining mean and variance; a single glint is exponential, as
 * required. */
FN float glint_sum(uint key, float n)
{
    float some = sel(n < 0.02f, n * (1.0f - 0.5f * n), 1.0f - exp(-n)); /* where 1 - exp would cancel */
    if (glint_uniform(key) >= some)
        return 0.0f;
    float mean = n / some;
    float variance = mean * (n + 2.0f - mean);
    return gamma_variate(max(mean * mean / variance, 1.0f), glint_normal(glint_hash(key ^ 1779033703u))) /
           max(mean * mean / variance, 1.0f) / some;
}

/* ---- where and when ---- */

/* Cells and slots are numbered by integers: clamped beyond this. */
#define GLINT_FAR 1e9f

/* Maximum width of a cell in footprints, where glints are few. */
#define GLINT_CELL_MAX 4.0f

/* Area of a glint's splat in footprints: the integral of its square is the inverse, and so is the variance
 * of a sum. */
#define GLINT_IMAGE 1.75f

/* A patch of water whose glints are computed together. */
STRUCT(GlintCell)
{
    uint key;
    vec2 at;     /* lookup position in it, [0, 1] */
    vec2 radius; /* of a glint's splat, one footprint wide, so at most 1/2 */
    float area;  /* over that of the footprint, at least GLINT_IMAGE */
};

/* Glint coordinates of water at rest at (x, z) from the eye: distance (m), azimuth. Footprints are long along
 * the first and narrow along the second. */
FN vec2 glint_place(vec2 rest)
{
    return vec2(length(rest), atan(rest[1], rest[0] + sel(rest[0] == 0.0f, 1e-20f, 0.0f)));
}

/* Extent there of a footprint `width` m wide across the ray; cosine: water_seen_cosine(). */
FN vec2 glint_extent(vec2 place, float width, float cosine)
{
    return vec2(width / cosine, width / max(place[0], width));
}

/* Cell of a position for a footprint of this extent. Where a footprint expects less than one glint, cells are
 * wider, so that most have one at most. Cells are powers of two wide; between two sizes the choice is random,
 * once per wider cell. */
FN GlintCell glint_cell(vec2 place, vec2 extent, float count)
{
    vec2 wanted = extent * clamp(inversesqrt(max(count, 1e-6f)), 1.0f, GLINT_CELL_MAX);
    vec2 level = vec2(log2(max(wanted[0], 1e-9f)), log2(max(wanted[1], 1e-9f)));
    vec2 fine = floor(level);
    vec2 size = vec2(exp2(fine[0] + 1.0f), exp2(fine[1] + 1.0f));
    vec2 grid = vec2(place[0] / size[0], clamp(place[1] / size[1], -GLINT_FAR, GLINT_FAR));
    /* staggered like bricks, so that cell borders, where glints are fewer, form no rings around the eye */
    grid = vec2(clamp(grid[0] + glint_uniform(glint_hash(uint(int(floor(grid[1]))))), -GLINT_FAR, GLINT_FAR),
                grid[1]);
    vec2 at = floor(grid);
    uint wide =
        glint_hash2(glint_hash2(uint(int(at[0])), uint(int(at[1]))), uint(int(fine[0]) * 64 + int(fine[1])));
    vec2 more = level - fine;
    vec2 steps = vec2(sel(more[0] > glint_uniform(wide), 1.0f, 2.0f),
                      sel(more[1] > glint_uniform(glint_hash(wide)), 1.0f, 2.0f));
    vec2 within = clamp(grid - at, 0.0f, 0.9999f) * steps;
    vec2 part = floor(within);
    vec2 share = vec2(extent[0] * steps[0] / size[0], extent[1] * steps[1] / size[1]);
    GlintCell r;
    r.key = glint_hash2(wide, uint(int(part[0] + 2.0f * part[1] + 4.0f * steps[0] + 16.0f * steps[1])));
    r.at = within - part;
    r.radius = min(share, vec2(0.5f));
    r.area = max(1.0f / (share[0] * share[1]), GLINT_IMAGE);
    return r;
}

/* Splat of a glint at a random position in a cell: a squared paraboloid of mean 1. Sampled in steps of its
 * radius, its sum is constant within 6 % wherever it lies: no pixel misses it. */
FN float glint_image(GlintCell cell, uint key)
{
    uint along = glint_hash(key ^ 2654435769u);
    uint across = glint_hash(along);
    vec2 middle = mix(cell.radius, 1.0f - cell.radius, vec2(glint_uniform(along), glint_uniform(across)));
    vec2 off = (cell.at - middle) / cell.radius;
    float inside = max(1.0f - dot(off, off), 0.0f);
    return inside * inside * 0.954929659f / (cell.radius[0] * cell.radius[1]);
}

/* X in a cell at a time, for the expected number `count` in a footprint; lifetime (s) of a glint. Glints
 * of one of two overlapping time slots fade out as those of the next fade in, so X consists of Poisson
 * variates at any time. The glints of a slot have positions in the cell; where they are many, the cell is
 * uniform. */
FN float glint_variate(GlintCell cell, float count, float time_s, float lifetime_s)
{
    float t = time_s / (2.0f * lifetime_s) + glint_uniform(glint_hash(cell.key ^ 3144134277u));
    float slot = clamp(floor(t), -GLINT_FAR, GLINT_FAR);
    float share = clamp(t - slot, 0.0f, 1.0f);
    float n = max(count * cell.area, 1e-5f);
    uint now = glint_hash2(cell.key, uint(int(slot)));
    uint next = glint_hash2(cell.key, uint(int(slot) + 1));
    float even = clamp((count - GLINT_COUNT_APART) / (GLINT_COUNT_EVEN - GLINT_COUNT_APART), 0.0f, 1.0f);
    float X = glint_sum(now, n * (1.0f - share)) * (1.0f - share) * mix(glint_image(cell, now), 1.0f, even) +
              glint_sum(next, n * share) * share * mix(glint_image(cell, next), 1.0f, even);
    float fade = clamp((GLINT_COUNT_MAX - count) / (GLINT_COUNT_MAX - GLINT_COUNT_FADE), 0.0f, 1.0f);
    return mix(1.0f, X, fade);
}

/* X for water at rest at (x, z) from the eye, for a pixel `width` m wide there. Samples of a pixel must share
 * its width and count: each sees its own part of the same glints. cosine: water_seen_cosine(). */
FN float glint_seen(vec2 rest, float width, float cosine, float count, float time_s, float lifetime_s)
{
    if (count > GLINT_COUNT_MAX || count < GLINT_COUNT_MIN)
        return 1.0f;
    vec2 place = glint_place(rest);
    GlintCell cell = glint_cell(place, glint_extent(place, width, cosine), count);
    return glint_variate(cell, count, time_s, lifetime_s);
}

#endif
