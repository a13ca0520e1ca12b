/* sea_waves.glsl - waves at a resting position of the water: sums of tiles, read as in waves_query.c. Loops end
 * where nothing is left to read, for all pixels shaded together: software rasterizers execute both branches of an
 * if. */
uniform highp sampler2DArray u_sea_low;  /* DX, ETA, DZ, ETA_X; levels are means of 2 x 2 */
uniform highp sampler2DArray u_sea_high; /* ETA_Z, DXX, DZZ, DXZ */
/* origin of each patch in its tile, samples; 128 x 128 around the eye, one tile after the other */
uniform highp sampler2D u_sea_patches;
/* for the pixels drawn: end of the tiles that may be read with cubic filtering; begin and end of those that may be
 * read linearly */
uniform highp ivec3 u_sea_reading;

struct SeaWaves
{
    vec3 displacement;
    vec2 slope;
    vec3 D; /* derivatives of the displacement: xx, zz, xz */
};

/* How a footprint reads a tile. */
struct SeaLevel
{
    float level; /* with fraction */
    float cubic; /* share of the cubic filter */
    float share; /* 0: the footprint is wider than the tile resolves; 1 */
};

SeaLevel sea_level(int tile, float footprint)
{
    float texels = footprint * sea_axes[tile].z;
    float whole = floor(log2(max(texels, 1.0)));
    float rest = texels * exp2(-whole);
    if (rest >= 2.0) { /* log2() was rounded */
        whole += 1.0;
        rest *= 0.5;
    }
    return SeaLevel(whole + clamp(rest - 1.0, 0.0, 1.0), texels > 1.0 ? 0.0 : clamp(2.0 - 2.0 * texels, 0.0, 1.0),
                    int(whole) + 1 < sea_counts.y ? 1.0 : 0.0);
}

/* The position in samples of a tile, and the patches visible there: weights and corners, sorted; a weight of 0
 * means none. A tile without patches has one. */
struct SeaPatches
{
    vec2 place;
    vec3 weights;
    ivec2 first, second, third;
};

SeaPatches sea_patches(int tile, vec2 rest)
{
    SeaPatches p;
    vec4 axes = sea_axes[tile];
    vec2 turned = vec2(rest.x * axes.x + rest.y * axes.y, rest.y * axes.x - rest.x * axes.y) * axes.z;
    float size = float(sea_counts.z);
    p.place = sea_places[tile].xy + turned;
    p.place -= floor(p.place / size) * size;
    float b = rest.y * sea_lengths[tile].x * 1.15470053837925153;
    vec2 lattice = sea_places[tile].zw + vec2(rest.x * sea_lengths[tile].x - 0.5 * b, b);
    vec2 corner = floor(lattice);
    vec2 inside = lattice - corner;
    ivec2 at = ivec2(corner);
    p.weights = axes.w > 0.0 ? wave_patch_weights(inside) : vec3(1.0, 0.0, 0.0);
    p.first = inside.x + inside.y > 1.0 ? at + 1 : at;
    p.second = at + ivec2(0, 1);
    p.third = at + ivec2(1, 0);
    if (p.weights.y <= 0.0) {
        p.weights = p.weights.xzy;
        p.second = p.third;
    }
    if (p.weights.x <= 0.0) {
        p.weights = vec3(p.weights.yz, 0.0);
        p.first = p.second;
        p.second = p.third;
    }
    return p;
}

/* Where the first patch is read, in samples, [0, 2 size). */
vec2 sea_first(int tile, SeaPatches p)
{
    ivec2 at = (p.first + 64) & 127;
    return p.place + sea_axes[tile].w * texelFetch(u_sea_patches, ivec2(at.x, at.y + int(sea_lengths[tile].y)), 0).xy;
}

/* The others. */
SeaPatches sea_rest(SeaPatches p)
{
    return SeaPatches(p.place, vec3(p.weights.yz, 0.0), p.second, p.third, p.third);
}

vec3 sea_texel_place(int tile, vec2 at)
{
    return vec3((at + 0.5) / float(sea_counts.z), tile);
}

