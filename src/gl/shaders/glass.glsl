/* glass.glsl - light through a transmissive surface by rays, as on the CPU (src/cpu/refraction.c): refracted at each
 * boundary, with the volumes that they are in, to an opaque surface or to the environment. An opaque surface has its
 * color in the image, if the eye sees it there too; otherwise it is shaded here, with the means of its textures. */
#if defined(IS_TRACING) && defined(HAS_TRANSMISSION)

const int RAYS_BUDGET = 16;     /* rays per sample */
const int RAYS_WAITING = 4;     /* branches that are followed later */
const int RAYS_ROUGH = 8;       /* samples of a rough surface */
const int RAYS_COLORS = 8;      /* of a dispersive one */
const float RAYS_LEAST = 0.02;  /* share of a branch that is followed */
const float RAYS_BLURRED = 3.0; /* factor on it behind a rough surface: excludes the inner reflection of one boundary */
const float RAYS_SMOOTH = 0.0125; /* GGX width up to which one ray in the middle of the lobe suffices */

/* A ray to be traced: refraction.c. media: materials plus 1 of the volumes that it is in, the last entered first. */
struct Branch
{
    vec3 O;
    vec3 D;
    vec3 weight;
    float alpha2; /* squared GGX width of the lobe around D */
    vec2 cone;    /* of the rays through a pixel: width (m) and opening, signed */
    ivec4 media;
    int depth;
    bool ends; /* it is too weak to be traced */
    bool is_reflected; /* inside of glass; others see the backdrop */
};

/* A point on a triangle. */
struct RayPoint
{
    vec3 P;
    vec3 N;    /* unit, on the side of the ray */
    vec3 Ng;   /* the same, geometric */
    int material, kind;
    bool is_front;
    float bend;     /* change of N per m, positive where the side of the ray is convex */
    vec3 color;     /* base color */
    float opacity, transmission, roughness;
};

/* Unit, geometric, on the side of the eye; main() sets it: derivatives need uniform control flow. */
vec3 rays_normal;

/* Offset of rays from the surface that they leave, m. */
float rays_tolerance(vec3 P)
{
    vec3 a = abs(P);
    return 4e-6 * max(max(a.x, a.y), max(a.z, length(v_position))) + 1e-12;
}

/* ---- media ---- */

ivec4 media_entered(ivec4 media, int material)
{
    return ivec4(material + 1, media.xyz);
}

ivec4 media_left(ivec4 media, int material)
{
    int m = material + 1;
    return media.x == m   ? ivec4(media.yzw, 0)
           : media.y == m ? ivec4(media.x, media.zw, 0)
           : media.z == m ? ivec4(media.xy, media.w, 0)
           : media.w == m ? ivec4(media.xyz, 0)
                          : media;
}

/* shift: -1 red, 0 green, 1 blue. */
float ior_of_medium(int medium, float shift)
{
    if (medium == 0)
        return 1.0;
    int row = rays_row(medium - 1);
    float ior = rays_texel(row + 2).x, dispersion = rays_texel(row + 3).w;
    if (dispersion > 0.0 && ior > 1.0)
        ior = max(ior + (dispersed_ior(ior, dispersion, 2) - ior) * shift, 1.0);
    return ior > 0.0 ? ior : 1.0;
}

/* Transmittance over a length of the medium; adds scattered light to the sum. */
vec3 transmittance_along(Branch b, float distance_m, inout vec3 sum)
{
    if (b.media.x == 0)
        return vec3(1.0);
    int row = rays_row(b.media.x - 1);
    vec4 attenuation = rays_texel(row + 1);
    vec3 T = volume_transmittance(attenuation.xyz, attenuation.w, distance_m);
#ifdef HAS_SCATTER
    vec4 scatter = rays_texel(row + 5);
    sum += b.weight * (1.0 - T) * scatter.xyz *
           scattered_ambient(light_irradiance_over_pi(b.D), light_irradiance_over_pi(-b.D), scatter.w);
#endif
    return T;
}

/* ---- boundaries ---- */

