/* sea_model.glsl - a model in the sea, looked up in images of it (gl_sea_model.h): in front of the surface, behind
 * it, and in its microfacets. Refracted rays search for it iteratively: a point on the ray, the depth of the image
 * in its direction, the point at that distance. */
#ifdef HAS_MODEL
uniform highp sampler2D u_sea_model; /* premultiplied radiance, as the eye sees it */
uniform highp sampler2D u_sea_model_depth;
uniform highp sampler2D u_sea_mirrored; /* cuts: gl_sea_block.h */
uniform highp sampler2D u_sea_mirrored_depth;
#ifdef IS_BELOW
uniform highp sampler2D u_sea_window;
uniform highp sampler2D u_sea_window_depth;
#endif

struct SeaModel
{
    vec4 color;
    vec3 at; /* from the eye, m */
};

const int SEA_MODEL_STEPS = 32;
const int SEA_SAMPLES = 16;
const int SEA_SAMPLE_STEPS = 8;
const float SEA_MIN_SHARE = 1e-3; /* both as in water_find.c */
const float SEA_SMOOTH = 1e-3;

/* d: at depth 1 m. Blended surfaces have no depth, and count as nearest. */
SeaModel sea_model_at(ivec2 pixel, vec3 d)
{
    float z = texelFetch(u_sea_model_depth, pixel, 0).x;
    bool is_reversed = sea_model_depth.z > 0.0;
    bool is_far = is_reversed ? z <= 0.0 : z >= 1.0;
    float depth = sea_model_depth.y / ((is_reversed ? z : 2.0 * z - 1.0) - sea_model_depth.x);
    return SeaModel(texelFetch(u_sea_model, pixel, 0), d * (is_far ? 0.0 : depth));
}

/* From clip space to pixels of a texture. */
ivec2 sea_pixel_of(vec4 clip, ivec2 size, bool is_top_down)
{
    vec2 at = clip.xy / max(clip.w, 1e-6);
    return ivec2(floor((vec2(at.x, is_top_down ? -at.y : at.y) * 0.5 + 0.5) * vec2(size)));
}

bool sea_is_within(ivec2 pixel, ivec2 size)
{
    return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size));
}

/* Where a ray passes the bounding sphere of the model: first distance, and length of one of count steps; 0: it
 * misses. */
vec2 sea_ball_steps(vec3 P, vec3 R, int count)
{
    vec3 to = sea_model_ball.xyz - P;
    float middle = dot(to, R);
    float reach2 = sea_model_ball.w * sea_model_ball.w + middle * middle - dot(to, to);
    float first = max(middle - sqrt(max(reach2, 0.0)), 0.0);
    return vec2(first, reach2 > 0.0 ? max(middle + sqrt(max(reach2, 0.0)) - first, 0.0) / float(count) : 0.0);
}

/* What the eye's image shows in the direction of Q; color.w 0: nothing below the height y. */
SeaModel sea_model_towards(vec3 Q, float y)
{
    ivec2 size = textureSize(u_sea_model, 0);
    ivec2 at = sea_pixel_of(view_projection * vec4(Q, 1.0), size, sea_model_depth.z > 0.0);
    SeaModel m = sea_model_at(clamp(at, ivec2(0), size - 1), Q / max(dot(Q, forward.xyz), 1e-6));
    if (!sea_is_within(at, size) || m.at.y > y || dot(m.at, m.at) <= 0.0)
        m.color = vec4(0.0);
    return m;
}

/* Along the unit direction `down` from P in the surface, relative to the eye; color.w 0: nothing. */
SeaModel sea_model_below(vec3 P, vec3 down)
{
    vec2 steps = sea_ball_steps(P, down, SEA_MODEL_STEPS);
    float way = -1.0;
    for (int i = 0; i <= SEA_MODEL_STEPS; i++) {
        vec3 Q = P + down * (steps.x + steps.y * float(i));
        SeaModel m = sea_model_towards(Q, P.y);
        float behind = length(Q) - length(m.at);
        if (way < 0.0 && m.color.w > 0.0 && behind > 0.0 && behind < 1.5 * steps.y)
            way = steps.x + steps.y * float(i);
    }
    SeaModel found = SeaModel(vec4(0.0), vec3(0.0));
    float first = way;
    for (int i = 0; i < 3; i++) {
        SeaModel m = sea_model_towards(P + down * max(way, 0.0), P.y);
        if (first >= 0.0 && m.color.w > 0.0) {
            found = m;
            way = length(m.at - P);
        }
    }
    return found;
}

const int SEA_MIRRORED = 0; /* cuts */
const int SEA_WINDOW = 1;

