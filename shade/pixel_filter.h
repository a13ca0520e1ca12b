/* pixel_filter.h - reconstruction filters of a pixel, importance-sampled: each sample belongs to one pixel,
 * whose estimate is a plain mean (Ernst, Stamminger and Greiner 2006).
 *
 * Filters are separable. Offsets are from the pixel's center, in pixels; u is uniform in [0, 1)^2. Offsets
 * increase with u, so stratification of u carries over to the pixel. */
#ifndef SHADE_PIXEL_FILTER_H
#define SHADE_PIXEL_FILTER_H

#define PIXEL_FILTER_BLACKMAN_HARRIS 0
#define PIXEL_FILTER_BOX 1
#define PIXEL_FILTER_MITCHELL 2

STRUCT(FilterSample)
{
    vec2 offset;  /* px */
    float weight; /* of the sample in the mean: 1, or Mitchell's +-(367/343)^2, whose mean is 1 */
};

/* ---- Blackman-Harris ---- */

/* The four-term window over [-1.5, 1.5] px, normalised to the integral 1:
 *   k(x) = (1 + b1 cos t + b2 cos 2t + b3 cos 3t) / 3,  t = 2 pi x / 3
 * Harris 1978, minimum sidelobes; the coefficients divided by the first. */
#define BLACKMAN_HARRIS_1 (0.48829f / 0.35875f)
#define BLACKMAN_HARRIS_2 (0.14128f / 0.35875f)
#define BLACKMAN_HARRIS_3 (0.01168f / 0.35875f)

FN float blackman_harris(float x)
{
    float c = cos(2.0f * PI / 3.0f * x);
    float k = 1.0f + BLACKMAN_HARRIS_1 * c + BLACKMAN_HARRIS_2 * (2.0f * c * c - 1.0f) +
              BLACKMAN_HARRIS_3 * c * (4.0f * c * c - 3.0f);
    return sel(abs(x) <= 1.5f, k * (1.0f / 3.0f), 0.0f);
}

/* One step of Newton's method towards the z, in units of the window's width from its end, with the cumulative
 * distribution `tail`:
 *   T(z) = z - (b1 sin a - b2 sin(2a) / 2 + b3 sin(3a) / 3) / (2 pi) = tail,  a = 2 pi z */
FN float blackman_harris_step(float z, float tail)
{
    float c = cos(2.0f * PI * z);
    float s = sin(2.0f * PI * z);
    float t = z - s * (0.5f * INV_PI) *
                      (BLACKMAN_HARRIS_1 - BLACKMAN_HARRIS_2 * c +
                       BLACKMAN_HARRIS_3 * (1.0f / 3.0f) * (4.0f * c * c - 1.0f));
    float slope = 1.0f - BLACKMAN_HARRIS_1 * c + BLACKMAN_HARRIS_2 * (2.0f * c * c - 1.0f) -
                  BLACKMAN_HARRIS_3 * c * (4.0f * c * c - 3.0f);
    return clamp(z + (tail - t) / max(slope, 1e-4f), 0.0f, 0.5f);
}

/* Inverse cumulative distribution of the window at u. The polynomial in the fourth root of the tail is a fit
 * with an error of at most 0.1 % of z for all but 1e-4 of u, 3 % for all but 1e-6; one Newton step reduces it
 * to 2e-6 and 3e-3. */
FN float sample_blackman_harris(float u)
{
    float tail = min(u, 1.0f - u);
    float r = sqrt(sqrt(tail));
    float z = ((-6.499490f * r + 21.884263f) * r - 29.218567f) * r + 19.908122f;
    z = (((z * r - 6.947481f) * r + 0.873388f) * r + 0.660086f) * r - 0.016248f;
    z = blackman_harris_step(max(z, 0.0f), tail);
    return sel(u < 0.5f, 3.0f * z - 1.5f, 1.5f - 3.0f * z);
}

/* ---- Mitchell-Netravali ---- */

/* The cubic with B = C = 1/3 over [-2, 2] px, of integral 1:
 *   k(x) = (7 |x|^3 - 12 x^2 + 16/3) / 6         |x| < 1
 *   k(x) = (7/18) (8/7 - |x|) (2 - |x|)^2        1 <= |x| < 2, negative beyond 8/7
 * Mitchell and Netravali 1988, equation 8; the second line is theirs by its roots. */