/* The pixel from the image's top left corner, whichever way rows run, so that a window has the noise of a file. */
uvec2 image_pixel()
{
    vec2 at = gl_FragCoord.xy + frame_size.zw;
    return uvec2(at.x, dot(cross(right.xyz, up.xyz), forward.xyz) > 0.0 ? at.y : frame_size.y - at.y);
}

/* Index of the pixel on a curve through squares of 2^k pixels, in a random order at every level: pixels take parts of one
 * sequence so that squares of them are well distributed together, as on the CPU (ray_samples.h). */
uint rays_place()
{
    uvec2 pixel = image_pixel();
    uint place = 1u;
    for (int level = 11; level >= 0; level--) {
        uint quarter = (pixel.x >> level & 1u) | (pixel.y >> level & 1u) << 1;
        place = place << 2 | (quarter ^ hash_uint(place) >> 30);
    }
    return place & 0xffffffu;
}

/* Two numbers in [0, 1) at a surface along the ray. */
vec2 rays_random(uint index, int depth)
{
    return sobol_point(index, uint(depth));
}

vec3 rays_microfacet(vec3 N, vec3 V, float alpha, vec2 u)
{
    mat3 frame = basis_from_normal(N);
    return normalize(frame * sample_VNDF_GGX(u, V * frame, alpha, alpha));
}

/* Leaves P on a side of the surface (1: of the eye, -1: behind). Directions on the wrong side are mirrored. */
void leave_surface(inout Branch b, vec3 P, vec3 Ng, float side, vec3 D)
{
    float c = dot(D, Ng);
    b.D = c * side <= 0.0 ? normalize(D - Ng * (2.0 * c - side * 1e-4)) : D;
    b.O = P + Ng * (side * rays_tolerance(P));
    b.depth++;
}

/* Through a thin wall. */
void pass_wall(inout Branch b, vec3 P, vec3 Ng, vec3 N, vec3 H, float width2)
{
    vec3 D = dot(H, N) < 1.0 ? mirror_through(reflect(b.D, H), N) : b.D;
    leave_surface(b, P, Ng, -1.0, D);
    b.alpha2 = min(b.alpha2 + width2, 1.0);
}

/* Into the medium behind; eta: ior before / ior behind. False: total reflection. */
bool refract_ray(inout Branch b, RayPoint p, vec3 H, float eta, ivec4 behind, float width2)
{
    vec3 D = abs(eta - 1.0) < 1e-6 ? b.D : refract(b.D, H, eta);
    if (dot(D, D) < 0.5)
        D = refract(b.D, p.N, eta);
    if (dot(D, D) < 0.5)
        return false;
    float change = dot(D, p.N) - eta * dot(b.D, p.N); /* D = eta b.D + change N */
    b.cone.y = clamp(eta * b.cone.y + change * p.bend * b.cone.x, -0.5, 0.5);
    float turn = 0.5 * (1.0 - eta);
    b.alpha2 = min(b.alpha2 * eta * eta + turn * turn * width2, 1.0);
    b.media = behind;
    leave_surface(b, p.P, p.Ng, -1.0, normalize(D));
    return true;
}

/* ---- what a ray hits ---- */

/* A texel of a material's sheet (gl_material.h): base color; opacity, transmission, roughness. */
void add_texel(vec4 sheet, ivec2 at, float weight, inout vec3 color, inout vec3 others)
{
    ivec2 size = ivec2(sheet.yz);
    at = at - size * ivec2(floor(vec2(at) / sheet.yz));
    vec4 texel = rays_texel(int(sheet.x) + at.y * size.x + at.x);
    int codes = int(texel.w);
    color += weight * texel.xyz;
    others += weight / 255.0 * vec3(codes & 255, codes >> 8 & 255, codes >> 16);
}

