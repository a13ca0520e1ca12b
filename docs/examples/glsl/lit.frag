/* lit.frag - a glTF material under one lamp and a baked environment; docs/shaders.md. Behind the text of
 * `facet shaders light ibl tonemap`. */
uniform vec3 eye;                   /* m */
uniform vec3 base_color;            /* linear */
uniform float metallic, roughness;  /* [0, 1] */
uniform vec3 lamp_position;         /* m */
uniform vec3 lamp_intensity;        /* cd */
uniform samplerCube specular;       /* facet bake studio.hdr -o specular.ktx2 */
uniform samplerCube irradiance;     /* facet bake studio.hdr --lobe lambert -o irradiance.ktx2: irradiance / pi */
uniform sampler2D dfg_table;        /* facet bake --dfg -o dfg.ktx2 */
uniform float last_level;           /* levels of specular - 1 */
uniform float exposure;

in vec3 position, normal; /* m, of any length */
out vec4 color;

void main()
{
    vec3 V = normalize(eye - position);
    vec3 N = normalize(normal);
    float NdotV = max(dot(N, V), NDOTV_MIN);
    Surface s = surface_from_metallic_roughness(N, base_color, metallic, roughness);

    vec2 dfg = texture(dfg_table, vec2(NdotV, roughness)).xy;
    vec3 reflected = textureLod(specular, reflect(-V, N), roughness * last_level).xyz;
    vec3 radiance = surface_ibl(s, NdotV, dfg, reflected, texture(irradiance, N).xyz, ENERGY_GLTF);
    radiance += shade_punctual(s, position, V, light_point(lamp_position, lamp_intensity, 0.0), ENERGY_GLTF, dfg);

    color = vec4(srgb_from_linear(tonemap(TONEMAP_NEUTRAL, radiance * exposure)), 1.0);
}