FN float mitchell(float x)
{
    float a = abs(x);
    float inner = ((7.0f * a - 12.0f) * a * a + 16.0f / 3.0f) * (1.0f / 6.0f);
    float outer = (7.0f / 18.0f) * (8.0f / 7.0f - a) * (2.0f - a) * (2.0f - a);
    return sel(a < 1.0f, inner, sel(a < 2.0f, outer, 0.0f));
}

/* One side of |k| has the positive mass 355/686 and the negative mass 12/686. Inverts the positive one:
 * the x in [0, 8/7] beyond which lies its fraction q, by f = 8/7 - x: a cubic in sqrt(q) with an error of
 * at most 10 % of f, then three Newton steps to rounding. */
FN float sample_mitchell_positive(float q)
{
    float s = sqrt(q);
    float f = ((0.7084f * s - 1.2814f) * s + 1.7241f) * s;
    for (int i = 0; i < 3; ++i) {
        float x = 8.0f / 7.0f - f;
        float below = ((1.75f * x - 4.0f) * x * x + 16.0f / 3.0f) * x * (1.0f / 6.0f);
        float above = (7.0f / 18.0f) * f * f * ((0.25f * f + 4.0f / 7.0f) * f + 18.0f / 49.0f);
        float share = sel(x < 1.0f, 1.0f - (686.0f / 355.0f) * below, (686.0f / 355.0f) * above);
        f = f + (q - share) / max((686.0f / 355.0f) * mitchell(x), 1e-6f);
        f = clamp(f, 0.0f, 8.0f / 7.0f);
    }
    return 8.0f / 7.0f - f;
}

/* Inverts the negative mass: the x in [8/7, 2] beyond which lies its fraction q = 4 e^3 - 3 e^4 with e = (2 -
 * x) 7/6. The first guess, from the limits of e at both ends, has an error of at most 8 %. */
FN float sample_mitchell_negative(float q)
{
    float c = pow(q, 1.0f / 3.0f);
    float e = 1.0f - sqrt(max(1.0f - c, 0.0f)) * (1.0f - (0.1074f + 0.1336f * c) * c);
    for (int i = 0; i < 3; ++i) {
        float slope = 12.0f * e * e * (1.0f - e);
        e = clamp(e + (q - e * e * e * (4.0f - 3.0f * e)) / max(slope, 1e-9f), 0.0f, 1.0f);
    }
    return 2.0f - (6.0f / 7.0f) * e;
}

/* Inverse cumulative distribution of |k| at u, and the weight that turns a mean over |k| into one over k: the
 * integral of |k|, 367/343, with the sign of k. */
FN vec2 sample_mitchell(float u)
{
    float tail = 2.0f * min(u, 1.0f - u); /* of one side's |k|: 1 in the middle, 0 at the end */
    bool is_negative = tail < 12.0f / 367.0f;
    float x = 0.0f;
    if (is_negative)
        x = sample_mitchell_negative(tail * (367.0f / 12.0f));
    else
        x = sample_mitchell_positive(clamp((367.0f / 355.0f) * tail - 12.0f / 355.0f, 0.0f, 1.0f));
    return vec2(sel(u < 0.5f, -x, x), sel(is_negative, -367.0f / 343.0f, 367.0f / 343.0f));
}

/* ---- any ---- */

/* Value of the filter, per square pixel; its integral over the plane is 1. */
FN float pixel_filter(int kind, vec2 offset)
{
    if (kind == PIXEL_FILTER_BLACKMAN_HARRIS)
        return blackman_harris(offset[0]) * blackman_harris(offset[1]);
    if (kind == PIXEL_FILTER_MITCHELL)
        return mitchell(offset[0]) * mitchell(offset[1]);
    return sel(abs(offset[0]) <= 0.5f && abs(offset[1]) <= 0.5f, 1.0f, 0.0f);
}

/* Samples an offset with a density proportional to |pixel_filter()|. */
FN FilterSample sample_pixel_filter(int kind, vec2 u)
{
    FilterSample s;
    s.offset = u - 0.5f;
    s.weight = 1.0f;
    if (kind == PIXEL_FILTER_BLACKMAN_HARRIS)
        s.offset = vec2(sample_blackman_harris(u[0]), sample_blackman_harris(u[1]));
    if (kind == PIXEL_FILTER_MITCHELL) {
        vec2 x = sample_mitchell(u[0]);
        vec2 y = sample_mitchell(u[1]);
        s.offset = vec2(x[0], y[0]);
        s.weight = x[1] * y[1];
    }
    return s;
}

#endif
