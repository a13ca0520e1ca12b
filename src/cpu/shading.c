/* shading.c - see shading.h. */
#include "cpu/shading.h"

#include "cpu/ogl1_shade.h"
#include "cpu/refraction.h"
#include "cpu/surface_light.h"
#include "cpu/surface_point.h"

void shading_scene_set_options(shading_scene *scene, const facet_render_desc *desc)
{
    scene->camera_spread = ray_spread_of_camera(scene->camera);
    scene->energy = desc->energy;
    scene->quality = desc->quality;
    scene->has_specular_antialiasing = desc->has_specular_antialiasing;
    scene->background_blur = desc->background == FACET_BACKGROUND_ENVIRONMENT ? desc->background_blur : 0.0f;
}

bool shading_is_visible_side(const shading_scene *scene, const visibility_hit *hit, const float direction[3])
{
    const render_geometry *g = &scene->geometries->items[hit->geometry];
    return g->is_double_sided || surface_sees_front(g, hit, load3(direction)) ||
           scene->plans->items[hit->geometry].is_volume;
}

float shading_opacity(const shading_scene *scene, const shading_point *point)
{
    if (scene->ogl1)
        return ogl1_opacity(scene, point);
    const render_geometry *g = &scene->geometries->items[point->hit->geometry];
    if (!g->is_see_through)
        return 1.0f;
    shading_hit h = shading_hit_make(scene, point);
    float base_color[4];
    surface_base_color(scene, &h, &scene->plans->items[point->hit->geometry], base_color);
    return surface_opacity(g->material, base_color[3]);
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
        out->rays = refraction_shade(scene, point, &s, out->radiance);
        return;
    }
    surface_light light = surface_light_at(scene, &s);
    store3(light.radiance, out->radiance);
    out->rays = light.rays;
}