/* Displacement and height, linearly. */
vec3 sea_heave(vec2 rest, float footprint)
{
    vec3 sum = vec3(0.0, sea_eye.w, 0.0);
    int tile = 0;
    do {
        SeaLevel l = sea_level(tile, footprint);
        SeaPatches p = sea_patches(tile, rest);
        vec3 low = vec3(0.0);
        do {
            low += p.weights.x * textureLod(u_sea_low, sea_texel_place(tile, sea_first(tile, p)), l.level).xyz;
            p = sea_rest(p);
        } while (p.weights.x > 0.0);
        low *= tile < u_sea_reading.z ? l.share : 0.0;
        vec2 turn = sea_axes[tile].xy;
        sum += vec3(turn.x * low.x - turn.y * low.z, low.y, turn.y * low.x + turn.x * low.z);
        tile++;
    } while (tile < u_sea_reading.z);
    return sum;
}

void sea_add(int tile, vec4 low, vec4 high, inout SeaWaves w)
{
    float c = sea_axes[tile].x;
    float s = sea_axes[tile].y;
    w.displacement += vec3(c * low.x - s * low.z, low.y, s * low.x + c * low.z);
    w.slope += vec2(c * low.w - s * high.x, s * low.w + c * high.x);
    w.D += vec3(c * c * high.y - 2.0 * c * s * high.w + s * s * high.z, s * s * high.y + 2.0 * c * s * high.w + c * c * high.z,
                c * s * (high.y - high.z) + (c * c - s * s) * high.w);
}

#ifdef HAS_CUBIC
/* Of level 0, with the cubic filter. */
void sea_add_cubic(int tile, vec2 at, float share, inout vec4 low, inout vec4 high)
{
    vec2 whole = floor(at);
    vec3 a = wave_cubic_weights(at.x - whole.x);
    vec3 b = wave_cubic_weights(at.y - whole.y);
    vec4 wx = vec4(a, 1.0 - a.x - a.y - a.z);
    vec4 wz = vec4(b, 1.0 - b.x - b.y - b.z) * share;
    ivec2 first = ivec2(whole) - 1;
    int mask = sea_counts.z - 1;
    ivec4 columns = (first.x + ivec4(0, 1, 2, 3)) & mask;
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++) {
            ivec3 texel = ivec3(columns[i], (first.y + j) & mask, tile);
            float weight = wx[i] * wz[j];
            low += weight * texelFetch(u_sea_low, texel, 0);
            high += weight * texelFetch(u_sea_high, texel, 0);
        }
}

void sea_add_smooth(vec2 rest, float footprint, inout SeaWaves w)
{
    int tile = 0;
    do {
        SeaLevel l = sea_level(tile, footprint);
        SeaPatches p = sea_patches(tile, rest);
        vec4 low = vec4(0.0);
        vec4 high = vec4(0.0);
        do {
            sea_add_cubic(tile, sea_first(tile, p), p.weights.x * l.cubic, low, high);
            p = sea_rest(p);
        } while (p.weights.x > 0.0);
        sea_add(tile, low, high, w);
        tile++;
    } while (tile < u_sea_reading.x);
}
#endif

void sea_add_linear(vec2 rest, float footprint, inout SeaWaves w)
{
    int tile = u_sea_reading.y;
    do {
        int read = min(tile, SEA_TILES - 1);
        SeaLevel l = sea_level(read, footprint);
        float share = tile < u_sea_reading.z ? l.share * (1.0 - l.cubic) : 0.0;
        SeaPatches p = sea_patches(read, rest);
        vec4 low = vec4(0.0);
        vec4 high = vec4(0.0);
        do {
            vec3 place = sea_texel_place(read, sea_first(read, p));
            low += p.weights.x * textureLod(u_sea_low, place, l.level);
            high += p.weights.x * textureLod(u_sea_high, place, l.level);
            p = sea_rest(p);
        } while (p.weights.x > 0.0);
        sea_add(read, low * share, high * share, w);
        tile++;
    } while (tile < u_sea_reading.z);
}

SeaWaves sea_waves(vec2 rest, float footprint)
{
    SeaWaves w = SeaWaves(vec3(0.0, sea_eye.w, 0.0), vec2(0.0), vec3(0.0));
#ifdef HAS_CUBIC
    sea_add_smooth(rest, footprint, w);
#endif
    sea_add_linear(rest, footprint, w);
    return w;
}
