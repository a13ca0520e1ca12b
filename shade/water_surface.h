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
#define WATER_SMITH 0         /* height-correlated, Heitz 2014 */
#define WATER_SCHLICK_KARIS 1 /* separable, k = (r + 1)^2 / 8, for comparison */

/* Slope variance, along each axis, of water that looks flat. */
#define SLOPE_VARIANCE_MIN 1e-8f

/* Largest slope, root of the variance along an axis, that the table of means has; and its size. */
#define WATER_TABLE_SIGMA 0.5f
#define WATER_TABLE_COLUMNS 32
#define WATER_TABLE_ROWS 16

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
 * WATER_SCHLICK_KARIS: V_SchlickGGX with k_direct, which darkens calm water at grazing angles (G1 = 0.29 at N.V = 0.05
 * and roughness 0.02, where 1 is right). */
FN float V_slopes(int normals, int masking, vec3 C, vec3 N, vec3 L, vec3 V)
{
    float NdotL = max(dot(N, L), 1e-6f);
    float NdotV = max(dot(N, V), 1e-6f);
    float Lambda = Lambda_slopes(normals, smith_a(C, N, L)) + Lambda_slopes(normals, smith_a(C, N, V));
    float smith = 0.25f / ((1.0f + Lambda) * NdotL * NdotV);
    float karis = V_SchlickGGX(NdotL, NdotV, k_direct(roughness_from_slopes(C)));
    return sel(masking == WATER_SCHLICK_KARIS, karis, smith);
}

/* ---- the sun ---- */

/* Slopes that bring light from the disc of the sun (angular radius SUN_RADIUS) to the eye, as a covariance about the slope of the
 * half vector h, L plus what belongs to the eye. The disc is taken for a Gaussian of its radiance in the middle and of its flux,
 * variance radius^2 / 2 along each axis of directions; s = -h_xz / h.y, so ds = -(dL_xz + s dL.y) / h.y. On flat water the
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

/* BRDF times N.L of facets that reflect all light, in 1/sr: D G / (4 N.V), D as wide as slopes and sun (sun: 1; 0: a point far
 * away) are together. Times F(V.H) and the sun's irradiance it is reflected radiance, at most F times that of the disc.
 * 0 where N.L <= 0 or L is below the horizon. */
FN float glitter(int normals, int masking, vec3 C, vec3 N, vec3 L, vec3 V, float sun)
{
    float NdotL = dot(N, L);
    if (NdotL <= 0.0f || L[1] <= 0.0f || dot(N, V) <= 0.0f)
        return 0.0f;
    float D = D_slopes(normals, C + sun_slopes(L, V) * sun, N, normalize(V + L));
    if (D < 1e-14f) /* most of the sea, most of the time: nothing of the sun would be seen of it */
        return 0.0f;
    return D * V_slopes(normals, masking, C, N, L, V) * NdotL;
}

/* BTDF times N.L for an eye below that looks along d (unit, up) and the sun above, both at the surface, in 1/sr: facets of the ior n
 * that let all light through,
 *   n^2 (L.m) (d.m) D G / (d.N (L.m - n d.m)^2),  m along n d - L
 * with G of both sides taken as independent. Times 1 - F(L.m) and the sun's irradiance it is the radiance that the eye sees.
 * Walter et al. 2007, equation 21. */
