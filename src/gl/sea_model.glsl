/* sea_model.glsl - a model in the sea, looked up in pictures of it (gl_sea_model.h): before the surface, behind it, and mirrored in it. Rays that
 * the surface bends look for it step by step: a place on the ray, what the picture shows in its direction, the place as far away as that. */
#ifdef HAS_MODEL
uniform highp sampler2D u_sea_model; /* premultiplied radiance, as the eye sees it */
uniform highp sampler2D u_sea_model_depth;
uniform highp sampler2D u_sea_mirrored; /* from the eye's mirror image */
uniform highp sampler2D u_sea_mirrored_depth;

struct SeaModel
{
    vec4 color;
    vec3 at; /* from the eye, m */
};

const int SEA_MODEL_STEPS = 32;
const int SEA_FACETS = 16;
const int SEA_FACET_STEPS = 8;
const float SEA_LEAST_FACETS = 1e-3; /* as in water_trace.c, these two */
const float SEA_SMOOTH = 1e-3;

/* d: at depth 1 m. What is but blended has no depth, and counts as nearest. */
SeaModel sea_model_at(ivec2 pixel, vec3 d)
{
    float z = texelFetch(u_sea_model_depth, pixel, 0).x;
    bool is_reversed = sea_model_depth.z > 0.0;
    bool is_far = is_reversed ? z <= 0.0 : z >= 1.0;
    float depth = sea_model_depth.y / ((is_reversed ? z : 2.0 * z - 1.0) - sea_model_depth.x);
    return SeaModel(texelFetch(u_sea_model, pixel, 0), d * (is_far ? 0.0 : depth));
}

/* From clip space to a texture's pixels. */
ivec2 sea_pixel_of(vec4 clip, ivec2 size, bool is_top_down)
{
    vec2 at = clip.xy / max(clip.w, 1e-6);
    return ivec2(floor((vec2(at.x, is_top_down ? -at.y : at.y) * 0.5 + 0.5) * vec2(size)));
}

bool sea_is_within(ivec2 pixel, ivec2 size)
{
    return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size));
}

/* Where a ray passes the ball around the model: first way, and that of one of so many steps; 0: it does not. */
vec2 sea_ball_steps(vec3 P, vec3 R, int count)
{
    vec3 to = sea_model_ball.xyz - P;
    float middle = dot(to, R);
    float reach2 = sea_model_ball.w * sea_model_ball.w + middle * middle - dot(to, to);
    float first = max(middle - sqrt(max(reach2, 0.0)), 0.0);
    return vec2(first, reach2 > 0.0 ? max(middle + sqrt(max(reach2, 0.0)) - first, 0.0) / float(count) : 0.0);
}

/* What the eye's picture shows in the direction of Q; color.w 0: nothing that is below the height y. */
SeaModel sea_model_towards(vec3 Q, float y)
{
    ivec2 size = textureSize(u_sea_model, 0);
    ivec2 at = sea_pixel_of(view_projection * vec4(Q, 1.0), size, sea_model_depth.z > 0.0);
    SeaModel m = sea_model_at(clamp(at, ivec2(0), size - 1), Q / max(dot(Q, forward.xyz), 1e-6));
    if (!sea_is_within(at, size) || m.at.y > y || dot(m.at, m.at) <= 0.0)
        m.color = vec4(0.0);
    return m;
}

/* Along the unit direction `down` from P in the surface, from the eye; color.w 0: nothing. */
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

/* What the mirror image shows in the direction of Q, from its eye; *far: distance of that along Q, m. */
vec4 sea_mirrored_at(vec3 Q, out float far)
{
    ivec2 size = textureSize(u_sea_mirrored, 0);
    bool is_reversed = sea_mirror_axis.w > 0.0;
    ivec2 at = sea_pixel_of(sea_mirror * vec4(Q, 1.0), size, is_reversed);
    ivec2 pixel = clamp(at, ivec2(0), size - 1);
    float z = texelFetch(u_sea_mirrored_depth, pixel, 0).x;
    float nearness = is_reversed ? 1.0 - z : 2.0 * z; /* scale * height / depth */
    vec3 d = normalize(Q);
    float closing = sea_mirror_plane.x * d.y - nearness * dot(d, sea_mirror_axis.xyz);
    far = closing > 0.0 ? sea_mirror_plane.x * sea_mirror_plane.y / closing : 0.0;
    return at == pixel && closing > 0.0 ? texelFetch(u_sea_mirrored, pixel, 0) : vec4(0.0);
}

