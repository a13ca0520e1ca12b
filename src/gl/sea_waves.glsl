/* sea_waves.glsl - waves at a place of the water at rest: sums of tiles, read as waves_query.c reads them. */
uniform highp sampler2DArray u_sea_low;  /* DX, ETA, DZ, ETA_X; levels are means of 2 x 2 */
uniform highp sampler2DArray u_sea_high; /* ETA_Z, DXX, DZZ, DXZ */
uniform highp sampler2D u_sea_patches;   /* where in its tile each patch comes from, samples; 128 x 128 around the eye, a tile behind the other */

struct SeaWaves
{
    vec3 displacement;
    vec2 slope;
    vec3 D; /* derivatives of the displacement: xx, zz, xz */
};

/* How a footprint reads a tile: level with fraction; share of cubics; false: it hides the tile. */
bool sea_level(int tile, float footprint, out float level, out float cubic)
{
    float texels = footprint * sea_axes[tile].z;
    float whole = floor(log2(max(texels, 1.0)));
    float rest = texels * exp2(-whole);
    if (rest >= 2.0) { /* what log2() rounded */
        whole += 1.0;
        rest *= 0.5;
    }
    level = whole + clamp(rest - 1.0, 0.0, 1.0);
    cubic = texels > 1.0 ? 0.0 : clamp(2.0 - 2.0 * texels, 0.0, 1.0);
    return int(whole) + 1 < sea_counts.y;
}

/* The place in samples of a tile, and its patches: weights, and where each comes from. A tile without them has one. */
struct SeaPatches
{
    vec2 place;
    vec3 weights;
    vec2 from[3];
};

vec2 sea_patch(int tile, ivec2 corner)
{
    ivec2 at = (corner + 64) & 127;
    return texelFetch(u_sea_patches, ivec2(at.x, at.y + int(sea_lengths[tile].y)), 0).xy;
}

SeaPatches sea_patches(int tile, vec2 rest)
{
    SeaPatches p;
    vec4 axes = sea_axes[tile];
    vec2 turned = vec2(rest.x * axes.x + rest.y * axes.y, rest.y * axes.x - rest.x * axes.y) * axes.z;
    float size = float(sea_counts.z);
    p.place = sea_places[tile].xy + turned;
    p.place -= floor(p.place / size) * size;
    p.weights = vec3(1.0, 0.0, 0.0);
    p.from[0] = vec2(0.0);
    p.from[1] = vec2(0.0);
    p.from[2] = vec2(0.0);
    if (axes.w > 0.0) {
        float b = rest.y * sea_lengths[tile].x * 1.15470053837925153;
        vec2 lattice = sea_places[tile].zw + vec2(rest.x * sea_lengths[tile].x - 0.5 * b, b);
        vec2 corner = floor(lattice);
        vec2 inside = lattice - corner;
        p.weights = wave_patch_weights(inside);
        ivec2 at = ivec2(corner);
        p.from[0] = sea_patch(tile, inside.x + inside.y > 1.0 ? at + 1 : at);
        p.from[1] = sea_patch(tile, at + ivec2(0, 1));
        p.from[2] = sea_patch(tile, at + ivec2(1, 0));
    }
    return p;
}

/* Displacement and height, linearly. */
vec3 sea_heave(vec2 rest, float footprint)
{
    vec3 sum = vec3(0.0, sea_eye.w, 0.0);
    for (int tile = 0; tile < sea_counts.x; tile++) {
        float level, cubic;
        if (!sea_level(tile, footprint, level, cubic))
            continue;
        SeaPatches p = sea_patches(tile, rest);
        vec3 low = vec3(0.0);
        for (int i = 0; i < 3; i++)
            if (p.weights[i] > 0.0)
                low += p.weights[i] * textureLod(u_sea_low, vec3((p.place + p.from[i] + 0.5) / float(sea_counts.z), tile), level).xyz;
        vec2 turn = sea_axes[tile].xy;
        sum += vec3(turn.x * low.x - turn.y * low.z, low.y, turn.y * low.x + turn.x * low.z);
    }
    return sum;
}

/* Of level 0, by cubics: adds share times what they change. */
void sea_add_cubic(int tile, vec2 at, float share, inout vec4 low, inout vec4 high)
{
    vec2 whole = floor(at);
    vec3 a = wave_cubic_weights(at.x - whole.x);
    vec3 b = wave_cubic_weights(at.y - whole.y);
    vec4 wx = vec4(a, 1.0 - a.x - a.y - a.z);
    vec4 wz = vec4(b, 1.0 - b.x - b.y - b.z);
    ivec2 first = ivec2(whole) - 1;
    int mask = sea_counts.z - 1;
    vec4 smooth_low = vec4(0.0);
    vec4 smooth_high = vec4(0.0);
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++) {
            ivec3 texel = ivec3((first + ivec2(i, j)) & mask, tile);
            float weight = wx[i] * wz[j];
            smooth_low += weight * texelFetch(u_sea_low, texel, 0);
            smooth_high += weight * texelFetch(u_sea_high, texel, 0);
        }
    low += share * (smooth_low - low);
    high += share * (smooth_high - high);
}

SeaWaves sea_waves(vec2 rest, float footprint)
{
    SeaWaves w = SeaWaves(vec3(0.0, sea_eye.w, 0.0), vec2(0.0), vec3(0.0));
    for (int tile = 0; tile < sea_counts.x; tile++) {
        float level, cubic;
        if (!sea_level(tile, footprint, level, cubic))
            continue;
        SeaPatches p = sea_patches(tile, rest);
        vec4 low = vec4(0.0);
        vec4 high = vec4(0.0);
        for (int i = 0; i < 3; i++) {
            if (p.weights[i] <= 0.0)
                continue;
            vec2 at = p.place + p.from[i];
            vec4 patch_low = vec4(0.0);
            vec4 patch_high = vec4(0.0);
            if (cubic < 1.0) {
                vec3 place = vec3((at + 0.5) / float(sea_counts.z), tile);
                patch_low = textureLod(u_sea_low, place, level);
                patch_high = textureLod(u_sea_high, place, level);
            }
            if (cubic > 0.0)
                sea_add_cubic(tile, at, cubic, patch_low, patch_high);
            low += p.weights[i] * patch_low;
            high += p.weights[i] * patch_high;
        }
        float c = sea_axes[tile].x;
        float s = sea_axes[tile].y;
        w.displacement += vec3(c * low.x - s * low.z, low.y, s * low.x + c * low.z);
        w.slope += vec2(c * low.w - s * high.x, s * low.w + c * high.x);
        w.D += vec3(c * c * high.y - 2.0 * c * s * high.w + s * s * high.z, s * s * high.y + 2.0 * c * s * high.w + c * c * high.z,
                    c * s * (high.y - high.z) + (c * c - s * s) * high.w);
    }
    return w;
}
