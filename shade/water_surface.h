/* water_surface.h - unresolved waves as microfacets with a slope covariance: reflection of the sun and, on
 * average, of the sky.
 *
 * Axes: +Y up. A normal n with n.y > 0 has the slope s = (-n.x, -n.z) / n.y. Slopes of the microfacets are
 * distributed around that of N, the normal of the resolved waves, with covariance (xx, zz, xz) in world axes:
 * the microsurface is a sum of waves, and its mean normal is exactly N (Dupuy et al. 2013, "LEADR mapping",
 * section 4). V to the eye, L to the sun, unit.
 *
 * A covariance must not be singular: add SLOPE_VARIANCE_MIN to its diagonal. */
#ifndef SHADE_WATER_SURFACE_H
#define SHADE_WATER_SURFACE_H

/* Slope distribution. */
#define WATER_BECKMANN 0 /* Gaussian, nearly that of the sea */
#define WATER_GGX 1
/* Masking. */
#define WATER_SCALES 0 /* superposed waves of all lengths: slopes_seen(); Smith for GGX */
#define WATER_SMITH 1  /* uncorrelated neighboring facets; height-correlated masking-shadowing, Heitz 2014 */
#define WATER_SCHLICK_KARIS 2 /* separable, k = (r + 1)^2 / 8, for comparison */

/* Slope variance, along each axis, of water that appears flat. */
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

/* Distribution of microfacet normals m, in 1/sr, per area of the surface of normal N:
 *   D = N.y p(s_m - s_N) / m.y^4,  so that the integral of D m is N
 * 0 for m.y <= 0. */
FN float D_slopes(int normals, vec3 C, vec3 N, vec3 m)
{
    float y = max(m[1], 1e-4f);
    vec2 d = slope_from_normal(vec3(m[0], y, m[2])) - slope_from_normal(N);
    return sel(m[1] > 0.0f, N[1] * slope_density(normals, C, d) / (y * y * y * y), 0.0f);
}

/* ---- masking ---- */

/* Smith's a: elevation of the direction X in root mean square slopes (times sqrt 2), 1 / (alpha tan theta):
 *   a = (N.X / N.y) / sqrt(2 X_h^T C X_h)
 * Heitz 2014, equations 79 and 80, with slopes around those of N. */
FN float smith_a(vec3 C, vec3 N, vec3 X)
{
    float variance = max(slope_variance(C, vec2(X[0], X[2])), 1e-14f);
    return dot(N, X) / N[1] * inversesqrt(2.0f * variance);
}

/* Masking of superposed waves: the fraction of the microfacets of normal m, on a surface of normal N, visible
 * from X; X.m, X.N > 0:
 *   G1 = 1 - exp(-2 c0 c / (X_h^T C X_h)),  c0 = N.X / N.y,  c = m.X / m.y
 * c is the tilt of a slope towards X. Waves are added from the longest to the shortest: c goes from that
 * of N to that of m in small independent Gaussian steps, since every octave of a sea adds about as much to
 * the variance. Water that faces away from X with the waves so far is hidden and stays hidden: of all
 * walks from c0 to c only those that never reach 0 are visible. The others correspond to walks from -c0 to
 * c (reflection principle), p(c + c0) of p(c - c0).
 *
 * The projected visible area, D m.X G1, has the integral N.X, as required. Along X its slopes are
 * distributed as c / c0 (p(c - c0) - p(c + c0)): a walk conditioned to stay positive, or the length of a
 * three-dimensional random vector (Williams 1974; Pitman 1975). At grazing angles that is c^2 p(c),
 * steeper than Smith's c p(c):
 * 1.6 standard deviations towards the eye on average instead of 1.25, and a sea of 10 m/s reflects a quarter
 * less.
 *
 * Since walks can be stopped anywhere, a surface may be split at any wavelength: masking of long waves, times
 * masking of short waves on them, is masking of all. So a pixel shows the same light whichever waves it
 * resolves.
 *
 * It is a limit: heights are Gaussian, waves of different lengths are independent, and there are many
 * octaves. For surfaces equally steep in every octave, ray marching (test_marched) finds tilts of 1.51
 * deviations at grazing angles with 14 octaves, as many as a sea of 10 m/s has, 1.47 with 11, 1.37 with 6,
 * and 1.15 for a single one, for which Smith is right. Visibility from V and L is assumed independent,
 * which is exact for perpendicular azimuths; for equal azimuths at half a deviation the product is 0.155
 * where 0.12 (14) to 0.16 (11) are found. */
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

