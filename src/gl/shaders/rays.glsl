/* rays.glsl - rays against the triangles of the scene: the hierarchy of gl_bvh.h in the texture of gl_rays.c. */
#if defined(IS_TRACED) && defined(HAS_TRANSMISSION)
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

/* From O (m, in world space) along the unit vector D up to a distance. stops_at_opaque: D is towards the eye, and what
 * matters is what hides O from it. */
RayHit trace_ray(vec3 O, vec3 D, float far, bool stops_at_opaque)
{
    vec4 head = rays_texel(0);
    int end = int(head.x), triangles = int(head.y);
    vec3 inverse = 1.0 / mix(D, vec3(1e-12), lessThan(abs(D), vec3(1e-12)));
    RayHit hit = RayHit(-1, far, vec2(0.0));
    int node = 0;
    while (node < end) {
        vec4 low = rays_texel(1 + 2 * node), high = rays_texel(2 + 2 * node);
        vec3 a = (low.xyz - O) * inverse, b = (high.xyz - O) * inverse;
        vec3 enter = min(a, b), leave = max(a, b);
        float first = max(max(enter.x, enter.y), max(enter.z, 0.0));
        float last = min(min(leave.x, leave.y), min(leave.z, hit.t));
        bool is_passed = first <= last * 1.00001;
        node = is_passed && high.w < 0.0 ? node + 1 : int(low.w);
        if (is_passed && high.w >= 0.0) {
            int leaf = int(high.w), texel = triangles + 8 * (leaf >> 3);
            for (int k = leaf & 7; k > 0; k--) {
                intersect_triangle(texel, O, D, stops_at_opaque, hit);
                texel += 8;
            }
        }
    }
    return hit;
}

/* First texel of a material's row. */
int rays_row(int material)
{
    return int(rays_texel(0).z) + 8 * material;
}
#endif
