/* shading.c - see shading.h. */
#include "cpu/shading.h"

#include "cpu/ambient_occlusion.h"
#include "cpu/ogl1_shade.h"
#include "cpu/refraction.h"
#include "cpu/surface_light.h"
#include "cpu/surface_point.h"

float shading_show_backdrop(const shading_scene *scene, const float transmittance[3], const float unseen[3],
                            float radiance[3])
{
    vec3 T = load3(transmittance);
    vec3 color = load3(scene->backdrop_color);
    vec3 colored = backdrop_radiance(T, load3(unseen), color, scene->backdrop == SHADING_BACKDROP_COLOR);
    store3(load3(radiance) + colored, radiance);
    return backdrop_passes(T);
}

void shading_describe(const shading_scene *scene, const shading_point *point, shading_description *out)
{
    if (scene->ogl1) {
        ogl1_describe(scene, point, out);
        return;
    }
    surface_point s;
    surface_point_make(scene, point, &s);
    store3(s.m.base.N, out->normal);
    store3(load3(s.base_color), out->base_color);
    out->occlusion = s.is_lit ? s.m.base.occlusion : 1.0f;
    shading_texcoord uv = shading_hit_texcoord(&s.hit, 0);
    out->uv[0] = uv.uv[0];
    out->uv[1] = uv.uv[1];
}

void shading_shade(const shading_scene *scene, const shading_point *point, shading_result *out)
{
    if (scene->ogl1) {
        ogl1_shade(scene, point, out);
        return;
    }
    surface_point s;
    surface_point_make(scene, point, &s);
    out->opacity = surface_opacity(s.hit.geometry->material, s.base_color[3]);
    if (s.m.layers & LAYER_TRANSMISSION) {
        refraction_shade(scene, point, &s, out);
        return;
    }
    out->behind = 0.0f;
    uint64_t rays = 0;
    if (point->ambient)
        s.ambient = ambient_factor(point->ambient, point, &s, &rays);
    surface_light light = surface_light_at(scene, &s);
    store3(light.radiance, out->radiance);
    out->rays = light.rays + rays;
}