/* The same for GGX: (sqrt(1 + 1 / a^2) - 1) / 2. Heitz 2014, equation 68. */
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

/* GGX width with the peak of the slope distribution: alpha = sqrt(C_xx + C_zz), and its perceptual roughness. */
FN float roughness_from_slopes(vec3 C)
{
    return sqrt(sqrt(clamp(C[0] + C[1], 0.0f, 1.0f)));
}

/* Isotropic slope covariance of a perceptual roughness. */
FN vec3 slopes_from_roughness(float perceptual_roughness)
{
    float alpha = alpha_from_roughness(perceptual_roughness);
    float variance = max(0.5f * alpha * alpha, SLOPE_VARIANCE_MIN);
    return vec3(variance, variance, 0.0f);
}

/* Visibility G / (4 N.L N.V), both cosines > 0. WATER_SMITH: 1 / (1 + Lambda(V) + Lambda(L)), Heitz 2014,
 * equation 99. WATER_SCALES: slopes_seen() for both; Smith for GGX, whose slopes have no variance.
 * WATER_SCHLICK_KARIS: V_SchlickGGX with k_direct, which darkens calm water at grazing angles (G1 = 0.29
 * at N.V = 0.05 and roughness 0.02, where 1 is right). */
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

/* Slopes that reflect the disc of the sun (angular radius SUN_RADIUS) to the eye, around the slope of the
 * half vector h (L plus a term of the eye): twice their covariance, of a Gaussian with the same peak and
 * flux, whose variance is radius^2 / 2 along each axis of directions; s = -h_xz / h.y, so ds = -(dL_xz + s
 * dL.y) / h.y. On flat water the image of the sun is F times as bright as its disc at any angle; facing
 * it, alpha^2 is radius^2
 * / 4. */
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
/* For reflection. */
FN vec3 sun_slopes(vec3 L, vec3 V)
{
    return sun_slopes_about(L, V + L);
}

/* Density of slopes C around their mean, convolved with the disc of the sun whose slopes are S
 * (sun_slopes(); 0: a point): of those that reflect the sun to the eye at a distance d. The disc is an
 * ellipse of the area 2 pi sqrt |S| and the covariance S / 2. With its radius as unit, the slopes have the
 * variance v = tr(S^-1 C) /
 * 4. For small v the disc is resolved, its edge blurred by the slopes and, to conserve flux, at sqrt(1 - v);
 * from 3/8 on a Gaussian is as good; in between it is a mixture with one wide enough not to exceed the disc.
 * The integral is 1, the covariance C + S / 2 within a fifth, and the maximum 1 / (2 pi sqrt |S|). */
FN float sun_density(int normals, vec3 C, vec3 S, vec2 d)
{
    float det = max(S[0] * S[1] - S[2] * S[2], 0.0f);
    float spread = 0.25f * (S[1] * C[0] + S[0] * C[1] - 2.0f * S[2] * C[2]);
    if (spread >= 0.375f * det)
        return slope_density(normals, C + S * 0.5f, d);
    float v = spread / det;
    float blur = min(v, 0.16f); /* a wider edge would reach the center */
    float off = S[1] * d[0] * d[0] + S[0] * d[1] * d[1] - 2.0f * S[2] * d[0] * d[1];
    float inside = sqrt(1.0f - blur) - sqrt(max(0.5f * off / det, 0.0f));
    float x = clamp(0.5f + 0.5f * inside * inversesqrt(5.0f * blur), 0.0f, 1.0f);
    float disc = x * x * (3.0f - 2.0f * x) * 0.5f * INV_PI * inversesqrt(det);
    float wide = clamp((v - 0.06f) * (1.0f / 0.315f), 0.0f, 1.0f);
    if (wide <= 0.0f)
        return disc;
    return mix(disc, slope_density(normals, C + S * (1.0f - v * (4.0f / 3.0f)), d), wide);
}

