/* water_model_none.c - see water_model.h: a build without Embree has seas without models. */
#include "water/water_model.h"

#include "base/result.h"

facet_result water_model_create(const facet_scene *scene, const facet_render_desc *desc, const water_sky *sky,
                                facet_environment *around, facet_render_stats *stats, water_model *m,
                                facet_error *error)
{
    (void)scene, (void)desc, (void)sky, (void)around, (void)stats, (void)m;
    return fail(error, FACET_ERROR_UNSUPPORTED,
                "sea: this facet was built without Embree, which models in a "
                "sea need");
}

void water_model_destroy(water_model *m)
{
    (void)m;
}

bool water_model_find(const water_model *m, const double P[3], vec3 d, double far_m, uint32_t random,
                      model_hit *hit)
{
    (void)m, (void)P, (void)d, (void)far_m, (void)random, (void)hit;
    return false;
}

bool water_model_find_seen(const water_model *m, float x, float y, float footprint, double far_m,
                           uint32_t random, model_hit *hit)
{
    (void)m, (void)x, (void)y, (void)footprint, (void)far_m, (void)random, (void)hit;
    return false;
}

bool water_model_describe(const water_model *m, float x, float y, double far_m, shading_description *out,
                          float *depth_m, uint32_t *geometry)
{
    (void)m, (void)x, (void)y, (void)far_m, (void)out, (void)depth_m, (void)geometry;
    return false;
}

vec3 water_model_radiance(const water_model *m, const model_hit *hit, vec3 sun)
{
    (void)m, (void)hit, (void)sun;
    return vec3(0.0f);
}

const struct scene_identity *water_model_identity(const water_model *m, uint32_t geometry)
{
    (void)m, (void)geometry;
    return NULL;
}

float water_model_visibility(const water_model *m, const double P[3], vec3 d, double far_m)
{
    (void)m, (void)P, (void)d, (void)far_m;
    return 1.0f;
}

bool water_model_is_dry(const water_model *m, const double P[3])
{
    (void)m, (void)P;
    return false;
}
