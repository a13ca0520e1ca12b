/* scene_light.c - environments that a model brings along: EXT_lights_image_based. */
#include "base/result.h"
#include "scene/scene.h"

static const scene_image_light *find_light(const facet_scene *scene, const facet_pose_desc *pose)
{
    uint32_t index = scene->default_scene == SCENE_NONE ? 0 : scene->default_scene;
    if (pose && pose->has_scene_index)
        index = pose->scene_index;
    if (index >= scene->scene_count || scene->scenes[index].image_light >= scene->image_light_count)
        return NULL;
    return &scene->image_lights[scene->scenes[index].image_light];
}

bool facet_scene_has_environment(const facet_scene *scene, const facet_pose_desc *pose)
{
    return find_light(scene, pose) != NULL;
}

facet_result facet_environment_create_from_scene(const facet_scene *scene, const facet_pose_desc *pose,
                                                 const facet_environment_desc *desc,
                                                 facet_environment **environment, facet_error *error)
{
    (void)desc;
    *environment = NULL;
    if (!find_light(scene, pose))
        return fail(error, FACET_ERROR_ARGUMENT, "%s: the scene brings no light of its own", scene->source);
    return fail(error, FACET_ERROR_UNSUPPORTED, "%s: EXT_lights_image_based is not read yet", scene->source);
}
