/* render_check.c - see render_check.h. */
#include "render/render_check.h"

#include <math.h>

#include "base/result.h"
#include "draw/empty_view.h"
#include "film/meter.h"

/* ---- nothing is seen ---- */

static bool explain(const facet_scene *scene, const scene_pose *pose, const facet_render_desc *desc,
                    char *why, size_t size)
{
    facet_camera fitted;
    facet_orbit orbit = scene_orbit_default();
    camera_rays rays;
    if (!desc->camera && scene_fit_pose(scene, pose, &orbit, (float)desc->width / (float)desc->height,
                                        desc->thread_count, &fitted, NULL) != FACET_OK)
        return false;
    return camera_rays_create(desc->camera ? desc->camera : &fitted, desc->width, desc->height, &rays,
                              NULL) == FACET_OK &&
           empty_view_explain(scene, pose, desc, &rays, why, size);
}

/* An environment as background covers the whole image: then only a certain reason counts. */
static void check_nothing(render_check *check, const facet_scene *scene, const scene_pose *pose,
                          const facet_render_desc *desc, const film *drawn)
{
    char why[512] = "";
    scene_pose own = {0};
    bool has_background = desc->background == FACET_BACKGROUND_ENVIRONMENT;
    if (check->has_warned_of_nothing || (!has_background && film_is_covered(drawn)))
        return;
    if (!pose &&
        scene_pose_create(scene, &desc->pose, &desc->allocator, desc->thread_count, &own, NULL) != FACET_OK)
        return;
    bool is_certain = explain(scene, pose ? pose : &own, desc, why, sizeof why);
    scene_pose_destroy(&own);
    if (!*why || (has_background && !is_certain))
        return;
    log_warning(&desc->log, "%s: nothing of the model is seen: %s", scene->source, why);
    check->has_warned_of_nothing = true;
}

/* ---- all is white ---- */

static void check_white(render_check *check, const facet_scene *scene, const facet_render_desc *desc,
                        const film *drawn)
{
    /* White surfaces reach 1.8 in the built-in studio, and so do intended emitters. A visible environment may
     * be brighter. */
    float most = desc->background == FACET_BACKGROUND_ENVIRONMENT ? 8.0f : 2.0f;
    /* Without tone mapping the image may be meant for a file that keeps values above white. */
    if (check->has_warned_of_white || desc->tonemap == FACET_TONEMAP_NONE ||
        desc->shading == FACET_SHADING_OGL1 || !film_is_brighter_than(drawn, most))
        return;
    double stops = (double)desc->exposure_ev - log2(film_meter(drawn) / METER_KEY);
    bool has_lights = scene->light_count && !desc->ignores_scene_lights;
    log_warning(
        &desc->log,
        "%s: most of the visible image is overexposed: --exposure %+.1f shows it, and --exposure auto "
        "meters the light%s",
        scene->source, stops,
        has_lights ? "; the file's lights may be in real units (lx, cd), --lights none leaves them out" : "");
    check->has_warned_of_white = true;
}

void render_check_film(render_check *check, const facet_scene *scene, const scene_pose *pose,
                       const facet_render_desc *desc, const film *drawn)
{
    if (!desc->log.message)
        return;
    check_nothing(check, scene, pose, desc, drawn);
    check_white(check, scene, desc, drawn);
}
