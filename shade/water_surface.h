/* water_surface.h - waves that are too small to be seen one by one, as microfacets whose slopes have a covariance: what they reflect
 * of the sun and, on average, of the sky.
 *
 * Axes: +Y up. A normal n with n.y > 0 has the slope s = (-n.x, -n.z) / n.y. Slopes of the facets are spread about that of the
 * normal N of the waves that are seen, with covariance (xx, zz, xz) in world axes: the microsurface is that of waves added to
 * waves, and its mean normal is N exactly (Dupuy et al. 2013, "LEADR mapping", section 4). V to the eye, L to the sun, unit.
 *
 * No covariance may be singular: SLOPE_VARIANCE_MIN belongs on its diagonal. */
#ifndef SHADE_WATER_SURFACE_H
#define SHADE_WATER_SURFACE_H

/* How slopes are distributed. */
#define WATER_BECKMANN 0 /* Gaussian, which those of the sea nearly are */
#define WATER_GGX 1
/* How facets hide each other. */
#define WATER_SCALES 0 /* waves of all lengths on each other: slopes_seen(); GGX has Smith's */
#define WATER_SMITH 1  /* facets whose heights do not know their neighbours'; height-correlated, Heitz 2014 */
#define WATER_SCHLICK_KARIS 2 /* separable, k = (r + 1)^2 / 8, for comparison */

/* Slope variance, along each axis, of water that looks flat. */
#define SLOPE_VARIANCE_MIN 1e-8f

/* ---- slopes ---- */

FN vec2 slope_from_normal(vec3 N)
{
    return vec2(N[0], N[2]) * (-1.0f / N[1]);
}
FN vec3 normal_from_slope(vec2 s)
{
    return normalize(vec3(-s[0], 1.0f, -s[1]));
}

/* d^T C d: variance of slopes along a unit d. */
FN float slope_variance(vec3 C, vec2 d)
{
    return C[0] * d[0] * d[0] + C[1] * d[1] * d[1] + 2.0f * C[2] * d[0] * d[1];
}

/* Density of slopes at a distance d from their mean, with the covariance C; the integral over the plane is 1.
 *   Gauss:  exp(-q / 2) / (2 pi sqrt |C|),  q = d^T C^-1 d
 *   GGX of the same height at d = 0, alpha^2 = 2 C:  1 / (2 pi sqrt |C| (1 + q / 2)^2), whose variance is infinite
 * Cox and Munk 1954; Heitz 2014, equations 82 and 84. */
FN float slope_density(int normals, vec3 C, vec2 d)
{
    float det = max(C[0] * C[1] - C[2] * C[2], SLOPE_VARIANCE_MIN * SLOPE_VARIANCE_MIN * 0.01f);
    float q = (C[1] * d[0] * d[0] + C[0] * d[1] * d[1] - 2.0f * C[2] * d[0] * d[1]) / det;
    float t = 1.0f + 0.5f * max(q, 0.0f);
    float shape = sel(normals == WATER_GGX, 1.0f / (t * t), exp(1.0f - t));
    return shape * 0.5f * INV_PI * inversesqrt(det);
}

/* Distribution of facets' normals m, in 1/sr, per area of the surface of normal N:
 *   D = N.y p(s_m - s_N) / m.y^4,  so that the integral of D m is N
 * 0 for m.y <= 0. */
FN float D_slopes(int normals, vec3 C, vec3 N, vec3 m)
{
    float y = max(m[1], 1e-4f);
    vec2 d = slope_from_normal(vec3(m[0], y, m[2])) - slope_from_normal(N);
    return sel(m[1] > 0.0f, N[1] * slope_density(normals, C, d) / (y * y * y * y), 0.0f);
}

/* ---- masking ---- */

/* Smith's a: how many root mean square slopes (times sqrt 2) the direction X stands above the surface, 1 / (alpha tan theta):
 *   a = (N.X / N.y) / sqrt(2 X_h^T C X_h)
 * Heitz 2014, equations 79 and 80, with slopes about those of N. */
FN float smith_a(vec3 C, vec3 N, vec3 X)
{
    float variance = max(slope_variance(C, vec2(X[0], X[2])), 1e-14f);
    return dot(N, X) / N[1] * inversesqrt(2.0f * variance);
}

