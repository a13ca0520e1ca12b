/* ocean.frag - a sea of the tiles that `facet ocean --maps DIR --json` writes, under the sun and a baked sky;
 * docs/shaders.md. Behind the text of `facet shaders water ibl tonemap`. Numbers are those of that command's JSON.
 *
 * A tile's texture is the picture of its .exr file: the displacement (m) along the tile's x, upwards, along its z.
 * Float, repeating, with mipmaps. The vertex shader moves a grid by the same textures. */
uniform sampler2D tile_0, tile_1, tile_2;
uniform vec3 tile_length, tile_turn;           /* m, rad: sea.tiles */
uniform vec2 wind;                             /* unit, along x and z: of sea.wind_azimuth_deg from +Z towards +X */
uniform vec2 all_variance, resolved_variance;   /* sea.slope_variance, sea.resolved_slope_variance */
uniform float ior;                             /* and the water: sea.ior, .. */
uniform vec3 absorption, scattering, backscattering, reflectance;
uniform vec3 eye;                              /* m */
uniform vec3 to_sun, sun_irradiance;           /* unit; lx across the beam */
uniform vec3 sky_irradiance;                   /* lx on a horizontal plane, without the sun */
uniform samplerCube specular;                  /* facet bake sky.exr -o specular.ktx2 */
uniform float last_level;                      /* levels of specular - 1 */
uniform float exposure;

in vec3 position; /* m, displaced */
in vec2 grid;     /* m: x and z before the displacement */
out vec4 color;

/* Adds the derivatives of a tile's displacement along the world's x and z. Differences are as wide as a texel or half of
 * the pixel's footprint. */
void add_tile(sampler2D tile, float size, float turn, inout vec3 along_x, inout vec3 along_z)
{
    vec2 x = vec2(cos(turn), sin(turn)), z = vec2(-x.y, x.x); /* the tile's axes */
    float texels = float(textureSize(tile, 0).x);
    vec2 uv = vec2(dot(grid, x), dot(grid, z)) / size + 0.5 / texels;
    vec2 wide = max(0.5 * fwidth(uv), 1.0 / texels);
    vec3 d_x = texture(tile, uv + vec2(wide.x, 0.0)).xyz - texture(tile, uv - vec2(wide.x, 0.0)).xyz;
    vec3 d_z = texture(tile, uv + vec2(0.0, wide.y)).xyz - texture(tile, uv - vec2(0.0, wide.y)).xyz;
    d_x /= 2.0 * wide.x * size;
    d_z /= 2.0 * wide.y * size;
    mat3 to_world = mat3(x.x, 0.0, x.y, 0.0, 1.0, 0.0, z.x, 0.0, z.y);
    along_x += to_world * (d_x * x.x + d_z * z.x);
    along_z += to_world * (d_x * x.y + d_z * z.y);
}

/* Slopes of waves that the pixel does not resolve: those shorter than the tiles have, and of the tiles' as many octaves as
 * are shorter than the footprint, each with the same variance. xx, zz, xz. */
vec3 unresolved(float footprint)
{
    float longest = 0.125 * tile_length.x, shortest = 2.0 * tile_length.z / float(textureSize(tile_2, 0).x);
    float share = clamp(log(max(2.0 * footprint, shortest) / shortest) / log(longest / shortest), 0.0, 1.0);
    vec2 v = max(all_variance - resolved_variance * (1.0 - share), vec2(SLOPE_VARIANCE_MIN));
    return vec3(v.y) * vec3(1.0, 1.0, 0.0) + (v.x - v.y) * vec3(wind * wind, wind.x * wind.y);
}

void main()
{
    vec3 along_x = vec3(1.0, 0.0, 0.0), along_z = vec3(0.0, 0.0, 1.0);
    add_tile(tile_0, tile_length.x, tile_turn.x, along_x, along_z);
    add_tile(tile_1, tile_length.y, tile_turn.y, along_x, along_z);
    add_tile(tile_2, tile_length.z, tile_turn.z, along_x, along_z);

    vec3 V = normalize(eye - position);
    WaterPoint p;
    p.N = normalize(cross(along_z, along_x));
    p.N = normalize(p.N + V * max(0.02 - dot(p.N, V), 0.0)); /* waves that are turned away are hidden by others */
    p.covariance = unresolved(length(fwidth(grid)) * 0.7);
    p.foam = 0.0;

    Water w;
    w.ior = ior;
    w.absorption = absorption;
    w.scattering = scattering;
    w.backscattering = backscattering;
    w.reflectance = reflectance;
    w.pure_share = vec3(0.0);
    w.sky_reflectance = F_dielectric_avg(ior);
    w.foam_albedo = 0.0;
    w.normals = WATER_BECKMANN;
    w.masking = WATER_SMITH;
    w.is_schlick = 0;

    WaterLight light;
    light.L = to_sun;
    light.sun_irradiance = sun_irradiance;
    light.sky_irradiance = sky_irradiance;
    light.sun_fresnel = water_fresnel(w, max(to_sun.y, 0.0));
    light.downwelling = water_downwelling(w, light);

    /* `facet ocean` reads a table of mean reflectance here (water_specular()); this is the fit to it */
    WaterSpecular m;
    m.fresnel = water_mean_fresnel_fit(max(dot(p.N, V), 0.0), sigma_towards(p.covariance, p.N, V), ior);
    m.escape = 1.0;
    m.R = reflect(-V, p.N);
    m.R = normalize(vec3(m.R.x, max(m.R.y, 0.0), m.R.z));
    m.perceptual_roughness = roughness_from_slopes(p.covariance);
    m.deviation = 0.0;

    vec3 sky = textureLod(specular, m.R, m.perceptual_roughness * last_level).xyz;
    vec3 below = water_from_deep(w, light.downwelling);
    vec3 radiance = water_radiance(water_parts(w, p, light, m, sky, water_sun(w, p, light, V), below));
    color = vec4(srgb_from_linear(tonemap(TONEMAP_NEUTRAL, radiance * exposure)), 1.0);
}
