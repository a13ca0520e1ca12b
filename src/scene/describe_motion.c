/* describe_motion.c - skins and animations as JSON. */
#include <stddef.h>

#include "scene/describe.h"

static void write_skin(text *t, const scene_skin *skin)
{
    text_json_begin_object(t, NULL);
    text_json_string(t, "name", skin->name);
    describe_indices(t, "joints", skin->joints, skin->joint_count);
    describe_index(t, "skeleton", skin->skeleton);
    describe_meta(t, &skin->meta);
    text_json_end_object(t);
}

static const char *path_of(const scene_channel *c)
{
    switch (c->kind) {
    case SCENE_TARGET_WEIGHTS:
        return "weights";
    case SCENE_TARGET_VISIBLE:
        return "visible";
    case SCENE_TARGET_NODE:
        return c->offset == offsetof(scene_node, translation) ? "translation"
               : c->offset == offsetof(scene_node, rotation)  ? "rotation"
                                                              : "scale";
    default:
        return "pointer";
    }
}

static void write_channel(text *t, const scene_animation *animation, const scene_channel *c)
{
    static const char *const kinds[] = {[SCENE_TARGET_NODE] = "node",    [SCENE_TARGET_VISIBLE] = "node",
                                        [SCENE_TARGET_WEIGHTS] = "node", [SCENE_TARGET_MATERIAL] = "material",
                                        [SCENE_TARGET_LIGHT] = "light",  [SCENE_TARGET_CAMERA] = "camera"};
    static const char *const interpolations[] = {"STEP", "LINEAR", "CUBICSPLINE"};
    const scene_sampler *sampler = &animation->samplers[c->sampler];
    text_json_begin_object(t, NULL);
    text_json_integer(t, kinds[c->kind], c->index);
    text_json_string(t, "path", path_of(c));
    if (c->pointer)
        text_json_string(t, "pointer", c->pointer);
    text_json_string(t, "interpolation", interpolations[sampler->interpolation]);
    text_json_integer(t, "keys", sampler->key_count);
    text_json_end_object(t);
}

static void write_animation(text *t, const scene_animation *animation)
{
    text_json_begin_object(t, NULL);
    text_json_string(t, "name", animation->name);
    text_json_float(t, "begin", animation->begin_s);
    text_json_float(t, "end", animation->end_s);
    text_json_begin_array(t, "channels");
    for (uint32_t i = 0; i < animation->channel_count; i++)
        write_channel(t, animation, &animation->channels[i]);
    text_json_end_array(t);
    describe_meta(t, &animation->meta);
    text_json_end_object(t);
}

void describe_motion(text *t, const facet_scene *scene)
{
    text_json_begin_array(t, "skins");
    for (uint32_t i = 0; i < scene->skin_count; i++)
        write_skin(t, &scene->skins[i]);
    text_json_end_array(t);
    text_json_begin_array(t, "animations");
    for (uint32_t i = 0; i < scene->animation_count; i++)
        write_animation(t, &scene->animations[i]);
    text_json_end_array(t);
}
