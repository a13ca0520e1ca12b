/* water_facets.h - facets of water that may show a given object: the range of visible facets that may
 * reflect a box or refract it through Snell's window, and random samples of them. Small objects, shown by
 * few facets of a rough surface, take as many rays as large ones. And a fixed set of facets that
 * represents all facets visible from below, inside and outside of Snell's window.
 *
 * Facets have Gaussian slopes (water_surface.h). Their coordinates are in standard deviations from the
 * mean: z.x along the azimuth of the eye, z.y across, around the regression on z.x, so that both are
 * independent and normal. */
#ifndef SHADE_WATER_FACETS_H
#define SHADE_WATER_FACETS_H

/* Facets beyond this number of standard deviations are ignored. */
#define FACETS_END 4.0f

/* A rectangle of facet coordinates. */
STRUCT(FacetRange)
{
    vec2 towards; /* unit, horizontal, to the eye */
    float along;  /* standard deviation of slopes along it */
    float lean;   /* slope across for one such deviation */
    float across; /* standard deviation about that */
    float n;      /* deviations of a facet seen edge-on */
    vec2 low, high;
};

/* Range of all visible facets, with the covariance C around the normal N; V: unit, to the eye. */
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

/* Coordinates of the facet of normal m. */
FN vec2 facet_place(FacetRange r, vec3 N, vec3 m)
{
    vec2 d = slope_from_normal(m) - slope_from_normal(N);
    float z = dot(r.towards, d) / r.along;
    return vec2(z, (r.towards[0] * d[1] - r.towards[1] * d[0] - r.lean * z) / r.across);
}

/* The rectangle around coordinates, with a margin for the curved edges of a box; for a wide box the whole
 * range. */
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

/* Whether a box around the direction `middle` is too wide to be bounded by its corners; D: to a corner. */
FN bool is_wide_box(vec3 middle, vec3 D)
{
    return dot(vec2(D[0], D[2]), vec2(middle[0], middle[2])) < 0.5f;
}

/* Normal, not unit, of the facet that refracts light from D, in the air, to an eye in the water looking along
 * d; both unit:
 *   n d - D
 * If no facet refracts so far it is that of the rim, where D is nearest. */
FN vec3 facet_that_refracts(vec3 d, vec3 D, float ior)
{
    float least = 1.0f / ior;
    float c = dot(d, D);
    vec3 beside = D - d * c;
    vec3 rim = d * least + beside * (sqrt(max(1.0f - least * least, 0.0f)) *
                                     inversesqrt(max(dot(beside, beside), 1e-12f)));
    return d * ior - sel(c < least, rim, D);
}

/* Range of the facets that show the corners of a box, in the unit direction D each, to an eye looking along -V:
 * by reflection, H = V + D; or, ior > 0, by refraction to an eye in the water looking along V. middle: unit,
 * to the box. */
FN FacetRange facets_of_corners(FacetRange all, vec3 N, vec3 V, vec3 middle, vec3 low, vec3 high, float ior)
{
    bool is_wide = false;
    vec2 first = vec2(1e9f);
    vec2 last = vec2(-1e9f);
    for (int i = 0; i < 8; ++i) {
        vec3 D = normalize(vec3(sel(i % 2 == 0, low[0], high[0]), sel(i < 4, low[1], high[1]),
                                sel(i / 2 % 2 == 0, low[2], high[2])));
        is_wide = is_wide || is_wide_box(middle, D);
        vec3 m = vec3(0.0f);
        if (ior > 0.0f)
            m = facet_that_refracts(V, D, ior);
        else
            m = V + normalize(vec3(D[0], max(D[1], -0.5f * V[1]), D[2])); /* seen edge-on, the lowest */
        vec2 z = facet_place(all, N, vec3(m[0], max(m[1], 1e-4f), m[2]));
        first = min(first, z);
        last = max(last, z);
    }
    return facets_about(all, first, last, is_wide);
}

/* Range of facets that may reflect a box; low, high: its corners from the point of the surface. Downward
 * reflections meet another wave and go up again: they show the box upside down as well. Conservative for wide
 * boxes. An eye in the water looking along V sees reflections of the box -high to -low. */
FN FacetRange facets_that_reflect(vec3 C, vec3 N, vec3 V, vec3 low, vec3 high)
{
    vec3 middle = normalize(0.5f * (low + high) + vec3(0.0f, 1e-6f, 0.0f));
    vec3 bottom = vec3(low[0], min(low[1], -high[1]), low[2]);
    return facets_of_corners(facets_seen(C, N, V), N, V, middle, bottom, high, 0.0f);
}

/* Range of facets, for an eye in the water looking along d (unit, up), that may show a box through Snell's
 * window; low, high: its corners from the point of the surface, none below it. */
FN FacetRange facets_that_refract(vec3 C, vec3 N, vec3 d, vec3 low, vec3 high, float ior)
{
    vec3 middle = normalize(0.5f * (low + high) + vec3(0.0f, 1e-6f, 0.0f));
    return facets_of_corners(facets_seen(C, N, d), N, d, middle, low, high, ior);
}

/* Fraction of all facets in the rectangle, visible or not; 0: it is empty. */
FN float facets_share(FacetRange r)
{
    vec2 from = vec2(normal_below(r.low[0]), normal_below(r.low[1]));
    vec2 to = vec2(normal_below(r.high[0]), normal_below(r.high[1]));
    return max(to[0] - from[0], 0.0f) * max(to[1] - from[1], 0.0f);
}

