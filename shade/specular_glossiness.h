/* specular_glossiness.h - the archived extension KHR_materials_pbrSpecularGlossiness. */
#ifndef SHADE_SPECULAR_GLOSSINESS_H
#define SHADE_SPECULAR_GLOSSINESS_H

/* A surface from its parameters, textures and vertex color included. The conversion is lossless: ior 0
 * makes F0 the specular color, the base under it is weighted with 1 - max3(F), roughness is 1 -
 * glossiness. Colors linear, [0, 1]. */
FN Surface surface_from_specular_glossiness(vec3 N, vec3 diffuse, vec3 specular, float glossiness,
                                            float occlusion, vec3 emissive)
{
    return surface_from_gltf(N, diffuse, 0.0f, 1.0f - glossiness, 0.0f, 1.0f, specular, occlusion, emissive);
}

#endif