/* Color and depth of a cut at a place in clip space; color.w 0: nothing. */
vec4 sea_cut_texel(int cut, vec4 clip, out float z)
{
    bool is_top_down = sea_cut_axis[cut].w > 0.0;
    ivec2 size = textureSize(u_sea_mirrored, 0);
#ifdef IS_BELOW
    if (cut == SEA_WINDOW) {
        size = textureSize(u_sea_window, 0);
        ivec2 at = sea_pixel_of(clip, size, is_top_down);
        ivec2 pixel = clamp(at, ivec2(0), size - 1);
        z = texelFetch(u_sea_window_depth, pixel, 0).x;
        return at == pixel ? texelFetch(u_sea_window, pixel, 0) : vec4(0.0);
    }
#endif
    ivec2 at = sea_pixel_of(clip, size, is_top_down);
    ivec2 pixel = clamp(at, ivec2(0), size - 1);
    z = texelFetch(u_sea_mirrored_depth, pixel, 0).x;
    return at == pixel ? texelFetch(u_sea_mirrored, pixel, 0) : vec4(0.0);
}

/* What a cut shows in the direction of Q from its viewpoint; *far: distance of that along Q, m. */
vec4 sea_cut_at(int cut, vec3 Q, out float far)
{
    float z;
    vec4 plane = sea_cut_plane[cut];
    vec4 color = sea_cut_texel(cut, sea_cut[cut] * vec4(Q, 1.0), z);
    float nearness = sea_cut_axis[cut].w > 0.0 ? 1.0 - z : 2.0 * z; /* scale * height / depth */
    vec3 d = normalize(Q);
    float closing = plane.x * d.y - nearness * dot(d, sea_cut_axis[cut].xyz);
    far = closing > 0.0 ? plane.x * plane.y / closing : 0.0;
    return closing > 0.0 ? color : vec4(0.0);
}

/* Premultiplied, along the unit direction R from P: steps through the bounding sphere of the model until the ray
 * is behind the image's depth, then to the exact distance, which is *way (m). Inside the sphere the first steps
 * are short, as floating models begin close to P. */
vec4 sea_model_in_cut(int cut, vec3 P, vec3 R, int count, out float way)
{
    vec2 ball = sea_ball_steps(P, R, 1);
    P.y += sea_cut_plane[cut].z;
    float far;
    float before = ball.x;
    float first = -1.0;
    way = -1.0;
    for (int i = 1; i <= count && ball.y > 0.0; i++) {
        float share = float(i) / float(count);
        float next = ball.x + ball.y * (ball.x > 0.0 ? share : share * share);
        vec3 Q = P + R * next;
        vec4 color = sea_cut_at(cut, Q, far);
        float behind = length(Q) - far;
        if (way < 0.0 && color.w > 0.0 && behind > 0.0 && behind < 1.5 * (next - before)) {
            way = next;
            first = before;
        }
        before = next;
    }
    bool is_met = way >= 0.0 && R.y * sea_cut_plane[cut].x > 0.0;
    vec4 color = vec4(0.0);
    float last = way;
    for (int i = 0; i < 3 && is_met; i++) {
        vec3 Q = P + R * way;
        vec4 here = sea_cut_at(cut, Q, far);
        if (here.w > 0.0) {
            color = here;
            way = clamp(length(Q * (far / length(Q)) - P), first, last);
        }
    }
    return color;
}

/* Of all reflected light, independent of its radiance, the share of microfacets that reflect the model: .w; and
 * its radiance. water_find() of water_find.c. */
vec4 sea_model_reflected(vec3 P, vec3 V, WaterPoint point, Water w, uint seed)
{
    float way;
    vec3 from = sea_model_ball.xyz - P;
    FacetRange r = facets_that_mirror(point.covariance, point.N, V, from - sea_model_half.xyz, from + sea_model_half.xyz);
    if (facets_share(r) < SEA_MIN_SHARE)
        return vec4(0.0);
    if (max(r.along, r.across) < SEA_SMOOTH)
        return sea_model_in_cut(SEA_MIRRORED, P, reflect(-V, point.N), SEA_MODEL_STEPS, way) * water_fresnel(w, clamp(dot(point.N, V), 0.0, 1.0));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < SEA_SAMPLES; i++) {
        Facet f = facet_drawn(r, point.N, sobol_scrambled(uint(i), seed));
        vec3 R = reflect(-V, f.m);
        R.y = max(abs(R.y), 1e-4);
        float weight = f.weight * water_fresnel(w, clamp(dot(f.m, V), 0.0, 1.0));
        if (weight > 0.0)
            sum += sea_model_in_cut(SEA_MIRRORED, P, R, SEA_SAMPLE_STEPS, way) * weight;
    }
    return sum / float(SEA_SAMPLES);
}

#ifdef IS_BELOW
/* water_findings_below of water_shade.h; water: what the microfacets mirror of it. */
struct SeaFound
{
    float covered;
    vec3 mirrored;
    vec3 through;
    vec3 hidden;
};

/* A model's color seen through `way` m of water along d from the point `at`: water_model_behind_water(). */
vec3 sea_model_behind_water(SeaHost host, vec3 color, vec3 at, vec3 d, float way)
{
    Water w = host_water(host);
    vec3 L = color * water_transmittance(water_K_d(w), max(-(at.y + d.y * way), 0.0));
    return water_through(w, sea_downwelling.xyz, sea_beam.xyz, sea_sunward.xyz, L, max(-at.y, 0.0), d, way);
}

