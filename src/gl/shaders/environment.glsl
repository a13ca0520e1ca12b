/* environment.glsl - lookups of the environment and of the tables, as light_setup.h and ibl.h have them. Radiance
 * in cd/m^2 per channel, without exposure; directions are unit vectors in world space. 0 where there is no
 * environment, or where it was not prepared because no material reads it. */
uniform highp sampler2D u_tables; /* x, y: DFG; z: sheen's albedo */
uniform highp sampler3D u_glass;

/* ---- cube maps (cube.h) ---- */

/* The direction d: column and row of the face (axis, sign), then s and t on it. */
vec4 cube_locate(vec3 d)
{
    vec3 a = abs(d);
    bool is_x = a.x >= a.y && a.x >= a.z;
    bool is_y = !is_x && a.y >= a.z;
    float along = is_x ? d.x : is_y ? d.y : d.z;
    float side = along < 0.0 ? -1.0 : 1.0;
    vec2 at = vec2(is_y ? d.x : side * (is_x ? -d.z : d.x), is_y ? side * d.z : -d.y);
    return vec4(is_x ? 0.0 : is_y ? 1.0 : 2.0, along < 0.0 ? 1.0 : 0.0, at / abs(along));
}

#ifdef HAS_ENVIRONMENT
/* cube maps and equirectangular images, each with a border of one texel */
uniform highp sampler2D u_environment;
uniform highp sampler2D u_sharp;       /* the image behind the model */

/* World to environment. */
vec3 to_environment(vec3 d)
{
    return vec3(d.x * frame_light.y - d.z * frame_light.z, d.y, d.x * frame_light.z + d.z * frame_light.y);
}

/* place: column and row of the first texel, size of a face in texels, scale. */
vec3 cube_fetch(vec4 place, vec4 at)
{
    vec2 texel = place.xy + at.xy * (place.z + 2.0) + (at.zw * (0.5 * place.z) + (0.5 * place.z + 1.0));
    return textureLod(u_environment, texel * light_atlas.xy, 0.0).xyz * place.w;
}

/* The level of a lobe, with fraction, between the first and last prepared ones. Indices are constants, because software
 * rasterizers compute addresses that are not for each pixel. */
#define LIGHT_PASSED(i) clamp((roughness - light_steps[i]) * light_slopes[i], 0.0, 1.0)
float light_lod_ggx(float roughness)
{
    vec4 passed = LIGHT_PASSED(0) + LIGHT_PASSED(1) + LIGHT_PASSED(2) + LIGHT_PASSED(3);
    return float(light_ranges.x) + dot(passed, vec4(1.0));
}

float light_lod_sheen(float roughness)
{
    vec4 passed = LIGHT_PASSED(4) + LIGHT_PASSED(5) + LIGHT_PASSED(6) + LIGHT_PASSED(7);
    return float(light_ranges.z) + dot(passed, vec4(1.0));
}

/* Interpolated between two levels, of which level 1 is the first. */
vec3 light_levels(int lobe, float lod, vec4 at)
{
    int last = lobe == 0 ? light_ranges.y : light_ranges.w;
    int level = max(min(int(lod), last), 1);
    vec3 near = cube_fetch(light_places[LIGHT_LEVELS * lobe + level], at);
    vec3 far = cube_fetch(light_places[LIGHT_LEVELS * lobe + min(level + 1, last)], at);
    return near + (far - near) * (lod - float(level));
}

/* ---- equirectangular images (equirect.h) ---- */

/* Turns from the middle column, half turns from the top. At the poles the azimuth is undefined: they are in the
 * middle column. */
vec2 equirect_locate(vec3 d)
{
    float across = length(d.xz);
    return vec2(atan(d.z, across > 0.0 ? d.x : 1.0) * (0.5 * INV_PI), atan(across, d.y) * INV_PI);
}

/* place: column and row of the first texel, width and height. */
vec3 equirect_fetch(vec4 place, vec2 at)
{
    vec2 texel = at * place.zw + vec2(0.5 * place.z, 0.0);
    texel.y = clamp(texel.y, 0.5, place.w - 0.5);
    return textureLod(u_environment, (place.xy + texel + 1.0) * light_atlas.xy, 0.0).xyz;
}