/* Premultiplied, along the unit direction R, upwards, from P: steps through the ball around the model until the ray is behind what is
 * shown, then to the place itself. */
vec4 sea_model_mirrored(vec3 P, vec3 R, int count)
{
    vec2 steps = sea_ball_steps(P, R, count);
    P.y += 2.0 * sea_mirror_plane.y; /* from the eye's mirror image */
    float far;
    float way = -1.0;
    for (int i = 1; i <= count && steps.y > 0.0; i++) {
        vec3 Q = P + R * (steps.x + steps.y * float(i));
        vec4 color = sea_mirrored_at(Q, far);
        float behind = length(Q) - far;
        if (way < 0.0 && color.w > 0.0 && behind > 0.0 && behind < 1.5 * steps.y)
            way = steps.x + steps.y * float(i);
    }
    bool is_met = way >= 0.0 && R.y > 0.0 && steps.y > 0.0;
    vec4 color = vec4(0.0);
    for (int i = 0; i < 3; i++) {
        vec3 Q = P + R * max(way, 0.0);
        vec4 here = sea_mirrored_at(Q, far);
        if (here.w > 0.0) {
            color = here;
            way = length(Q * (far / length(Q)) - P);
        }
    }
    return is_met ? color : vec4(0.0);
}

/* Of all light that is reflected, whatever it brings, the share of facets that show the model: .w; and its radiance. find_mirrored() of
 * water_trace.c. */
vec4 sea_model_in_facets(vec3 P, vec3 V, WaterPoint point, Water w, uint seed)
{
    vec3 from = sea_model_ball.xyz - P;
    FacetRange r = facets_that_mirror(point.covariance, point.N, V, from - sea_model_half.xyz, from + sea_model_half.xyz);
    if (facets_share(r) < SEA_LEAST_FACETS)
        return vec4(0.0);
    if (max(r.along, r.across) < SEA_SMOOTH)
        return sea_model_mirrored(P, reflect(-V, point.N), SEA_MODEL_STEPS) * water_fresnel(w, clamp(dot(point.N, V), 0.0, 1.0));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < SEA_FACETS; i++) {
        Facet f = facet_drawn(r, point.N, sobol_scrambled(uint(i), seed));
        vec3 R = reflect(-V, f.m);
        R.y = max(abs(R.y), 1e-4);
        float weight = f.weight * water_fresnel(w, clamp(dot(f.m, V), 0.0, 1.0));
        if (weight > 0.0)
            sum += sea_model_mirrored(P, R, SEA_FACET_STEPS) * weight;
    }
    return sum / float(SEA_FACETS);
}

/* Whether a hull keeps the sea out of a place; share of the sun's light there. */
vec2 sea_touched(vec2 at)
{
    vec2 place = (at - sea_touch.xy) * sea_touch.zw;
    bool is_within = all(greaterThanEqual(place, vec2(0.0))) && all(lessThanEqual(place, vec2(1.0)));
    vec2 touch = textureLod(u_sea_touch, place, 0.0).xy;
    return is_within ? touch : vec2(0.0, 1.0);
}

/* Light that comes up through the surface from the model below P: find_below() of water_trace.c. */
vec3 sea_model_through_water(SeaModel m, vec3 P, Water w, WaterLight light)
{
    float way = length(m.at - P);
    float depth = max(P.y - m.at.y, 0.0);
    vec3 lit = m.color.xyz / m.color.w * water_transmittance(water_K_d(w), depth);
    vec3 gone = water_transmittance(water_K_d(w), depth) * water_transmittance(water_diffuse(w), way);
    return lit * water_transmittance(water_beam(w), way) + water_from_deep(w, light.downwelling) * (1.0 - gone);
}
#endif