/* Share of the facets of normal m, on a surface of normal N, that X sees, waves of all lengths being on each other; X.m, X.N > 0:
 *   G1 = 1 - exp(-2 c0 c / (X_h^T C X_h)),  c0 = N.X / N.y,  c = m.X / m.y
 * c is how far a slope is tilted towards X. Waves are added from the longest to the shortest: c goes from that of N to that of m by
 * independent Gaussian steps that are small, as every octave of a sea adds about as much to the variance. Water that faces away
 * from X with the waves so far is hidden, and what is hidden stays so: of all walks from c0 to c those are seen that never come
 * to 0. Those that do are as many as walk from -c0 to c (reflection principle), p(c + c0) of p(c - c0).
 *   The area seen, D m.X G1, has the integral N.X, as it must. Along X its slopes are distributed as c / c0 (p(c - c0) - p(c + c0)): a
 * walk that is conditioned to stay positive, or the length of a vector that walks in three dimensions (Williams 1974; Pitman 1975).
 * At grazing angles that is c^2 p(c), which looks steeper than Smith's c p(c): 1.6 standard deviations towards the eye on average
 * instead of 1.25, and a sea of 10 m/s mirrors a quarter less.
 *   As walks can be stopped on their way, a surface may be divided at any wave length: what is seen of long waves, and of short
 * ones on these, is what is seen of all at once. So a pixel shows the same light whichever waves it resolves.
 *   It is a limit: heights are Gaussian, waves of one length know nothing of the others, and there are many octaves. Of surfaces that are as
 * steep in every octave, rays that are marched (test_marched) find tilts of 1.51 deviations at grazing angles with 14 octaves, as many as a sea
 * of 10 m/s has, 1.47 with 11, 1.37 with 6, and of a single one 1.15, for which Smith's are right. That V and L see a facet is taken
 * for independent, which is exact where they stand across; face to face, as low as half a deviation, the product is 0.155 where
 * 0.12 (14) to 0.16 (11) are found. */
FN float slopes_seen(vec3 C, vec3 N, vec3 m, vec3 X)
{
    float variance = max(slope_variance(C, vec2(X[0], X[2])), 1e-14f);
    return 1.0f - exp(-2.0f * (dot(N, X) / N[1]) * (dot(m, X) / m[1]) / variance);
}

/* exp(a^2) erfc(a) for a >= 0, within 1.5e-7 of exp(a^2). Abramowitz and Stegun 1964, 7.1.26. */
FN float erfcx(float a)
{
    float t = 1.0f / (1.0f + 0.3275911f * a);
    return t *
           (0.254829592f + t * (-0.284496736f + t * (1.421413741f + t * (-1.453152027f + t * 1.061405429f))));
}

/* Smith's auxiliary function of Gaussian slopes, in [0, inf), within 1e-7 / a:
 *   Lambda = exp(-a^2) / (2 a sqrt pi) - erfc(a) / 2
 * 0 from 4 on, where it is 2e-10. Heitz 2014, equation 66. a > 0. */
FN float Lambda_Beckmann(float a)
{
    if (a > 4.0f)
        return 0.0f;
    return max(exp(-a * a) * (0.282094792f / a - 0.5f * erfcx(a)), 0.0f);
}

/* Of GGX: (sqrt(1 + 1 / a^2) - 1) / 2. Heitz 2014, equation 68. */
FN float Lambda_GGX(float a)
{
    float b = 1.0f / (a * a);
    return 0.5f * b / (sqrt(1.0f + b) + 1.0f);
}
FN float Lambda_slopes(int normals, float a)
{
    float x = clamp(a, 1e-6f, 1e6f);
    return sel(normals == WATER_GGX, Lambda_GGX(x), Lambda_Beckmann(x));
}

/* Width of a GGX lobe as high as that of the slopes: alpha = sqrt(C_xx + C_zz), and its perceptual roughness. */
FN float roughness_from_slopes(vec3 C)
{
    return sqrt(sqrt(clamp(C[0] + C[1], 0.0f, 1.0f)));
}

