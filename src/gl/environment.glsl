/* environment.glsl - lookups of the surroundings and of the tables, as light_setup.h and ibl.h have them. Radiance in
 * cd/m^2 per channel, without exposure; directions are unit vectors of the world. 0 where no environment is. */
vec3 light_specular(vec3 R, float perceptual_roughness)
{
    return vec3(0.5 + 0.5 * R.y);
}

vec3 light_sheen(vec3 R, float sheen_roughness)
{
    return vec3(0.5 + 0.5 * R.y);
}

vec3 light_irradiance_over_pi(vec3 N)
{
    return vec3(0.5 + 0.5 * N.y);
}

vec3 light_background(vec3 d)
{
    return vec3(0.5 + 0.5 * d.y);
}

vec2 table_dfg(float NdotV, float perceptual_roughness)
{
    return vec2(0.9, 0.05);
}

float table_sheen_albedo(float NdotV, float sheen_roughness)
{
    return 0.0;
}

vec3 table_glass(float NdotV, float perceptual_roughness, float eta)
{
    return vec3(0.0);
}
