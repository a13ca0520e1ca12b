/* water_facets.h - facets of water in which something is to be seen: those of all that an eye sees that may mirror a box, or show it
 * through Snell's window, and some of them by chance. What is small, and is shown by few facets of a rough surface, is found by as many rays
 * as what is large. And a few that stand for all that an eye in the water sees, inside of Snell's window and outside of it.
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

/* The rectangle about places, with a margin, as edges of a box are bent; of a box that is wide it is all. */
FN FacetRange facets_about(FacetRange all, vec2 low, vec2 high, bool is_wide)
{
    FacetRange r = all;
    vec2 margin = (high - low) * 0.1f + 0.01f;
    if (is_wide)
        return r;
    r.low = max(low - margin, all.low);
    r.high = min(high + margin, all.high);
    return r;
}

/* Whether a box about the direction `middle` is too wide for its corners to tell which facets show it; D: to a corner. */
FN bool is_wide_box(vec3 middle, vec3 D)
{
    return dot(vec2(D[0], D[2]), vec2(middle[0], middle[2])) < 0.5f;
}

/* Of those, which may mirror a box; low, high: its corners from the place of the surface. What facets send down meets another wave and
 * goes up again: they show the box as if it stood upside down as well. Larger than need be where the box is wide. An eye in the water
 * that looks along V sees what they mirror of the box -high to -low. */
FN FacetRange facets_that_mirror(vec3 C, vec3 N, vec3 V, vec3 low, vec3 high)
{
    FacetRange all = facets_seen(C, N, V);
    vec3 middle = normalize(0.5f * (low + high) + vec3(0.0f, 1e-6f, 0.0f));
    float bottom = min(low[1], -high[1]);
    bool is_wide = false;
    vec2 first = vec2(1e9f);
    vec2 last = vec2(-1e9f);
    for (int i = 0; i < 8; ++i) {
        vec3 D = normalize(vec3(sel(i % 2 == 0, low[0], high[0]), sel(i < 4, bottom, high[1]),
                                sel(i / 2 % 2 == 0, low[2], high[2])));
        is_wide = is_wide || is_wide_box(middle, D);
        vec3 H = V + normalize(vec3(D[0], max(D[1], -0.5f * V[1]), D[2])); /* seen edge on, the lowest */
        vec2 z = facet_place(all, N, vec3(H[0], max(H[1], 1e-4f), H[2]));
        first = min(first, z);
        last = max(last, z);
    }
    return facets_about(all, first, last, is_wide);
}

/* Normal, not of unit length, of the facet that bends light from D, in the air, to an eye in the water that looks along d; both unit:
 *   n d - D
 * Of light that none bends so far it is that of the rim, where D is nearest. */
FN vec3 facet_that_bends(vec3 d, vec3 D, float ior)
{
    float least = 1.0f / ior;
    float c = dot(d, D);
    vec3 beside = D - d * c;
    vec3 rim = d * least + beside * (sqrt(max(1.0f - least * least, 0.0f)) *
                                     inversesqrt(max(dot(beside, beside), 1e-12f)));
    return d * ior - sel(c < least, rim, D);
}

/* Of those that an eye sees which looks along d (unit, up) in the water, which may show a box through Snell's window; low, high: its corners
 * from the place of the surface, none below it. */