/* Between texels, repeated. */
void read_sheet(int row, vec2 uv, out vec3 color, out vec3 others)
{
    vec4 sheet = rays_texel(row + 7);
    vec2 x = fract(uv) * sheet.yz - 0.5;
    vec2 f = sheet.w > 0.5 ? floor(fract(x) + 0.5) : fract(x);
    ivec2 at = ivec2(floor(x));
    color = vec3(0.0);
    others = vec3(0.0);
    add_texel(sheet, at, (1.0 - f.x) * (1.0 - f.y), color, others);
    add_texel(sheet, at + ivec2(1, 0), f.x * (1.0 - f.y), color, others);
    add_texel(sheet, at + ivec2(0, 1), (1.0 - f.x) * f.y, color, others);
    add_texel(sheet, at + ivec2(1, 1), f.x * f.y, color, others);
}


RayPoint ray_point(Branch b, RayHit hit)
{
    vec4 corner = rays_texel(hit.triangle), edge1 = rays_texel(hit.triangle + 1), edge2 = rays_texel(hit.triangle + 2);
    vec4 n0 = rays_texel(hit.triangle + 3), n1 = rays_texel(hit.triangle + 4), n2 = rays_texel(hit.triangle + 5);
    RayPoint p;
    p.P = corner.xyz + edge1.xyz * hit.weights.x + edge2.xyz * hit.weights.y;
    p.material = int(corner.w);
    p.kind = int(edge2.w);
    vec3 Ng = normalize(cross(edge1.xyz, edge2.xyz));
    p.is_front = dot(Ng, b.D) < 0.0;
    float side = p.is_front ? 1.0 : -1.0;
    p.Ng = Ng * side;
    p.N = normalize(n0.xyz * (1.0 - hit.weights.x - hit.weights.y) + n1.xyz * hit.weights.x + n2.xyz * hit.weights.y) * side;
    if (!(dot(p.N, b.D) < -1e-3))
        p.N = p.Ng;
    vec3 edge3 = edge2.xyz - edge1.xyz;
    p.bend = side / 3.0 * (dot(n1.xyz - n0.xyz, edge1.xyz) / dot(edge1.xyz, edge1.xyz) +
                           dot(n2.xyz - n0.xyz, edge2.xyz) / dot(edge2.xyz, edge2.xyz) +
                           dot(n2.xyz - n1.xyz, edge3) / dot(edge3, edge3));
    vec4 uv01 = rays_texel(hit.triangle + 6);
    vec2 uv = uv01.xy + (uv01.zw - uv01.xy) * hit.weights.x + (rays_texel(hit.triangle + 7).xy - uv01.xy) * hit.weights.y;
    int row = rays_row(p.material);
    vec3 others;
    read_sheet(row, uv, p.color, others);
    vec4 factor = rays_texel(row), factors = rays_texel(row + 2);
    p.color *= factor.xyz * vec3(n0.w, n1.w, n2.w);
    float alpha = others.x * rays_texel(row + 6).z;
    p.opacity = factors.w < 0.0 ? alpha : alpha >= factors.w ? 1.0 : 0.0;
    p.transmission = others.y * factor.w;
    p.roughness = others.z * factors.y;
    return p;
}

Surface ray_surface(RayPoint p)
{
    int row = rays_row(p.material);
    vec4 factors = rays_texel(row + 2), specular = rays_texel(row + 4);
    return surface_from_gltf(p.N, p.color, factors.z, p.roughness, factors.x, specular.w, specular.xyz,
                             rays_texel(row + 6).y, rays_texel(row + 3).xyz);
}

/* The opaque surface at p in the image, w: 0 where the eye does not see it, or at so flat an angle that its pixels are
 * those of its neighbors. */
