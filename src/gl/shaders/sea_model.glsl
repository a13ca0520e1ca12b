/* sea_model.glsl - a model in the sea, looked up in images of it (gl_sea_model.h): in front of the surface, behind
 * it, and in its microfacets. Refracted rays search for it iteratively: a point on the ray, the depth of the image
 * in its direction, the point at that distance. */
const int SEA_SAMPLES = 16; /* of microfacets per pixel */

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
const int SEA_SAMPLE_STEPS = 8;

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

/* Where a ray passes a bounding sphere: first distance, and length of one of count steps; 0: it misses. */
vec2 sea_ball_steps(vec4 ball, vec3 P, vec3 R, int count)
{
    vec3 to = ball.xyz - P;
    float middle = dot(to, R);
    float reach2 = ball.w * ball.w + middle * middle - dot(to, to);
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

/* A part, along the unit direction `down` from P in the surface, relative to the eye; color.w 0: nothing. */
SeaModel sea_part_below(vec4 ball, vec3 P, vec3 down)
{
    vec2 steps = sea_ball_steps(ball, P, down, SEA_MODEL_STEPS);
    float distance = -1.0;
    for (int i = 0; i <= SEA_MODEL_STEPS; i++) {
        vec3 Q = P + down * (steps.x + steps.y * float(i));
        SeaModel m = sea_model_towards(Q, P.y);
        float behind = length(Q) - length(m.at);
        if (distance < 0.0 && m.color.w > 0.0 && behind > 0.0 && behind < 1.5 * steps.y)
            distance = steps.x + steps.y * float(i);
    }
    SeaModel found = SeaModel(vec4(0.0), vec3(0.0));
    float first = distance;
    for (int i = 0; i < 3; i++) {
        SeaModel m = sea_model_towards(P + down * max(distance, 0.0), P.y);
        if (first >= 0.0 && m.color.w > 0.0) {
            found = m;
            distance = length(m.at - P);
        }
    }
    return found;
}

/* The nearest part. */
SeaModel sea_model_below(vec3 P, vec3 down)
{
    SeaModel found = sea_part_below(sea_model_balls[0], P, down);
    for (int i = 1; i < int(sea_model_middle.w); i++) {
        SeaModel m = sea_part_below(sea_model_balls[i], P, down);
        if (m.color.w > 0.0 && (found.color.w <= 0.0 || length(m.at - P) < length(found.at - P)))
            found = m;
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

/* Premultiplied, of a part along the unit direction R from P: steps through its bounding sphere until the ray
 * is behind the image's depth, then to the exact distance, which is *distance (m). Inside the sphere the first steps
 * are short, as floating models begin close to P. */
vec4 sea_part_in_cut(vec4 sphere, int cut, vec3 P, vec3 R, int count, out float distance)
{
    vec2 ball = sea_ball_steps(sphere, P, R, 1);
    P.y += sea_cut_plane[cut].z;
    float far;
    float before = ball.x;
    float first = -1.0;
    distance = -1.0;
    for (int i = 1; i <= count && ball.y > 0.0; i++) {
        float share = float(i) / float(count);
        float next = ball.x + ball.y * (ball.x > 0.0 ? share : share * share);
        vec3 Q = P + R * next;
        vec4 color = sea_cut_at(cut, Q, far);
        float behind = length(Q) - far;
        if (distance < 0.0 && color.w > 0.0 && behind > 0.0 && behind < 1.5 * (next - before)) {
            distance = next;
            first = before;
        }
        before = next;
    }
    bool is_met = distance >= 0.0 && R.y * sea_cut_plane[cut].x > 0.0;
    vec4 color = vec4(0.0);
    float last = distance;
    for (int i = 0; i < 3 && is_met; i++) {
        vec3 Q = P + R * distance;
        vec4 here = sea_cut_at(cut, Q, far);
        if (here.w > 0.0) {
            color = here;
            distance = clamp(length(Q * (far / length(Q)) - P), first, last);
        }
    }
    return color;
}

/* Of the nearest part. */
vec4 sea_model_in_cut(int cut, vec3 P, vec3 R, int count, out float distance)
{
    vec4 color = sea_part_in_cut(sea_model_balls[0], cut, P, R, count, distance);
    for (int i = 1; i < int(sea_model_middle.w); i++) {
        float next;
        vec4 c = sea_part_in_cut(sea_model_balls[i], cut, P, R, count, next);
        if (c.w > 0.0 && (color.w <= 0.0 || next < distance)) {
            color = c;
            distance = next;
        }
    }
    return color;
}

/* Along R from a place: the cuts, or, refracted into the water, the eye's image. */
FacetHit host_model_hit(SeaHost host, SeaPlace p, vec3 R, bool is_transmitted, bool is_alone)
{
    vec3 P = p.d * p.t;
    FacetHit hit = FacetHit(0.0, vec3(0.0), 0.0, 0.0, max(-p.at.y, 0.0));
    vec4 color;
#ifndef IS_BELOW
    if (is_transmitted) {
        SeaModel m = sea_model_below(P, R);
        color = m.color;
        hit.distance = length(m.at - P);
        hit.height = p.at.y + (m.at.y - P.y);
    }
    else
#endif
    {
        int count = is_alone ? SEA_MODEL_STEPS : SEA_SAMPLE_STEPS;
        color = sea_model_in_cut(is_transmitted ? SEA_WINDOW : SEA_MIRRORED, P, R, count, hit.distance);
        hit.height = p.at.y + R.y * hit.distance;
    }
    hit.opacity = color.w;
    hit.radiance = color.w > 0.0 ? color.xyz / color.w : vec3(0.0);
    return hit;
}

/* Whether a hull displaces the sea at a place; share of the sun's light there. */
vec2 sea_contact_at(vec2 at)
{
    vec2 place = (at - sea_contact.xy) * sea_contact.zw;
    bool is_within = all(greaterThanEqual(place, vec2(0.0))) && all(lessThanEqual(place, vec2(1.0)));
    vec2 contact = textureLod(u_sea_contact, place, 0.0).xy;
    return is_within ? contact : vec2(0.0, 1.0);
}


float host_sun_visibility(SeaHost host, SeaPlace p)
{
    return sea_contact_at(p.at.xz).y;
}

vec3 host_model_low(SeaHost host, SeaPlace p)
{
    return sea_model_middle.xyz - p.d * p.t - sea_model_half.xyz;
}

vec3 host_model_high(SeaHost host, SeaPlace p)
{
    return sea_model_middle.xyz - p.d * p.t + sea_model_half.xyz;
}

bool host_has_model(SeaHost host)
{
    return true;
}
#else
FacetHit host_model_hit(SeaHost host, SeaPlace p, vec3 R, bool is_transmitted, bool is_alone)
{
    return FacetHit(0.0, vec3(0.0), 0.0, 0.0, 0.0);
}

float host_sun_visibility(SeaHost host, SeaPlace p)
{
    return 1.0;
}

vec3 host_model_low(SeaHost host, SeaPlace p)
{
    return vec3(0.0);
}

vec3 host_model_high(SeaHost host, SeaPlace p)
{
    return vec3(0.0);
}

bool host_has_model(SeaHost host)
{
    return false;
}
#endif

int host_facet_count(SeaHost host)
{
    return SEA_SAMPLES;
}

uint host_random(SeaHost host)
{
    return host.random;
}