FN FacetRange facets_that_bend(vec3 C, vec3 N, vec3 d, vec3 low, vec3 high, float ior)
{
    FacetRange all = facets_seen(C, N, d);
    vec3 middle = normalize(0.5f * (low + high) + vec3(0.0f, 1e-6f, 0.0f));
    bool is_wide = false;
    vec2 first = vec2(1e9f);
    vec2 last = vec2(-1e9f);
    for (int i = 0; i < 8; ++i) {
        vec3 D = normalize(vec3(sel(i % 2 == 0, low[0], high[0]), sel(i < 4, low[1], high[1]),
                                sel(i / 2 % 2 == 0, low[2], high[2])));
        is_wide = is_wide || is_wide_box(middle, D);
        vec3 m = facet_that_bends(d, D, ior);
        vec2 z = facet_place(all, N, vec3(m[0], max(m[1], 1e-4f), m[2]));
        first = min(first, z);
        last = max(last, z);
    }
    return facets_about(all, first, last, is_wide);
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

/* ---- the eye below ---- */

#define WINDOW_CELLS 3
#define WINDOW_FACETS 8
/* Of so small deviations one facet stands for all: their window has an edge a tenth of a degree wide. */
#define WINDOW_SHARP 1e-3f
/* Of the variance of all slopes, what is left within a cell: 1.4^2 / 12, less, and what the rim does not divide. */
#define WINDOW_BETWEEN 0.12f

/* Tilt towards d, in deviations, from which on facets are transparent; 1e9: none is. d unit, up; critical: cosine of the angle of total
 * reflection. c = x along |d_h| is compared with critical sqrt(1 + s_along^2 + s_across^2), side: deviations across. */
FN float window_rim(FacetRange r, vec3 N, vec3 d, float critical, float side)
{
    vec2 t = r.towards;
    vec2 mean = slope_from_normal(N);
    float level2 = max(d[0] * d[0] + d[2] * d[2], 1e-12f);
    float p = d[1] * inversesqrt(level2);
    float A = t[0] * mean[1] - t[1] * mean[0] + r.lean * r.n + r.across * side;
    float c2 = critical * critical;
    float square = r.along * r.along * (level2 - c2) - c2 * r.lean * r.lean;
    float linear = c2 * (p * r.along + A * r.lean);
    float rest = c2 * (1.0f + p * p + A * A);
    float root = linear + sqrt(max(linear * linear + square * rest, 0.0f));
    return sel(linear * linear + square * rest < 0.0f || root <= 0.0f, 1e9f, rest / max(root, 1e-12f));
}

/* The middle of tilts that are seen, in deviations, which have one about it; and the edges of cells. */
FN float window_middle(FacetRange r)
{
    float n = max(r.n, 0.0f);
    return sqrt(n * n + 2.0f);
}
FN float window_edge(FacetRange r, int cell)
{
    float inner = float(2 * cell - WINDOW_CELLS) * 0.7f;
    float outer = sel(cell == 0, -3.5f, 3.5f);
    return max(window_middle(r) + sel(cell == 0 || cell == WINDOW_CELLS, outer, inner), 0.0f);
}

/* Mean of normally distributed numbers between two. */
FN float window_mean(float from, float to)
{
    float share = normal_below(to) - normal_below(from);
    float mean = 0.398942280f * (exp(-0.5f * from * from) - exp(-0.5f * to * to)) / max(share, 1e-4f);
    return sel(to - from < 0.1f || share < 1e-4f, 0.5f * (from + to), clamp(mean, from, to));
}

/* Edge 0 to WINDOW_CELLS + 1 of what the rim of Snell's window makes of the cells: it divides the one that it is in. */
FN float window_part(FacetRange r, float rim, int edge)
{
    float last = sel(edge > 0, window_edge(r, edge - 1), 0.0f);
    float next = sel(edge <= WINDOW_CELLS, window_edge(r, edge), 1e9f);
    return clamp(rim, last, next);
}

/* Perceptual roughness of what one of them shows; C: of all slopes. */
FN float window_roughness(FacetRange r, vec3 C)
{
    return roughness_from_slopes(C * sel(r.along < WINDOW_SHARP, 0.1f, 0.1f * WINDOW_BETWEEN));
}

/* One of WINDOW_FACETS; r: facets_seen(). Their weights sum to 1 within 0.0015. Tilts towards d are in WINDOW_CELLS cells, one of them divided by the rim of
 * Snell's window: a part's weight is exactly what is seen of it, so that light changes smoothly as a wave is tilted.
 * Across, one deviation to either side has the moments of all (Gauss and Hermite). */
FN Facet facet_of_window(FacetRange r, vec3 N, vec3 d, float critical, int k)
{
    float side = sel(k % 2 == 0, -1.0f, 1.0f);
    float first = window_edge(r, 0);
    float rim = clamp(window_rim(r, N, d, critical, side), first, window_edge(r, WINDOW_CELLS));
    float from = window_part(r, rim, k / 2);
    float to = window_part(r, rim, k / 2 + 1);
    Facet f;
    f.m = N;
    f.weight = 0.0f;
    if (from >= to)
        return f;
    float n = max(r.n, 1e-3f);
    f.weight = 0.5f * max(tilts_seen(n, to) - tilts_seen(n, from), 0.0f);
    float middle = window_middle(r);
    float tilt = middle + window_mean(from - middle, to - middle);
    if (from == rim && rim > first) /* light through the window grows ever slower from its rim on */
        tilt -= 0.125f * (to - from);
    float z = r.n - tilt;
    f.m = normal_from_slope(slope_from_normal(N) + r.towards * (z * r.along) +
                            vec2(-r.towards[1], r.towards[0]) * (r.lean * z + r.across * side));
    return f;
}

/* Radiance (cd/m^2) through the window: the sky, and where waves of the slopes C, which N is one of, are in its way, these as they are seen from
 * the air: mirrors of the sky, through which comes `upwards`, the radiance that goes up just below the surface. */
FN vec3 window_light(Water w, WaterWindow window, vec3 C, vec3 N, vec3 sky, vec3 upwards)
{
    float F = water_fresnel(w, water_seen_cosine(window.outside, C));
    vec3 others = mix(upwards * (1.0f / (w.ior * w.ior)), sky, F);
    return mix(others, sky, water_passing(C, N, window.outside)) * window.gain;
}

#endif