vec4 opaque_seen(RayPoint p, vec3 D, float blur_m)
{
    vec3 from = p.P - eye.xyz;
    bool is_orthographic = eye.w > 0.5;
    vec3 to_eye = is_orthographic ? -forward.xyz : -normalize(from);
    float depth = dot(from, forward.xyz);
    vec2 at = place_in_image(from);
    vec2 inside = step(abs(at - 0.5), vec2(0.5));
    if (inside.x * inside.y < 0.5 || dot(p.Ng, to_eye) < 0.2 || !(is_orthographic || depth > 0.0))
        return vec4(0.0);
    float far = is_orthographic ? 1e30 : length(from);
    if (trace_ray(p.P + p.Ng * rays_tolerance(p.P), to_eye, far, true).triangle >= 0)
        return vec4(0.0);
    float pixel = length(right.xyz) * (is_orthographic ? 1.0 : depth);
    vec4 c = opaque_at(at, clamp(log2(blur_m / pixel), 0.0, log2(float(textureSize(u_opaque, 0).x))));
    return c.w < 0.05 ? vec4(0.0) : vec4(c.xyz / c.w, 1.0);
}

/* Radiance of a surface towards the ray, without what passes it. That in the image is towards the eye: what the
 * direction changes is corrected where the constants of the material describe it. */
vec3 ray_radiance(RayPoint p, Surface s, Branch b, float t)
{
    vec4 seen = vec4(0.0);
    if (p.kind <= RAYS_MASKED)
        seen = opaque_seen(p, b.D, max(2.0 * sqrt(b.alpha2) * t, abs(b.cone.x)));
    if (p.kind == RAYS_UNLIT)
        return seen.w > 0.5 ? seen.xyz : s.base_color + s.emissive;
    if (seen.w > 0.5 && rays_texel(rays_row(p.material) + 6).w > 0.5)
        return seen.xyz;
    vec3 from = p.P - eye.xyz;
    vec3 to_eye = eye.w > 0.5 ? -forward.xyz : -normalize(from);
    vec3 sum = vec3(0.0);
    for (int i = seen.w > 0.5 ? 0 : 1; i < 2; i++) /* towards the eye, towards the ray */
        sum = plain_radiance(SurfaceHost(from, i == 0 ? to_eye : -b.D, energy), s) - sum;
    return max(seen.xyz + sum, 0.0);
}

/* ---- a ray and its branches ---- */

/* Passes a boundary between two volumes, or one from inside. *other: what is reflected or refracted, whichever is weaker. */
void cross_inside(RayPoint p, vec3 H, float shift, float width2, float transmission, float metallic, vec3 base_color,
                  inout Branch b, out Branch other)
{
    ivec4 behind = p.is_front ? media_entered(b.media, p.material) : media_left(b.media, p.material);
    float eta = ior_of_medium(b.media.x, shift) / ior_of_medium(behind.x, shift);
    float F = abs(eta - 1.0) < 1e-6 ? 0.0 : F_dielectric(clamp(-dot(b.D, H), 0.0, 1.0), 1.0 / eta);
    Branch reflected = b, refracted = b;
    reflected.is_reflected = true;
    reflected.weight *= mix(vec3(F), base_color, metallic);
    refracted.weight *= base_color * ((1.0 - F) * (1.0 - metallic) * transmission);
    reflected.alpha2 = min(b.alpha2 + width2, 1.0);
    reflected.cone.y = clamp(b.cone.y - 2.0 * dot(b.D, p.N) * p.bend * b.cone.x, -0.5, 0.5);
    leave_surface(reflected, p.P, p.Ng, 1.0, reflect(b.D, H));
    if (F >= 1.0 || !refract_ray(refracted, p, H, eta, behind, width2))
        refracted.weight = vec3(0.0);
    bool reflects = max3(reflected.weight) > max3(refracted.weight);
    if (reflects) {
        b = reflected;
        other = refracted;
    } else {
        b = refracted;
        other = reflected;
    }
}