/* Slope covariance, the same along both axes, of a perceptual roughness. */
FN vec3 slopes_from_roughness(float perceptual_roughness)
{
    float alpha = alpha_from_roughness(perceptual_roughness);
    float variance = max(0.5f * alpha * alpha, SLOPE_VARIANCE_MIN);
    return vec3(variance, variance, 0.0f);
}

/* Visibility G / (4 N.L N.V), both cosines > 0. WATER_SMITH: 1 / (1 + Lambda(V) + Lambda(L)), Heitz 2014, equation 99.
 * WATER_SCALES: slopes_seen() of both; GGX, whose slopes have no variance to walk by, has Smith's.
 * WATER_SCHLICK_KARIS: V_SchlickGGX with k_direct, which darkens calm water at grazing angles (G1 = 0.29 at N.V = 0.05
 * and roughness 0.02, where 1 is right). */
FN float V_slopes(int normals, int masking, vec3 C, vec3 N, vec3 L, vec3 V)
{
    float NdotL = max(dot(N, L), 1e-6f);
    float NdotV = max(dot(N, V), 1e-6f);
    if (masking == WATER_SCALES && normals == WATER_BECKMANN) {
        vec3 H = V + L;
        vec3 m = vec3(H[0], max(H[1], 1e-4f), H[2]);
        return 0.25f * slopes_seen(C, N, m, V) * slopes_seen(C, N, m, L) / (NdotL * NdotV);
    }
    float Lambda = Lambda_slopes(normals, smith_a(C, N, L)) + Lambda_slopes(normals, smith_a(C, N, V));
    float smith = 0.25f / ((1.0f + Lambda) * NdotL * NdotV);
    float karis = V_SchlickGGX(NdotL, NdotV, k_direct(roughness_from_slopes(C)));
    return sel(masking == WATER_SCHLICK_KARIS, karis, smith);
}

/* ---- the sun ---- */

/* Slopes that bring light from the disc of the sun (angular radius SUN_RADIUS) to the eye, about the slope of the half vector h, L plus
 * what belongs to the eye: twice their covariance, that of a Gaussian which is as bright in the middle and has the same flux, with
 * the variance radius^2 / 2 along each axis of directions; s = -h_xz / h.y, so ds = -(dL_xz + s dL.y) / h.y. On flat water the
 * image of the sun is as bright as F times its disc, whatever the angle; facing it, alpha^2 is radius^2 / 4. */
FN vec3 sun_slopes_about(vec3 L, vec3 h)
{
    bool is_wall =
        h[1] * h[1] < 0.01f * dot(h, h); /* steeper than any sea; the difference below would cancel */
    float y = sel(is_wall, 1.0f, h[1]);
    vec2 s = vec2(h[0], h[2]) * (-1.0f / y);
    vec2 p = vec2(L[0] + s[0] * L[1], L[2] + s[1] * L[1]);
    float k = sel(is_wall, 0.0f, 0.5f * SUN_RADIUS * SUN_RADIUS / (y * y));
    return vec3(1.0f + s[0] * s[0] - p[0] * p[0], 1.0f + s[1] * s[1] - p[1] * p[1],
                s[0] * s[1] - p[0] * p[1]) *
           k;
}
/* Of mirrored light. */
FN vec3 sun_slopes(vec3 L, vec3 V)
{
    return sun_slopes_about(L, V + L);
}

/* Density of slopes C about their mean, blurred by the disc of the sun whose slopes are S (sun_slopes(); 0: a point): of what brings light of
 * it to the eye at a distance d. The disc is an ellipse of the area 2 pi sqrt |S| and the covariance S / 2. With its radius as unit, the slopes
 * have the variance v = tr(S^-1 C) / 4. Where that is small, the disc is seen as it is, its edge blurred by them and, so
 * that light is kept, at sqrt(1 - v); from 3/8 on it is as good as a Gaussian; between it is a mixture with one that is wide enough not to be
 * brighter than the disc. The integral is 1, the covariance C + S / 2 within a fifth, and it is at most 1 / (2 pi sqrt |S|). */