/* D_slopes() convolved with the disc of the sun. */
FN float D_sun(int normals, vec3 C, vec3 S, vec3 N, vec3 m)
{
    float y = max(m[1], 1e-4f);
    vec2 d = slope_from_normal(vec3(m[0], y, m[2])) - slope_from_normal(N);
    return sel(m[1] > 0.0f, N[1] * sun_density(normals, C, S, d) / (y * y * y * y), 0.0f);
}

/* BRDF times N.L of perfectly reflecting facets, in 1/sr: D G / (4 N.V), D of slopes and sun together
 * (sun: 1; 0: a point). Times F(V.H) and the sun's irradiance it is the reflected radiance, at most F
 * times that of the disc. 0 for N.L <= 0 or L below the horizon. */
FN float glitter(int normals, int masking, vec3 C, vec3 N, vec3 L, vec3 V, float sun)
{
    float NdotL = dot(N, L);
    if (NdotL <= 0.0f || L[1] <= 0.0f || dot(N, V) <= 0.0f)
        return 0.0f;
    float D = D_sun(normals, C, sun_slopes(L, V) * sun, N, normalize(V + L));
    if (D < 1e-14f) /* most of the sea, most of the time: the sun would not be visible in it */
        return 0.0f;
    return D * V_slopes(normals, masking, C, N, L, V) * NdotL;
}

/* BTDF times N.L for an eye below, with the view direction d (unit, up), and the sun above, both at the
 * surface, in 1/sr: perfectly transmitting facets of the ior n,
 *   n^2 (L.m) (d.m) D G / (d.N (L.m - n d.m)^2),  m along n d - L
 * with independent masking on both sides: slopes_seen(), or Smith for GGX. Times 1 - F(L.m) and the sun's
 * irradiance it is the transmitted radiance. Walter et al. 2007, equation 21. */
FN float glitter_below(int normals, vec3 C, vec3 N, vec3 L, vec3 d, float n)
{
    vec3 h = L - d * n;                                /* downwards: light is refracted towards the normal */
    vec3 m = h * -inversesqrt(max(dot(h, h), 1e-20f)); /* n = 1: 0, no refraction */
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

/* ---- sampling of a facet ---- */

/* The inverse of the normal distribution function, u in (0, 1). Giles 2010, "Approximating the erfinv
 * function", single precision. */
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

/* Cumulative normal distribution at z standard deviations. */
FN float normal_below(float z)
{
    float tail = 0.5f * exp(-0.5f * z * z) * erfcx(abs(z) * 0.707106781f);
    return sel(z < 0.0f, tail, 1.0f - tail);
}

/* Cumulative distribution of the tilts of visible area (slopes_seen()), for an eye a standard deviations
 * above the surface, c0 = a: the fraction tilted towards it by less than x. The integral of x / a (phi(x -
 * a) - phi(x + a)):
 *   Phi(x - a) - Phi(-x - a) - (phi(x - a) - phi(x + a)) / a
 * a, x >= 0, within 1e-6. */
FN float tilts_seen(float a, float x)
{
    float t = a * x;
    float near = 2.0f * x * exp(-0.5f * (x * x + a * a)) * (1.0f + t * t * (1.0f / 6.0f + t * t / 120.0f));
    float far = (exp(-0.5f * (x - a) * (x - a)) - exp(-0.5f * (x + a) * (x + a))) / max(a, 1e-6f);
    return normal_below(x - a) - normal_below(-x - a) - 0.398942280f * sel(t < 0.5f, near, far);
}

/* Samples the unit normal of a facet of Gaussian slopes with the density D max(V.m, 0) slopes_seen() of the
 * visible ones, by bisection. Across, slopes are Gaussian around their regression. The reflected direction L
 * has the weight F(V.m) slopes_seen(L) if L.y > 0. */
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
