/* rays.glsl - rays against the triangles of the scene: the hierarchy of gl_bvh.h in the texture of gl_rays.c. */
#if defined(IS_TRACING) && defined(HAS_TRANSMISSION)
uniform highp sampler2D u_rays;

/* row_kind of gl_rays.c. */
#define RAYS_UNLIT 1
#define RAYS_MASKED 2
#define RAYS_BLENDED 3
#define RAYS_WALL 4
#define RAYS_VOLUME 5

vec4 rays_texel(int i)
{
    return texelFetch(u_rays, ivec2(i & 2047, i >> 11), 0);
}

/* The nearest triangle: its first texel, -1 for none; distance; weights of its second and third corner. */
struct RayHit
{
    int triangle;
    float t;
    vec2 weights;
};

/* Moeller and Trumbore 1997, "Fast, minimum storage ray/triangle intersection". Edges are widened by rounding errors, so
 * that no ray passes between two triangles. */
void intersect_triangle(int triangle, vec3 O, vec3 D, bool stops_at_opaque, inout RayHit hit)
{
    vec4 corner = rays_texel(triangle), edge1 = rays_texel(triangle + 1), edge2 = rays_texel(triangle + 2);
    vec3 across = cross(D, edge2.xyz);
    float determinant = dot(edge1.xyz, across);
    vec3 from = O - corner.xyz;
    vec3 q = cross(from, edge1.xyz);
    float inverse = 1.0 / determinant;
    vec2 w = vec2(dot(from, across), dot(D, q)) * inverse;
    float t = dot(edge2.xyz, q) * inverse;
    float side = stops_at_opaque ? -determinant : determinant; /* towards the ray, or towards the eye that it runs to */
    bool is_shown = side > 0.0 || (side < 0.0 && edge1.w > 0.5);
    if (is_shown && w.x >= -1e-6 && w.y >= -1e-6 && w.x + w.y <= 1.000001 && t > 0.0 && t < hit.t &&
        !(stops_at_opaque && edge2.w > 1.5))
        hit = RayHit(triangle, t, w);
}

const int RAYS_DEPTH = 31; /* GL_BVH_DEPTH and the root */
const int RAYS_END = 0x7fffffff;

/* Where a ray enters a box, m; 1e30: it does not before the hit. */
float enter_box(vec3 low, vec3 high, vec3 O, vec3 inverse, float far)
{
    vec3 a = (low - O) * inverse, b = (high - O) * inverse;
    vec3 enter = min(a, b), leave = max(a, b);
    float first = max(max(enter.x, enter.y), max(enter.z, 0.0));
    float last = min(min(leave.x, leave.y), min(leave.z, far));
    return first <= last * 1.00001 ? first : 1e30;
}

/* A leaf: its first triangle and how many, 8 first + count; an inner node: minus the pair of its children. */
int node_link(vec4 low, vec4 high)
{
    int count = int(high.w);
    return count > 0 ? 8 * int(low.w) + count : -int(low.w);
}

/* From O (m, in world space) along the unit vector D up to a distance. stops_at_opaque: D is towards the eye, and what
 * matters is what hides O from it: any triangle that does. */
RayHit trace_ray(vec3 O, vec3 D, float far, bool stops_at_opaque)
{
    int triangles = int(rays_texel(0).x);
    vec3 inverse = 1.0 / mix(D, vec3(1e-12), lessThan(abs(D), vec3(1e-12)));
    RayHit hit = RayHit(-1, far, vec2(0.0));
    int links[RAYS_DEPTH];
    float starts[RAYS_DEPTH];
    int waiting = 0, link = 0;
    while (link != RAYS_END) {
        bool is_missed = false;
        while (link <= 0 && !is_missed) { /* to the nearer child, down to a leaf */
            int texel = 1 - 4 * link;
            vec4 low_a = rays_texel(texel), high_a = rays_texel(texel + 1), low_b = rays_texel(texel + 2),
                 high_b = rays_texel(texel + 3);
            float a = enter_box(low_a.xyz, high_a.xyz, O, inverse, hit.t), b = enter_box(low_b.xyz, high_b.xyz, O, inverse, hit.t);
            int link_a = node_link(low_a, high_a), link_b = node_link(low_b, high_b);
            if (max(a, b) < 1e30) {
                links[waiting] = a <= b ? link_b : link_a;
                starts[waiting++] = max(a, b);
            }
            link = a <= b ? link_a : link_b;
            is_missed = min(a, b) >= 1e30;
        }
        if (!is_missed) {
            int texel = triangles + 8 * (link >> 3);
            for (int k = link & 7; k > 0; k--) {
                intersect_triangle(texel, O, D, stops_at_opaque, hit);
                texel += 8;
            }
            if (stops_at_opaque && hit.triangle >= 0)
                break;
        }
        link = RAYS_END;
        while (waiting > 0 && link == RAYS_END) {
            waiting--;
            link = starts[waiting] <= hit.t * 1.00001 ? links[waiting] : RAYS_END;
        }
    }
    return hit;
}

/* First texel of a material's row. */
int rays_row(int material)
{
    return int(rays_texel(0).y) + 8 * material;
}
#endif
