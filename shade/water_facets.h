/* water_facets.h - facets of water in which something is to be seen: those of all that an eye sees that may mirror a box, and some of
 * them by chance. What is small, and is mirrored by few facets of a rough surface, is found by as many rays as what is large.
 *
 * Facets have Gaussian slopes (water_surface.h). Their places are in standard deviations from the mean: z.x along the eye's direction,
 * z.y across, about the regression on z.x, so that both are independent and normal. */
#ifndef SHADE_WATER_FACETS_H
#define SHADE_WATER_FACETS_H

/* Beyond so many standard deviations no facet is looked at. */
#define FACETS_END 4.0f

/* A rectangle of places. */
STRUCT(FacetRange)
{
    vec2 towards; /* unit, horizontal, to the eye */
    float along;  /* standard deviation of slopes along it */
    float lean;   /* slope across for one such deviation */
    float across; /* standard deviation about that */
    float n;      /* how many deviations a facet is that the eye sees edge on */
    vec2 low, high;
};

/* All that an eye sees of facets with the covariance C about the normal N; V: unit, to it. */
FN FacetRange facets_seen(vec3 C, vec3 N, vec3 V)
{
    FacetRange r;
    float level2 = V[0] * V[0] + V[2] * V[2];
    r.towards = sel(level2 > 1e-10f, vec2(V[0], V[2]) * inversesqrt(max(level2, 1e-10f)), vec2(1.0f, 0.0f));
    vec2 t = r.towards;
    float variance = slope_variance(C, t);
    r.along = sqrt(variance);
    r.lean = ((C[1] - C[0]) * t[0] * t[1] + C[2] * (t[0] * t[0] - t[1] * t[1])) / r.along;
    r.across = sqrt(max(C[0] * C[1] - C[2] * C[2], 0.01f * SLOPE_VARIANCE_MIN * variance) / variance);
    r.n = min(dot(N, V) / (N[1] * r.along * max(sqrt(level2), 1e-6f)), 1e4f);
    r.low = vec2(-FACETS_END);
    r.high = vec2(min(r.n, FACETS_END), FACETS_END);
    return r;
}

/* Where the facet of normal m is. */
FN vec2 facet_place(FacetRange r, vec3 N, vec3 m)
{
    vec2 d = slope_from_normal(m) - slope_from_normal(N);
    float z = dot(r.towards, d) / r.along;
    return vec2(z, (r.towards[0] * d[1] - r.towards[1] * d[0] - r.lean * z) / r.across);
}

/* Of those, which may mirror a box; low, high: its corners from the place of the surface. What facets send down meets another wave and
 * goes up again: they show the box as if it stood upside down as well. Larger than need be where the box is wide. */
FN FacetRange facets_that_mirror(vec3 C, vec3 N, vec3 V, vec3 low, vec3 high)
{
    FacetRange all = facets_seen(C, N, V);
    FacetRange r = all;
    vec3 middle = normalize(0.5f * (low + high) + vec3(0.0f, 1e-6f, 0.0f));
    float bottom = min(low[1], -high[1]);
    bool is_wide = false;
    r.low = vec2(1e9f);
    r.high = vec2(-1e9f);
    for (int i = 0; i < 8; ++i) {
        vec3 D = normalize(vec3(sel(i % 2 == 0, low[0], high[0]), sel(i < 4, bottom, high[1]),
                                sel(i / 2 % 2 == 0, low[2], high[2])));
        is_wide = is_wide || dot(vec2(D[0], D[2]), vec2(middle[0], middle[2])) < 0.5f;
        vec3 H = V + normalize(vec3(D[0], max(D[1], -0.5f * V[1]), D[2])); /* seen edge on, the lowest */
        vec2 z = facet_place(all, N, vec3(H[0], max(H[1], 1e-4f), H[2]));
        r.low = min(r.low, z);
        r.high = max(r.high, z);
    }
    if (is_wide)
        return all;
    vec2 margin = (r.high - r.low) * 0.1f + 0.01f; /* edges of the box are bent */
    r.low = max(r.low - margin, all.low);
    r.high = min(r.high + margin, all.high);
    return r;
}

/* Share of all facets that is in the rectangle, seen or not; 0: it is empty. */
FN float facets_share(FacetRange r)
{
    vec2 from = vec2(normal_below(r.low[0]), normal_below(r.low[1]));
    vec2 to = vec2(normal_below(r.high[0]), normal_below(r.high[1]));
    return max(to[0] - from[0], 0.0f) * max(to[1] - from[1], 0.0f);
}

/* A facet, and what it stands for: the mean of weights over many is the share that the rectangle has of what is seen. */
STRUCT(Facet)
{
    vec3 m; /* unit normal */
    float weight;
};

/* u: uniform in [0, 1)^2. Density phi(z.x) phi(z.y) in the rectangle; of facets that are seen (slopes_seen()) it is
 * (1 - z.x / n) (1 - exp(-2 n (n - z.x))) phi(z.x) phi(z.y), as sample_slopes() has it. */
FN Facet facet_drawn(FacetRange r, vec3 N, vec2 u)
{
    float x = mix(normal_below(r.low[0]), normal_below(r.high[0]), u[0]);
    float y = mix(normal_below(r.low[1]), normal_below(r.high[1]), u[1]);
    float z = inverse_normal(clamp(x, 1e-7f, 0.9999999f));
    float sideways = r.lean * z + r.across * inverse_normal(clamp(y, 1e-7f, 0.9999999f));
    Facet f;
    f.m = normal_from_slope(slope_from_normal(N) + r.towards * (z * r.along) +
                            vec2(-r.towards[1], r.towards[0]) * sideways);
    float n = max(r.n, 1e-3f);
    float tilt = max(n - z, 0.0f);
    f.weight = facets_share(r) * tilt / n * (1.0f - exp(-2.0f * n * tilt));
    return f;
}

#endif