/* Adds what the ray meets at a hit; false: it ends there. *other: a branch, of weight 0 if there is none. */
bool meet(RayHit hit, uint index, int samples, float shift, float share, inout Branch b, out Branch other, inout vec3 sum)
{
    RayPoint p = ray_point(b, hit);
    Surface s = ray_surface(p);
    bool is_inside = p.kind == RAYS_VOLUME && (b.media.x != 0 || !p.is_front);
    other = b;
    other.weight = vec3(0.0);
    vec3 base_color = s.base_color;
    if (p.kind >= RAYS_WALL)
        s.base_color *= mix(1.0 - p.transmission, 1.0, s.metallic);
    if (!is_inside && p.opacity > 0.0)
        sum += b.weight * p.opacity * ray_radiance(p, s, b, hit.t);
    if (p.kind < RAYS_WALL || p.opacity < 1.0) {
        b.weight *= 1.0 - p.opacity;
        b.O = p.P + b.D * (2.0 * rays_tolerance(p.P));
        return p.opacity < 1.0;
    }
    float alpha = p.kind == RAYS_VOLUME ? s.alpha : thin_wall_alpha(s.alpha, rays_texel(rays_row(p.material) + 2).x);
    bool is_sampled = alpha >= RAYS_SMOOTH && samples > 1 && b.depth < 2;
    vec3 H = is_sampled ? rays_microfacet(p.N, -b.D, alpha, rays_random(index, b.depth)) : p.N;
    float width2 = alpha * alpha * (is_sampled ? share : 1.0);
    if (is_inside) {
        cross_inside(p, H, shift, width2, p.transmission, s.metallic, base_color, b, other);
        return true;
    }
    float NdotV = clamp(-dot(p.N, b.D), NDOTV_MIN, 1.0);
    vec2 dfg = table_dfg(NdotV, s.perceptual_roughness);
    float F = max3(s.F0) * dfg.x + s.F90 * dfg.y;
    b.weight *= base_color * ((1.0 - F) * (1.0 - s.metallic) * p.transmission);
    if (p.kind == RAYS_WALL) {
        pass_wall(b, p.P, p.Ng, p.N, H, width2);
    } else {
        ivec4 behind = media_entered(b.media, p.material);
        refract_ray(b, p, H, 1.0 / ior_of_medium(behind.x, shift), behind, width2);
    }
    return true;
}

/* The colors of the boundaries that a ray in these volumes has yet to leave through. */
vec3 exit_tint(ivec4 media)
{
    vec3 tint = vec3(1.0);
    for (; media.x != 0; media = ivec4(media.yzw, 0))
        tint *= rays_texel(rays_row(media.x - 1)).xyz;
    return tint;
}

/* Radiance along a ray. index: for random numbers; least: weight of branches that are traced. */
vec3 follow_ray(Branch b, uint index, int samples, float shift, float share, float least)
{
    vec3 sum = vec3(0.0);
    Branch waiting[RAYS_WAITING];
    int count = 0;
    for (int i = 0; i < RAYS_BUDGET + RAYS_WAITING + 1; i++) {
        RayHit hit = RayHit(-1, 0.0, vec2(0.0));
        if (!b.ends && i < RAYS_BUDGET)
            hit = trace_ray(b.O, b.D, 1e30, false);
        else
            b.weight *= exit_tint(b.media);
        bool goes_on = false;
        /* in a volume without exit, at the material's thickness */
        float t = hit.triangle < 0 && b.media.x != 0 ? rays_texel(rays_row(b.media.x - 1) + 6).x : hit.t;
        b.weight *= transmittance_along(b, t, sum);
        b.cone.x += b.cone.y * t;
        if (hit.triangle < 0) {
            vec3 seen = b.weight * environment_seen(b.D, max(b.alpha2, 0.0625 * b.cone.y * b.cone.y));
            if (backdrop.w == 0.0 || b.is_reflected) {
                sum += seen;
            } else {
                backdrop_share += b.weight * backdrop_channels;
                backdrop_unseen += seen * backdrop_channels;
            }
        } else {
            Branch other;
            goes_on = meet(hit, index, samples, shift, share, b, other, sum);
            float weight = max3(other.weight);
            if (weight > 0.0 && count < RAYS_WAITING) {
                other.ends = weight < least;
                waiting[count++] = other;
            } else {
                b.weight += other.weight;
            }
        }
        if (!goes_on) {
            if (count == 0)
                break;
            b = waiting[--count];
        }
    }
    return sum;
}

/* ---- the first surface ---- */

/* The surface in the middle of the pixel. Where the rasterized triangle covers only samples beside it, its plane is no
 * place on the model, so a short ray along the view looks for the triangle that is. */
