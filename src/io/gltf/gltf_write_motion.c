/* gltf_write_motion.c - skins and animations. */
#include <stddef.h>

#include "io/gltf/gltf_writer.h"

void gltf_write_skins(gltf_writer *w)
{
    for (uint32_t i = 0; i < w->scene->skin_count && gltf_writer_is_ok(w); i++) {
        const scene_skin *skin = &w->scene->skins[i];
        json_t *out = json_object();
        gltf_put_name(w, out, skin->name);
        if (skin->inverse_bind)
            gltf_put_index(w, out, "inverseBindMatrices",
                           gltf_write_floats(w, skin->inverse_bind->m, skin->joint_count, WRITE_MAT4,
                                             WRITE_NO_TARGET, false));
        gltf_put_index(w, out, "skeleton", skin->skeleton);
        gltf_put(w, out, "joints", gltf_json_indices(skin->joints, skin->joint_count));
        gltf_put_meta(w, out, &skin->meta);
        gltf_append(w, gltf_put_array(w, w->root, "skins"), out);
    }
}

/* ---- animations ---- */

/* Whether a channel's values are whether something is there: bytes, 0 or 1. */
static bool is_boolean(const scene_animation *animation, uint32_t sampler)
{
    for (uint32_t i = 0; i < animation->channel_count; i++)
        if (animation->channels[i].sampler == sampler)
            return animation->channels[i].kind == SCENE_TARGET_VISIBLE;
    return false;
}

/* Weights, any number of them, are as many scalars; so is what has more components than vectors. */
static bool is_scalars(const scene_animation *animation, uint32_t sampler)
{
    for (uint32_t i = 0; i < animation->channel_count; i++)
        if (animation->channels[i].sampler == sampler)
            return animation->channels[i].kind == SCENE_TARGET_WEIGHTS;
    return animation->samplers[sampler].width > 4;
}

static uint32_t write_booleans(gltf_writer *w, const scene_sampler *s)
{
    unsigned char *bytes = mem_alloc(w->allocator, s->key_count, 1);
    uint32_t accessor = 0;
    if (!bytes) {
        gltf_writer_fail_memory(w, s->key_count);
        return 0;
    }
    for (uint32_t i = 0; i < s->key_count; i++)
        bytes[i] = s->values[i] >= 0.5f;
    accessor = gltf_write_bytes(w, bytes, s->key_count);
    mem_free(bytes);
    return accessor;
}

static uint32_t write_values(gltf_writer *w, const scene_animation *animation, uint32_t sampler)
{
    static const write_type types[] = {WRITE_SCALAR, WRITE_SCALAR, WRITE_VEC2, WRITE_VEC3, WRITE_VEC4};
    const scene_sampler *s = &animation->samplers[sampler];
    size_t count = (size_t)s->key_count * (s->interpolation == SCENE_CUBIC_SPLINE ? 3 : 1);
    if (is_boolean(animation, sampler))
        return write_booleans(w, s);
    if (is_scalars(animation, sampler))
        return gltf_write_floats(w, s->values, count * s->width, WRITE_SCALAR, WRITE_NO_TARGET, false);
    return gltf_write_floats(w, s->values, count, types[s->width], WRITE_NO_TARGET, false);
}

static void write_sampler(gltf_writer *w, json_t *samplers, const scene_animation *animation, uint32_t index)
{
    static const char *const names[] = {"STEP", "LINEAR", "CUBICSPLINE"};
    const scene_sampler *s = &animation->samplers[index];
    json_t *out = json_object();
    gltf_put_index(w, out, "input",
                   gltf_write_floats(w, s->times, s->key_count, WRITE_SCALAR, WRITE_NO_TARGET, true));
    if (s->interpolation != SCENE_LINEAR)
        gltf_put(w, out, "interpolation", json_string(names[s->interpolation]));
    gltf_put_index(w, out, "output", write_values(w, animation, index));
    gltf_append(w, samplers, out);
}

/* What a channel of the core moves. */
static const char *path_of(const scene_channel *c)
{
    if (c->kind == SCENE_TARGET_WEIGHTS)
        return "weights";
    return c->offset == offsetof(scene_node, translation) ? "translation"
           : c->offset == offsetof(scene_node, rotation)  ? "rotation"
                                                          : "scale";
}

static void write_channel(gltf_writer *w, json_t *channels, const scene_channel *c)
{
    json_t *out = json_object();
    gltf_put_index(w, out, "sampler", c->sampler);
    json_t *target = gltf_put_object(w, out, "target");
    if (c->pointer) {
        gltf_put(w, target, "path", json_string("pointer"));
        gltf_put(w, gltf_put_extension(w, target, "KHR_animation_pointer"), "pointer",
                 gltf_json_text(w, c->pointer));
    } else {
        gltf_put_index(w, target, "node", c->index);
        gltf_put(w, target, "path", json_string(path_of(c)));
    }
    gltf_append(w, channels, out);
}

void gltf_write_animations(gltf_writer *w)
{
    for (uint32_t i = 0; i < w->scene->animation_count && gltf_writer_is_ok(w); i++) {
        const scene_animation *animation = &w->scene->animations[i];
        if (animation->channel_count ==
            0) /* what glTF does not allow; none has a number that others refer to */
            continue;
        json_t *out = json_object();
        gltf_put_name(w, out, animation->name);
        json_t *channels = gltf_put_array(w, out, "channels");
        json_t *samplers = gltf_put_array(w, out, "samplers");
        for (uint32_t k = 0; k < animation->channel_count; k++)
            write_channel(w, channels, &animation->channels[k]);
        for (uint32_t k = 0; k < animation->sampler_count; k++)
            write_sampler(w, samplers, animation, k);
        gltf_put_meta(w, out, &animation->meta);
        gltf_append(w, gltf_put_array(w, w->root, "animations"), out);
    }
}