FN float sun_density(int normals, vec3 C, vec3 S, vec2 d)
{
    float det = max(S[0] * S[1] - S[2] * S[2], 0.0f);
    float spread = 0.25f * (S[1] * C[0] + S[0] * C[1] - 2.0f * S[2] * C[2]);
    if (spread >= 0.375f * det)
        return slope_density(normals, C + S * 0.5f, d);
    float v = spread / det;
    float blur = min(v, 0.16f); /* a wider edge would reach the middle */
    float off = S[1] * d[0] * d[0] + S[0] * d[1] * d[1] - 2.0f * S[2] * d[0] * d[1];
    float inside = sqrt(1.0f - blur) - sqrt(max(0.5f * off / det, 0.0f));
    float x = clamp(0.5f + 0.5f * inside * inversesqrt(5.0f * blur), 0.0f, 1.0f);
    float disc = x * x * (3.0f - 2.0f * x) * 0.5f * INV_PI * inversesqrt(det);
    float wide = clamp((v - 0.06f) * (1.0f / 0.315f), 0.0f, 1.0f);
    if (wide <= 0.0f)
        return disc;
    return mix(disc, slope_density(normals, C + S * (1.0f - v * (4.0f / 3.0f)), d), wide);
}

/* D_slopes() of facets that bring light of the sun's disc. */
FN float D_sun(int normals, vec3 C, vec3 S, vec3 N, vec3 m)
{
    float y = max(m[1], 1e-4f);
    vec2 d = slope_from_normal(vec3(m[0], y, m[2])) - slope_from_normal(N);
    return sel(m[1] > 0.0f, N[1] * sun_density(normals, C, S, d) / (y * y * y * y), 0.0f);
}

/* BRDF times N.L of facets that reflect all light, in 1/sr: D G / (4 N.V), D as wide as slopes and sun (sun: 1; 0: a point far
 * away) are together. Times F(V.H) and the sun's irradiance it is reflected radiance, at most F times that of the disc.
 * 0 where N.L <= 0 or L is below the horizon. */
FN float glitter(int normals, int masking, vec3 C, vec3 N, vec3 L, vec3 V, float sun)
{
    float NdotL = dot(N, L);
    if (NdotL <= 0.0f || L[1] <= 0.0f || dot(N, V) <= 0.0f)
        return 0.0f;
    float D = D_sun(normals, C, sun_slopes(L, V) * sun, N, normalize(V + L));
    if (D < 1e-14f) /* most of the sea, most of the time: nothing of the sun would be seen of it */
        return 0.0f;
    return D * V_slopes(normals, masking, C, N, L, V) * NdotL;
}

/* BTDF times N.L for an eye below that looks along d (unit, up) and the sun above, both at the surface, in 1/sr: facets of the ior n
 * that let all light through,
 *   n^2 (L.m) (d.m) D G / (d.N (L.m - n d.m)^2),  m along n d - L
 * with G of both sides taken as independent: slopes_seen(), or Smith's of GGX. Times 1 - F(L.m) and the sun's irradiance it is the radiance that the eye sees.
 * Walter et al. 2007, equation 21. */
FN float glitter_below(int normals, vec3 C, vec3 N, vec3 L, vec3 d, float n)
{
    vec3 h = L - d * n;                                /* downwards: light is bent towards the normal */
    vec3 m = h * -inversesqrt(max(dot(h, h), 1e-20f)); /* n = 1: 0, and no light is bent */
    float LdotM = dot(L, m);
    float ddotM = dot(d, m);
    float NdotD = dot(N, d);
    if (L[1] <= 0.0f || m[1] <= 0.0f || LdotM <= 0.0f || ddotM <= 0.0f || NdotD <= 0.0f || dot(N, L) <= 0.0f)
        return 0.0f;
    float D = D_sun(normals, C, sun_slopes_about(L, h), N, m);
    float smith = 1.0f / ((1.0f + Lambda_slopes(normals, smith_a(C, N, L))) *
                          (1.0f + Lambda_slopes(normals, smith_a(C, N, d))));
    float G = sel(normals == WATER_BECKMANN, slopes_seen(C, N, m, L) * slopes_seen(C, N, m, d), smith);
    float t = LdotM - n * ddotM;
    return n * n * LdotM * ddotM * D * G / (NdotD * t * t);
}

