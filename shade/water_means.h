/* water_means.h - mean reflection of the sky by a rough sea: means over all visible facets, kept as a LUT,
 * and the lookup direction and lobe they imply. Slopes and masking are those of water_surface.h.
 *
 * A pixel with several samples may sample facets instead (sample_slopes()), which is exact; one direction and
 * one round lobe are within 2 % where the sea is seen from above, and up to 15 % too dark near the horizon
 * below a sky that is six times as bright there as at the zenith. */
#ifndef SHADE_WATER_MEANS_H
#define SHADE_WATER_MEANS_H

/* Largest slope deviation along an axis in the LUT of means; and its size. */
#define WATER_TABLE_SIGMA 0.5f
#define WATER_TABLE_COLUMNS 32
#define WATER_TABLE_ROWS 16

/* Means for a sea with Gaussian slopes of variance sigma^2 along each axis; N up, V at the cosine mu.
 * Reflected light is weighted by visible area and Fresnel reflectance. */
STRUCT(WaterMeans)
{
    float fresnel; /* mean reflectance relative to flat water */
    float escape;  /* fraction of the reflected light that comes from the sky rather than from other waves */
    float lift;    /* rad: elevation of its mean direction above the mirror direction of flat water */
    float spread;  /* 1 minus the length of the mean of these unit directions, [0, 1] */
    float below;   /* fraction of the visible area that reflects directions below the horizon */
    float elevation; /* rad, mean over the light reflected from above the horizon */
};

/* The integral by n x n points. sigma 0 is flat water. Facets and reflected directions are masked by
 * slopes_seen() (WATER_SCALES, Gaussian slopes), or with Smith's G2 / G1 = (1 + Lambda(V)) / (1 + Lambda(V) +
 * Lambda(L)); points are uniform in the azimuth of the slope, and importance-sampled in its magnitude, denser
 * where it is large. Ross, Dion and Potvin 2005, section 3. */
FN WaterMeans integrate_water_means(int normals, int masking, float mu, float sigma, float ior, int n)
{
    float s = max(sigma, 1e-4f);
    float NdotV = max(mu, 1e-4f);
    vec3 N = vec3(0.0f, 1.0f, 0.0f);
    vec3 C = vec3(s * s, s * s, 0.0f);
    vec3 V = vec3(sqrt(max(1.0f - NdotV * NdotV, 0.0f)), NdotV, 0.0f);
    vec3 mirror = vec3(-V[0], V[1], 0.0f);
    vec3 across = vec3(V[1], V[0], 0.0f);
    bool by_scales = masking == WATER_SCALES && normals == WATER_BECKMANN;
    float Lambda_V = Lambda_slopes(normals, smith_a(C, N, V));
    float area = 0.0f;
    float below = 0.0f;
    float reflected = 0.0f;
    float escaped = 0.0f;
    float elevation = 0.0f;
    float above_horizon = 0.0f;
    float astray = 0.0f; /* 1 - cos to the mirror direction of flat water, without rounding */
    float raised = 0.0f;
    for (int i = 0; i < n; ++i) {
        float tail = 1.0f - (float(i) + 0.5f) / float(n);
        float above = tail * tail; /* fraction of larger slopes */
        float radius = s * sqrt(2.0f * sel(normals == WATER_GGX, (1.0f - above) / above, -log(above)));
        for (int j = 0; j < n; ++j) {
            float phi = PI * (float(j) + 0.5f) / float(n);
            vec2 slope = vec2(radius * cos(phi), radius * sin(phi));
            vec3 m = normal_from_slope(slope);
            float VdotM = dot(V, m);
            float visible = sel(by_scales, slopes_seen(C, N, m, V), 1.0f);
            float seen = sel(VdotM > 0.0f, VdotM / m[1] * tail * visible, 0.0f);
            float light = seen * F_dielectric(clamp(VdotM, 0.0f, 1.0f), ior);
            vec3 L = m * (2.0f * VdotM) - V;
            float Lambda_L = Lambda_slopes(normals, smith_a(C, N, L));
            float smith = (1.0f + Lambda_V) / (1.0f + Lambda_V + Lambda_L);
            float passes = sel(by_scales, slopes_seen(C, N, m, L), smith);
            float to_sky = sel(L[1] > 0.0f, light * passes, 0.0f);
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
    r.fresnel = reflected / max(area * F_dielectric(NdotV, ior), 1e-20f); /* ior 1: there is no surface */
    r.escape = escaped / max(reflected, 1e-20f);
    astray = astray / max(escaped, 1e-20f);
    raised = raised / max(escaped, 1e-20f);
    r.lift = atan(raised, 1.0f - astray);
    float missing = astray * (2.0f - astray) - raised * raised; /* 1 - length^2 */
    r.spread = max(missing, 0.0f) / (1.0f + sqrt(max(1.0f - missing, 0.0f)));
    r.below = below / area;
    r.elevation = elevation / max(above_horizon, 1e-20f);
    return r;
}

/* Bruneton, Neyret and Holzschuch 2010, equation 15, an approximation of the mean reflectance (not
 * relative to flat water):
 *   R0 + (1 - R0) (1 - mu)^(5 exp(-2.69 sigma)) / (1 + 22.7 sigma^1.5)
 * Within 0.009 of the integral up to 80 degrees from the vertical, 0.07 too large at the horizon. */
FN float water_mean_fresnel_fit(float mu, float sigma, float ior)
{
    float R0 = F0_from_ior(ior);
    float power = 5.0f * exp(-2.69f * sigma);
    return R0 +
           (1.0f - R0) * pow(clamp(1.0f - mu, 1e-6f, 1.0f), power) / (1.0f + 22.7f * sigma * sqrt(sigma));
}

/* LUT coordinates of a pair (mu, sigma), from 0 to WATER_TABLE_COLUMNS - 1 and WATER_TABLE_ROWS - 1: both by
 * the square root, denser near grazing angles and flat water. Texels are at integers, linear in between. And
 * the inverse. */
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

/* Standard deviation of slopes relative to N in the plane of N and V: the sigma of a surface of any
 * normal. For V = N, of the mean of both axes. */
FN float sigma_towards(vec3 C, vec3 N, vec3 V)
{
    vec3 t = V - N * dot(N, V);
    float length2 = dot(t, t);
    float variance = slope_variance(C, vec2(t[0], t[2])) / max(length2, 1e-8f);
    return N[1] * sqrt(max(sel(length2 > 1e-6f, variance, 0.5f * (C[0] + C[1])), 0.0f));
}

/* Perceptual roughness whose prefiltering (prefilter_sample() of ibl.h) has the given spread of directions:
 * their weighted mean is a vector of the length 1 - spread. A fit, within 0.006 in [0, 1]; 0 for a perfect
 * mirror. */
FN float roughness_from_spread(float spread)
{
    float d = clamp(spread, 0.0f, 0.3333f);
    float y = sqrt(sqrt(d));
    return clamp(y * (0.49444f + 0.89477f * y * y) + 18.357f * d * d * d * d, 0.0f, 1.0f);
}

/* The reflection of V at N, raised by WaterMeans.lift in the plane of N and V; unit, possibly below the
 * horizon. */
FN vec3 raised_reflection(vec3 N, vec3 V, float lift)
{
    float NdotV = dot(N, V);
    vec3 tangent = V - N * NdotV; /* length sin theta, as the reflection has */
    float sin_theta = sqrt(dot(tangent, tangent));
    vec3 across = tangent * (NdotV / max(sin_theta, 1e-6f)) + N * sin_theta;
    return (N * NdotV - tangent) * cos(lift) + across * sin(lift);
}

#endif