FN float glitter_below(int normals, vec3 C, vec3 N, vec3 L, vec3 d, float n)
{
    vec3 h = L - d * n; /* downwards: light is bent towards the normal */
    vec3 m = -normalize(h);
    float LdotM = dot(L, m);
    float ddotM = dot(d, m);
    float NdotD = dot(N, d);
    if (L[1] <= 0.0f || m[1] <= 0.0f || LdotM <= 0.0f || ddotM <= 0.0f || NdotD <= 0.0f || dot(N, L) <= 0.0f)
        return 0.0f;
    float D = D_slopes(normals, C + sun_slopes_about(L, h), N, m);
    float G = 1.0f / ((1.0f + Lambda_slopes(normals, smith_a(C, N, L))) *
                      (1.0f + Lambda_slopes(normals, smith_a(C, N, d))));
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

/* n Phi(z) + phi(z), Phi and phi of the normal distribution: area of Gaussian slopes up to z that is seen n standard deviations above the
 * surface. z at most n. */
FN float seen_slopes(float n, float z)
{
    float phi = exp(-0.5f * z * z);
    float tail = 0.5f * phi * erfcx(abs(z) * 0.707106781f);
    return n * sel(z < 0.0f, tail, 1.0f - tail) + 0.398942280f * phi;
}

/* Normal of a facet of Gaussian slopes, with the density D max(V.m, 0) of those that V sees, unit. Along V, its slope has the
 * density (n - z) phi(z) for z < n in standard deviations; found by halving. Across, slopes are Gaussian about their regression. What it
 * mirrors, L, weighs F(V.m) G2 / G1 = F (1 + Lambda(V)) / (1 + Lambda(V) + Lambda(L)) where L.y > 0. Heitz 2014; Jakob 2014. */
FN vec3 sample_slopes(vec2 u, vec3 C, vec3 N, vec3 V)
{
    float across2 = V[0] * V[0] + V[2] * V[2];
    vec2 t = sel(across2 > 1e-10f, vec2(V[0], V[2]) * inversesqrt(max(across2, 1e-10f)), vec2(1.0f, 0.0f));
    float variance = slope_variance(C, t);
    float sd = sqrt(variance);
    float n = min(dot(N, V) / (N[1] * sd * max(sqrt(across2), 1e-6f)), 1e4f);
    float high = min(n, 6.0f);
    float low = -6.0f;
    float share = u[0] * seen_slopes(n, high);
    for (int i = 0; i < 18; ++i) {
        float middle = 0.5f * (low + high);
        bool is_above = seen_slopes(n, middle) > share;
        high = sel(is_above, middle, high);
        low = sel(is_above, low, middle);
    }
    float along = 0.5f * (low + high) * sd;
    float mixed =
        (C[1] - C[0]) * t[0] * t[1] + C[2] * (t[0] * t[0] - t[1] * t[1]); /* covariance with across */
    float rest = max(C[0] * C[1] - C[2] * C[2], 0.0f) / variance;
    float sideways = mixed / variance * along + sqrt(rest) * inverse_normal(clamp(u[1], 1e-7f, 0.9999999f));
    return normal_from_slope(slope_from_normal(N) + t * along + vec2(-t[1], t[0]) * sideways);
}

/* ---- means over all facets that are seen ---- */

/* Of a sea with Gaussian slopes of variance sigma^2 along each axis; N up, V at the cosine mu. Light that facets reflect
 * counts by area seen and Fresnel reflectance. */
STRUCT(WaterMeans)
{
    float fresnel; /* mean reflectance over that of flat water */
    float escape;  /* share of the reflected light that comes from the sky; the rest is that of other waves */
    float
        lift; /* rad: how far above the direction that flat water mirrors the mean of those stands where it comes from */
    float spread;    /* 1 minus the length of the mean of these unit directions, [0, 1] */
    float below;     /* share of the area seen that mirrors what is below the horizon */
    float elevation; /* rad, mean over the light that is reflected from above the horizon */
};

/* The integral by n x n points. sigma 0 is flat water. Reflected directions, masked with Smith's G2 / G1 = (1 + Lambda(V)) /
 * (1 + Lambda(V) + Lambda(L)); points are spread evenly over azimuths of slope, and for their size by its distribution, closer where it is
 * large. Ross, Dion and Potvin 2005, section 3. */
FN WaterMeans integrate_water_means(int normals, float mu, float sigma, float ior, int n)
{
    float s = max(sigma, 1e-4f);
    float NdotV = max(mu, 1e-4f);
    vec3 N = vec3(0.0f, 1.0f, 0.0f);
    vec3 C = vec3(s * s, s * s, 0.0f);
    vec3 V = vec3(sqrt(max(1.0f - NdotV * NdotV, 0.0f)), NdotV, 0.0f);
    vec3 mirror = vec3(-V[0], V[1], 0.0f);
    vec3 across = vec3(V[1], V[0], 0.0f);
    float Lambda_V = Lambda_slopes(normals, smith_a(C, N, V));
    float area = 0.0f;
    float below = 0.0f;
    float reflected = 0.0f;
    float escaped = 0.0f;
    float elevation = 0.0f;
    float above_horizon = 0.0f;
    float astray = 0.0f; /* 1 - cos to what flat water mirrors, without rounding */
    float raised = 0.0f;
    for (int i = 0; i < n; ++i) {
        float tail = 1.0f - (float(i) + 0.5f) / float(n);
        float above = tail * tail; /* share of slopes that are larger */
        float radius = s * sqrt(2.0f * sel(normals == WATER_GGX, (1.0f - above) / above, -log(above)));
        for (int j = 0; j < n; ++j) {
            float phi = PI * (float(j) + 0.5f) / float(n);
            vec2 slope = vec2(radius * cos(phi), radius * sin(phi));
            vec3 m = normal_from_slope(slope);
            float VdotM = dot(V, m);
            float seen = max(VdotM, 0.0f) / m[1] * tail;
            float light = seen * F_dielectric(clamp(VdotM, 0.0f, 1.0f), ior);
            vec3 L = m * (2.0f * VdotM) - V;
            float Lambda_L = Lambda_slopes(normals, smith_a(C, N, L));
            float to_sky = sel(L[1] > 0.0f, light * (1.0f + Lambda_V) / (1.0f + Lambda_V + Lambda_L), 0.0f);
            area += seen;
            below += sel(L[1] > 0.0f, 0.0f, seen);
            reflected += light;
            escaped += to_sky;
            elevation += sel(L[1] > 0.0f, light, 0.0f) * atan(L[1], length(vec2(L[0], L[2])));
            above_horizon += sel(L[1] > 0.0f, light, 0.0f);
            astray += 0.5f * dot(L - mirror, L - mirror) * to_sky;
            raised += dot(across, L) * to_sky;
        }
    }
    WaterMeans r;
    r.fresnel = reflected / (area * F_dielectric(NdotV, ior));
    r.escape = escaped / reflected;
    astray = astray / escaped;
    raised = raised / escaped;
    r.lift = atan(raised, 1.0f - astray);
    float missing = astray * (2.0f - astray) - raised * raised; /* 1 - length^2 */
    r.spread = max(missing, 0.0f) / (1.0f + sqrt(max(1.0f - missing, 0.0f)));
    r.below = below / area;
    r.elevation = elevation / above_horizon;
    return r;
}

/* Bruneton, Neyret and Holzschuch 2010, equation 15, in the place of mean reflectance (not over that of flat water):
 *   R0 + (1 - R0) (1 - mu)^(5 exp(-2.69 sigma)) / (1 + 22.7 sigma^1.5)
 * Within 0.009 of the integral up to 80 degrees from the vertical, 0.07 too large at the horizon. */
FN float water_mean_fresnel_fit(float mu, float sigma, float ior)
{
    float R0 = F0_from_ior(ior);
    float power = 5.0f * exp(-2.69f * sigma);
    return R0 + (1.0f - R0) * pow(clamp(1.0f - mu, 1e-6f, 1.0f), power) /
                    (1.0f + 22.7f * pow(max(sigma, 1e-6f), 1.5f));
}

/* Where a pair of (mu, sigma) stands in the table, from 0 to WATER_TABLE_COLUMNS - 1 and WATER_TABLE_ROWS - 1: both with the
 * square, closer near grazing angles and flat water. Texels are at whole numbers, linear in between. And the pair of a place. */
FN vec2 water_table_place(float mu, float sigma)
{
    return vec2(sqrt(clamp(mu, 0.0f, 1.0f)) * float(WATER_TABLE_COLUMNS - 1),
                sqrt(clamp(sigma / WATER_TABLE_SIGMA, 0.0f, 1.0f)) * float(WATER_TABLE_ROWS - 1));
}
FN vec2 water_table_pair(vec2 place)
{
    float x = place[0] / float(WATER_TABLE_COLUMNS - 1);
    float y = place[1] / float(WATER_TABLE_ROWS - 1);
    return vec2(x * x, WATER_TABLE_SIGMA * y * y);
}

/* Root of the variance of slopes against N in the plane of N and V: what sigma is for a surface of any normal. Where V is N, of
 * the mean of both axes. */
FN float sigma_towards(vec3 C, vec3 N, vec3 V)
{
    vec3 t = V - N * dot(N, V);
    float length2 = dot(t, t);
    float variance = slope_variance(C, vec2(t[0], t[2])) / max(length2, 1e-8f);
    return N[1] * sqrt(max(sel(length2 > 1e-6f, variance, 0.5f * (C[0] + C[1])), 0.0f));
}

/* Perceptual roughness whose prefiltered light (prefilter_sample() of ibl.h) comes from directions as far apart as `spread` tells:
 * whose mean, weighted as there, is a vector of the length 1 - spread. A fit, within 0.006 in [0, 1]; 0 for a mirror. */
FN float roughness_from_spread(float spread)
{
    float d = clamp(spread, 0.0f, 0.3333f);
    float y = sqrt(sqrt(d));
    return clamp(y * (0.49444f + 0.89477f * y * y) + 18.357f * d * d * d * d, 0.0f, 1.0f);
}

/* The direction that a surface of normal N reflects to the eye, raised by WaterMeans.lift in the plane of N and V; not below the
 * horizon. Unit. */
FN vec3 raised_reflection(vec3 N, vec3 V, float lift)
{
    float NdotV = dot(N, V);
    vec3 tangent = V - N * NdotV; /* sin theta long, as the reflection's is */
    float sin_theta = sqrt(dot(tangent, tangent));
    vec3 across = tangent * (NdotV / max(sin_theta, 1e-6f)) + N * sin_theta;
    vec3 R = (N * NdotV - tangent) * cos(lift) + across * sin(lift);
    return normalize(vec3(R[0], max(R[1], 0.0f), R[2]));
}

#endif