/* ---- a facet by chance ---- */

/* The inverse of the normal distribution function, u in (0, 1). Giles 2010, "Approximating the erfinv function", single precision. */
FN float inverse_normal(float u)
{
    float x = 2.0f * u - 1.0f;
    float w = -log(max((1.0f - x) * (1.0f + x), 1e-30f));
    float v = w - 2.5f;
    float p = 2.81022636e-08f;
    p = 3.43273939e-07f + p * v;
    p = -3.5233877e-06f + p * v;
    p = -4.39150654e-06f + p * v;
    p = 0.00021858087f + p * v;
    p = -0.00125372503f + p * v;
    p = -0.00417768164f + p * v;
    p = 0.246640727f + p * v;
    p = 1.50140941f + p * v;
    float t = sqrt(w) - 3.0f;
    float q = -0.000200214257f;
    q = 0.000100950558f + q * t;
    q = 0.00134934322f + q * t;
    q = -0.00367342844f + q * t;
    q = 0.00573950773f + q * t;
    q = -0.0076224613f + q * t;
    q = 0.00943887047f + q * t;
    q = 1.00167406f + q * t;
    q = 2.83297682f + q * t;
    return 1.41421356f * x * sel(w < 5.0f, p, q);
}

/* Share of a normal distribution below z standard deviations. */
FN float normal_below(float z)
{
    float tail = 0.5f * exp(-0.5f * z * z) * erfcx(abs(z) * 0.707106781f);
    return sel(z < 0.0f, tail, 1.0f - tail);
}

/* Of the area that slopes_seen() leaves to an eye a standard deviations above the surface, c0 = a: the share that is tilted to it by less
 * than x of them. The integral of x / a (phi(x - a) - phi(x + a)):
 *   Phi(x - a) - Phi(-x - a) - (phi(x - a) - phi(x + a)) / a
 * a, x >= 0, within 1e-6. */
FN float tilts_seen(float a, float x)
{
    float t = a * x;
    float near = 2.0f * x * exp(-0.5f * (x * x + a * a)) * (1.0f + t * t * (1.0f / 6.0f + t * t / 120.0f));
    float far = (exp(-0.5f * (x - a) * (x - a)) - exp(-0.5f * (x + a) * (x + a))) / max(a, 1e-6f);
    return normal_below(x - a) - normal_below(-x - a) - 0.398942280f * sel(t < 0.5f, near, far);
}

/* Normal of a facet of Gaussian slopes, with the density D max(V.m, 0) slopes_seen() of those that V sees, unit; found by halving. Across,
 * slopes are Gaussian about their regression. What it mirrors, L, weighs F(V.m) slopes_seen(L) where L.y > 0. */
FN vec3 sample_slopes(vec2 u, vec3 C, vec3 N, vec3 V)
{
    float across2 = V[0] * V[0] + V[2] * V[2];
    vec2 t = sel(across2 > 1e-10f, vec2(V[0], V[2]) * inversesqrt(max(across2, 1e-10f)), vec2(1.0f, 0.0f));
    float variance = slope_variance(C, t);
    float sd = sqrt(variance);
    float a = clamp(dot(N, V) / (N[1] * sd * max(sqrt(across2), 1e-6f)), 0.0f, 1e4f);
    float high = a + 6.5f;
    float low = max(a - 6.0f, 0.0f);
    for (int i = 0; i < 18; ++i) {
        float middle = 0.5f * (low + high);
        bool is_above = tilts_seen(a, middle) > u[0];
        high = sel(is_above, middle, high);
        low = sel(is_above, low, middle);
    }
    float along = (a - 0.5f * (low + high)) * sd;
    float mixed =
        (C[1] - C[0]) * t[0] * t[1] + C[2] * (t[0] * t[0] - t[1] * t[1]); /* covariance with across */
    float rest = max(C[0] * C[1] - C[2] * C[2], 0.0f) / variance;
    float sideways = mixed / variance * along + sqrt(rest) * inverse_normal(clamp(u[1], 1e-7f, 0.9999999f));
    return normal_from_slope(slope_from_normal(N) + t * along + vec2(-t[1], t[0]) * sideways);
}

#endif