/* if (condition), as a loop of one turn: software rasterizers compute both sides of every if, but leave loops that no
 * pixel enters. */
#define ONLY_IF(condition) for (bool is_wanted = (condition); is_wanted; is_wanted = false)

/* From a mirror (0) up to level 1 of GGX (1): narrow.h. */
vec3 light_narrow(float lod, vec3 d)
{
    float place = lod * float(LIGHT_STEPS - 1);
    int i = min(int(place), LIGHT_STEPS - 2);
    float fraction = place - float(i);
    vec4 weights = mix(light_narrow_weights[i], light_narrow_weights[i + 1], fraction);
    vec2 at = equirect_locate(d);
    vec3 c = cube_fetch(light_places[1], cube_locate(d)) * mix(light_narrow_lobe[i].x, light_narrow_lobe[i + 1].x, fraction);
    for (int k = 0; k < LIGHT_IMAGES; k++)
        ONLY_IF(weights[k] > 0.0)
            c += equirect_fetch(light_images[k], at) * weights[k];
    return c;
}

/* ---- lookups for surfaces ---- */

/* Around R, filtered with the lobe of GGX. */
vec3 light_specular(vec3 R, float perceptual_roughness)
{
    vec3 d = to_environment(R);
    float lod = light_lod_ggx(perceptual_roughness);
    vec3 c = light_levels(0, lod, cube_locate(d));
    ONLY_IF(lod < 1.0)
        c = light_narrow(lod, d);
    return frame_light.x * c;
}

/* Around N, filtered with the mean of sheen's lobe over views. */
vec3 light_sheen(vec3 N, float sheen_roughness)
{
    return frame_light.x * light_levels(1, light_lod_sheen(sheen_roughness), cube_locate(to_environment(N)));
}

/* Reflected radiance of a white Lambertian surface. */
vec3 light_irradiance_over_pi(vec3 N)
{
    return frame_light.x * cube_fetch(light_irradiance, cube_locate(to_environment(N)));
}

/* From direction d. */
vec3 light_background(vec3 d)
{
    vec2 at = equirect_locate(to_environment(d));
    return textureLod(u_sharp, vec2(at.x + 0.5, at.y), 0.0).xyz * (light_atlas.z * frame_light.x);
}
#else
vec3 light_specular(vec3 R, float perceptual_roughness)
{
    return vec3(0.0);
}

vec3 light_sheen(vec3 N, float sheen_roughness)
{
    return vec3(0.0);
}

vec3 light_irradiance_over_pi(vec3 N)
{
    return vec3(0.0);
}

vec3 light_background(vec3 d)
{
    return vec3(0.0);
}
#endif

/* ---- tables (dfg.h) ---- */

/* Texture coordinate of x in [0, 1] in a table of size nodes. */
float table_place(float x, float size)
{
    return (clamp(x, 0.0, 1.0) * (size - 1.0) + 0.5) / size;
}

vec3 table_albedo(float NdotV, float roughness)
{
    float size = float(textureSize(u_tables, 0).x);
    return textureLod(u_tables, vec2(table_place(sqrt(max(NdotV, 0.0)), size), table_place(roughness, size)), 0.0).xyz;
}

/* Split-sum terms of F0 and F90. */
vec2 table_dfg(float NdotV, float perceptual_roughness)
{
    return table_albedo(NdotV, perceptual_roughness).xy;
}

/* Directional albedo of sheen of color 1. */
float table_sheen_albedo(float NdotV, float sheen_roughness)
{
    return table_albedo(NdotV, sheen_roughness).z;
}

/* integrate_glass() of shade/glass.h. The layers for light from inside follow the others. */
vec3 table_glass(float NdotV, float perceptual_roughness, float eta)
{
    vec3 size = vec3(textureSize(u_glass, 0));
    float half_size = 0.5 * size.z;
    float root = abs(eta - 1.0) / (eta + 1.0);
    float layer = clamp(sqrt(root / light_atlas.w), 0.0, 1.0) * (half_size - 1.0) + (eta < 1.0 ? half_size : 0.0);
    return textureLod(u_glass, vec3(table_place(sqrt(max(NdotV, 0.0)), size.x), table_place(perceptual_roughness, size.y), (layer + 0.5) / size.z), 0.0).xyz;
}