/* look_down(), look_through() of water_find.c. */
SeaFound sea_look_down(SeaHost host, SeaFound found, SeaPlace p, Facet f, int count)
{
    float way;
    vec3 R = reflect(p.d, f.m);
    R.y = -max(abs(R.y), 1e-4);
    float weight = f.weight * water_fresnel_inside(host_water(host), clamp(dot(f.m, p.d), 0.0, 1.0));
    if (weight <= 0.0)
        return found;
    vec4 color = sea_model_in_cut(SEA_MIRRORED, p.d * p.t, R, count, way);
    if (color.w > 0.0) {
        found.covered += weight * color.w;
        found.mirrored += sea_model_behind_water(host, color.xyz / color.w, p.at, R, way) * (weight * color.w);
    }
    return found;
}
SeaFound sea_look_through(SeaHost host, SeaFound found, SeaPlace p, Facet f, float roughness, int count)
{
    float way;
    WaterWindow window = water_window(host_water(host), p.d, f.m);
    float weight = f.weight * water_passing(p.resolved, p.point.N, window.outside);
    if (weight <= 0.0 || window.fresnel >= 1.0)
        return found;
    vec4 color = sea_model_in_cut(SEA_WINDOW, p.d * p.t, window.outside, count, way);
    found.through += color.xyz * (weight * window.gain);
    found.hidden += sea_sky_reflected(window.outside, roughness) * (weight * window.gain * color.w);
    return found;
}

/* water_find_below() of water_find.c. */
SeaFound sea_find_below(SeaHost host, SeaPlace p, uint seed)
{
    SeaFound found = SeaFound(0.0, vec3(0.0), vec3(0.0), vec3(0.0));
    vec3 C = p.point.covariance;
    vec3 N = water_faced(p.point.N, p.d);
    vec3 from = sea_model_ball.xyz - p.d * p.t;
    vec3 low = from - sea_model_half.xyz;
    vec3 high = from + sea_model_half.xyz;
    float roughness = window_roughness(facets_seen(C, p.point.N, p.d), C);
    FacetRange mirror = facets_that_mirror(C, N, p.d, -vec3(high.x, min(high.y, 0.0), high.z), -low);
    FacetRange window = facets_that_bend(C, N, p.d, vec3(low.x, max(low.y, 0.0), low.z), high, host_water(host).ior);
    bool is_mirrored = low.y < 0.0 && facets_share(mirror) >= SEA_MIN_SHARE;
    bool is_through = high.y > 0.0 && facets_share(window) >= SEA_MIN_SHARE;
    bool is_smooth = max(mirror.along, mirror.across) < SEA_SMOOTH;
    Facet smoothed = Facet(water_seen_normal(C, p.point.N, p.d), 1.0);
    if (is_smooth && is_mirrored)
        found = sea_look_down(host, found, p, smoothed, SEA_MODEL_STEPS);
    if (is_smooth && is_through)
        found = sea_look_through(host, found, p, smoothed, roughness, SEA_MODEL_STEPS);
    for (int i = 0; i < SEA_SAMPLES && !is_smooth && (is_mirrored || is_through); i++) {
        vec2 u = sobol_scrambled(uint(i), seed);
        Facet f = facet_drawn(mirror, N, u);
        f.weight /= float(SEA_SAMPLES);
        if (is_mirrored)
            found = sea_look_down(host, found, p, f, SEA_SAMPLE_STEPS);
        f = facet_drawn(window, N, u);
        f.weight /= float(SEA_SAMPLES);
        if (is_through)
            found = sea_look_through(host, found, p, f, roughness, SEA_SAMPLE_STEPS);
    }
    return found;
}
#endif

/* Whether a hull displaces the sea at a place; share of the sun's light there. */
vec2 sea_touched(vec2 at)
{
    vec2 place = (at - sea_touch.xy) * sea_touch.zw;
    bool is_within = all(greaterThanEqual(place, vec2(0.0))) && all(lessThanEqual(place, vec2(1.0)));
    vec2 touch = textureLod(u_sea_touch, place, 0.0).xy;
    return is_within ? touch : vec2(0.0, 1.0);
}

/* Light of the model below P refracted up through the surface: find_refracted() of water_find.c. */
vec3 sea_model_through_water(SeaModel m, vec3 P, Water w, WaterLight light)
{
    float way = length(m.at - P);
    float depth = max(P.y - m.at.y, 0.0);
    vec3 lit = m.color.xyz / m.color.w * water_transmittance(water_K_d(w), depth);
    vec3 gone = water_transmittance(water_K_d(w), depth) * water_transmittance(water_diffuse(w), way);
    return lit * water_transmittance(water_beam(w), way) + water_from_deep(w, light.downwelling) * (1.0 - gone);
}
#endif