/* A facet and its weight: the mean of many weights is the rectangle's fraction of the visible area. */
STRUCT(Facet)
{
    vec3 m; /* unit normal */
    float weight;
};

/* u: uniform in [0, 1)^2. Density phi(z.x) phi(z.y) in the rectangle; that of visible facets
 * (slopes_seen()) is (1 - z.x / n) (1 - exp(-2 n (n - z.x))) phi(z.x) phi(z.y), as in sample_slopes(). */
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

/* What the ray of a facet hits. */
STRUCT(FacetHit)
{
    float opacity;  /* 0: nothing */
    vec3 radiance;  /* cd/m^2, towards the surface, without the water between */
    float distance; /* m */
    float height;   /* of the hit over still water, m */
    float depth;    /* of the ray's start below still water, m */
};

    /* ---- the view from below ---- */

#define WINDOW_CELLS 3
#define WINDOW_FACETS 8
/* Below this deviation one facet represents all: their window has an edge a tenth of a degree wide. */
#define WINDOW_SHARP 1e-3f
/* Fraction of the slope variance within a cell: below 1.4^2 / 12, plus the part not divided by the rim. */
#define WINDOW_BETWEEN 0.12f

/* Tilt towards d, in deviations, from which on facets transmit; 1e9: none does. d unit, up; critical:
 * cosine of the critical angle. c = x along |d_h| is compared with critical sqrt(1 + s_along^2 +
 * s_across^2), side: deviations across. */
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

/* Center of the visible tilts, whose deviation is about one; and the edges of cells. */
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

/* Mean of a normal distribution between two bounds. */
FN float window_mean(float from, float to)
{
    float share = normal_below(to) - normal_below(from);
    float mean = 0.398942280f * (exp(-0.5f * from * from) - exp(-0.5f * to * to)) / max(share, 1e-4f);
    return sel(to - from < 0.1f || share < 1e-4f, 0.5f * (from + to), clamp(mean, from, to));
}

/* Edge 0 to WINDOW_CELLS + 1 of the cells after the rim of Snell's window divided the one that contains it. */
FN float window_part(FacetRange r, float rim, int edge)
{
    float last = sel(edge > 0, window_edge(r, edge - 1), 0.0f);
    float next = sel(edge <= WINDOW_CELLS, window_edge(r, edge), 1e9f);
    return clamp(rim, last, next);
}

/* Whether one facet represents all. */
FN bool is_window_sharp(FacetRange r)
{
    return r.along < WINDOW_SHARP;
}

/* Perceptual roughness of the view through one facet; C: of all slopes. */
FN float window_roughness(FacetRange r, vec3 C)
{
    return roughness_from_slopes(C * sel(is_window_sharp(r), 0.1f, 0.1f * WINDOW_BETWEEN));
}

/* Facet k of WINDOW_FACETS, or the one facet of a sharp window; r: facets_seen(). Their weights sum to 1 within 0.0015. Tilts towards d are in
 * WINDOW_CELLS cells, one of which is divided by the rim of Snell's window: the weight of each part is
 * exactly its visible fraction, so that light changes smoothly with the tilt of a wave. Across, one
 * deviation to either side has the moments of all (Gauss-Hermite). */
FN Facet facet_of_window(FacetRange r, vec3 C, vec3 N, vec3 d, float critical, int k)
{
    Facet f;
    if (is_window_sharp(r)) {
        f.m = water_seen_normal(C, N, d);
        f.weight = 1.0f;
        return f;
    }
    float side = sel(k % 2 == 0, -1.0f, 1.0f);
    float first = window_edge(r, 0);
    float rim = clamp(window_rim(r, N, d, critical, side), first, window_edge(r, WINDOW_CELLS));
    float from = window_part(r, rim, k / 2);
    float to = window_part(r, rim, k / 2 + 1);
    f.m = N;
    f.weight = 0.0f;
    if (from >= to)
        return f;
    float n = max(r.n, 1e-3f);
    f.weight = 0.5f * max(tilts_seen(n, to) - tilts_seen(n, from), 0.0f);
    float middle = window_middle(r);
    float tilt = middle + window_mean(from - middle, to - middle);
    if (from == rim && rim > first) /* transmittance increases ever more slowly from the rim on */
        tilt -= 0.125f * (to - from);
    float z = r.n - tilt;
    f.m = normal_from_slope(slope_from_normal(N) + r.towards * (z * r.along) +
                            vec2(-r.towards[1], r.towards[0]) * (r.lean * z + r.across * side));
    return f;
}

/* Radiance (cd/m^2) through the window: the sky, and where waves of the slopes C, which include N, occlude
 * it, these as seen from the air: reflections of the sky, and `upwards`, the upwelling radiance just below
 * the surface, through them. */
FN vec3 window_light(Water w, WaterWindow window, vec3 C, vec3 N, vec3 sky, vec3 upwards)
{
    float F = water_fresnel(w, water_seen_cosine(window.outside, C));
    vec3 others = mix(upwards * (1.0f / (w.ior * w.ior)), sky, F);
    return mix(others, sky, water_visibility(C, N, window.outside)) * window.gain;
}

#endif
