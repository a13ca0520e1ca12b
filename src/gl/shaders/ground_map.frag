/* ground_map.frag - how much of a uniform sky the model hides from a point of the ground, in [0, 1]: ambient
 * occlusion of the plane (Zhukov et al. 1998), weighted with the cosine.
 *
 * For each place a map has the lowest and the highest point above it, and the space in between counts as solid.
 * Along a direction in the plane, each step hides the elevations e from its lower end to its upper one. sin(e)^2
 * is uniformly distributed for cosine-weighted light, and its 32 parts are the bits of a word (Therrien et al.
 * 2023, "Screen space indirect lighting with visibility bitmask"): what several steps hide counts once. */
uniform highp sampler2D u_heights; /* lowest, and beside them the highest: 1 - depth */

out vec4 fragment;

const int SLICES = 12; /* directions; those of 4 x 4 neighbours interleave */
const int STEPS = 48;

float part_of_sky(float height, float distance)
{
    return height * height / max(height * height + distance * distance, 1e-30);
}

/* Bits from low to high, of 32. */
uint bits_between(float low, float high)
{
    int a = int(low * 32.0 + 0.5);
    int b = int(high * 32.0 + 0.5);
    uint below_b = b >= 32 ? 0xffffffffu : (1u << uint(b)) - 1u;
    uint below_a = a >= 32 ? 0xffffffffu : (1u << uint(a)) - 1u;
    return below_b & ~below_a;
}

int count_bits(uint x)
{
    x -= (x >> 1) & 0x55555555u;
    x = (x & 0x33333333u) + ((x >> 2) & 0x33333333u);
    x = (x + (x >> 4)) & 0x0f0f0f0fu;
    return int((x * 0x01010101u) >> 24);
}

/* Height above the ground, m, of a depth in [0, 1]. */
float height_of(float depth)
{
    return max(mix(light_ground_height.x, light_ground_height.y, depth), 0.0);
}

/* What a step of a slice hides: the column at a texel of the map, from near to far (texels). */
uint step_bits(ivec2 at, int size, float near, float far, float m_per_texel)
{
    float low = texelFetch(u_heights, at, 0).x;
    if (low >= 1.0)
        return 0u;
    float high = 1.0 - texelFetch(u_heights, at + ivec2(size, 0), 0).x;
    return bits_between(part_of_sky(height_of(low), far * m_per_texel), part_of_sky(height_of(high), near * m_per_texel));
}

void main()
{
    int size = textureSize(u_heights, 0).x / 2;
    float m_per_texel = 2.0 * light_ground.z / float(size);
    ivec2 cell = ivec2(gl_FragCoord.xy) & 3;
    float turn = (float(cell.x * 4 + ((cell.y + cell.x * 2) & 3)) + 0.5) / 16.0;
    float jitter = (float((cell.y * 4 + cell.x) * 7 % 16) + 0.5) / 16.0;
    vec2 place = 2.0 * gl_FragCoord.xy; /* the map has half as many texels */
    int hidden = 0;
    for (int s = 0; s < SLICES; s++) {
        float angle = (float(s) + turn) * (2.0 * PI / float(SLICES));
        vec2 direction = vec2(cos(angle), sin(angle));
        uint bits = 0u;
        float near = 0.0;
        for (int i = 1; i <= STEPS; i++) {
            float far = float(size) * float(i * i) / float(STEPS * STEPS);
            ivec2 at = ivec2(floor(place + direction * mix(near, far, jitter)));
            if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(size))))
                break;
            bits |= step_bits(at, size, near, far, m_per_texel);
            near = far;
        }
        hidden += count_bits(bits);
    }
    fragment = vec4(float(hidden) / float(32 * SLICES));
}