RayPoint first_point(Layers m, vec3 V)
{
    vec3 P = v_position + eye.xyz;
    float pixel = length(right.xyz) * (eye.w > 0.5 ? 1.0 : dot(v_position, forward.xyz));
    float reach = 4.0 * pixel + 4.0 * rays_tolerance(P);
    Branch b = Branch(P + V * reach, -V, vec3(1.0), 0.0, vec2(0.0), ivec4(0), 0, false, false);
    RayHit hit = trace_ray(b.O, b.D, 2.0 * reach, false);
    RayPoint p = RayPoint(P, m.base.N, rays_normal, int(volume_factors.z + 0.5), RAYS_WALL, gl_FrontFacing, 0.0, vec3(1.0), 1.0,
                          1.0, 0.0);
    if (hit.triangle < 0 || int(rays_texel(hit.triangle).w) != p.material)
        return p;
    p = ray_point(b, hit);
    p.N = normalize(p.N + m.base.N - smooth_normal(V));
    if (!(dot(p.N, V) > 1e-3))
        p.N = p.Ng;
    return p;
}

/* The ray behind the surface that is shaded. */
Branch first_branch(RayPoint p, vec3 V, vec3 H, float width2, float shift)
{
    float step = length(right.xyz);
    vec2 cone = eye.w > 0.5 ? vec2(step, 0.0) : vec2(step * length(v_position), step);
    Branch b = Branch(vec3(0.0), -V, vec3(1.0), 0.0, cone, ivec4(0), 0, false, false);
#ifdef IS_VOLUME
    ivec4 inside = media_entered(ivec4(0), p.material);
    float ior = ior_of_medium(inside.x, shift);
    float eta = p.is_front ? 1.0 / ior : ior;
    if (!refract_ray(b, p, H, eta, p.is_front ? inside : ivec4(0), width2)) {
        b.media = inside;
        leave_surface(b, p.P, p.Ng, 1.0, reflect(-V, p.N));
    }
#else
    pass_wall(b, p.P, p.Ng, p.N, H, width2);
#endif
    return b;
}

/* Shift of color k, and the unscaled share of it in red, green and blue: refraction.c. */
float color_shift(int k)
{
    return 4.0 * (float(k) + 0.5) / float(RAYS_COLORS) - 2.0;
}

vec3 color_weight(float shift)
{
    return max(1.0 - abs(vec3(shift + 1.0, shift, shift - 1.0)), 0.0);
}

/* Radiance (cd/m^2) that reaches the boundary from behind: LayerLight.transmitted. */
vec3 traced_light(Layers m, vec3 V)
{
    float alpha = layers_transmission_alpha(m);
    bool is_rough = m.base.alpha >= RAYS_SMOOTH;
    int samples = is_rough ? RAYS_ROUGH : 1;
#ifdef HAS_DISPERSION
    samples = max(samples, RAYS_COLORS);
#endif
    float share = is_rough ? min(4.0 / float(samples), 1.0) : 1.0;
    float least = RAYS_LEAST * (is_rough ? RAYS_BLURRED : 1.0);
    RayPoint p = first_point(m, V);
    uint place = rays_place() * uint(samples);
    vec3 sum = vec3(0.0), weights = vec3(0.0);
    for (int i = 0; i < samples; i++) {
        uint index = place + uint(i);
        vec3 H = is_rough ? rays_microfacet(p.N, V, alpha, rays_random(index, 0)) : p.N;
        float shift = 0.0;
        vec3 weight = vec3(1.0);
#ifdef HAS_DISPERSION
        shift = color_shift(i % RAYS_COLORS);
        weight = color_weight(shift);
#endif
        Branch b = first_branch(p, V, H, alpha * alpha * share, shift);
        b.is_reflected = false;
        backdrop_channels = weight;
        sum += weight * follow_ray(b, index, samples, shift, share, least);
        weights += weight;
    }
    backdrop_share /= weights;
    backdrop_unseen /= weights;
    return sum / weights;
}
#endif
