/* gltf_animations.c - animations (glTF 2.0 sections 3.11, 5.5 to 5.8): samplers, whose times are put in
 * order, whose values are made finite and whose rotations unit, and channels. Arrays that need no repair
 * are not copied. */
#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/gltf/gltf_components.h"

/* ---- times ---- */

typedef struct key {
    float time;
    uint32_t index;
} key;

static int compare_keys(const void *a, const void *b)
{
    const key *x = a;
    const key *y = b;
    return x->time != y->time ? (x->time < y->time ? -1 : 1) : x->index < y->index ? -1 : 1;
}

static bool is_increasing(const float *times, size_t count)
{
    bool is_right = fabsf(times[0]) <= FLT_MAX;
    for (size_t i = 1; i < count; i++)
        is_right &= times[i] > times[i - 1] && times[i] <= FLT_MAX; /* false for NaN */
    return is_right;
}

/* Sorts keys by time and removes those without a finite time; of several at the same time the last one
 * stays. Returns the number that is left. */
static uint32_t order_keys(const float *times, uint32_t count, key *out)
{
    uint32_t finite = 0;
    for (uint32_t i = 0; i < count; i++)
        if (fabsf(times[i]) <= FLT_MAX)
            out[finite++] = (key){times[i], i};
    qsort(out, finite, sizeof *out, compare_keys);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < finite; i++)
        if (i + 1 == finite || out[i + 1].time > out[i].time)
            out[kept++] = out[i];
    return kept;
}

/* Replaces keys that do not increase strictly by their sorted subset. */
static bool repair_times(io_reader *r, const json_place *at, scene_sampler *s)
{
    size_t width = (size_t)s->width * (s->interpolation == SCENE_CUBIC_SPLINE ? 3 : 1);
    key *keys = mem_alloc(r->allocator, s->key_count, sizeof *keys);
    if (!keys)
        return io_fail_memory(r, "animation", s->key_count * sizeof *keys);
    uint32_t count = order_keys(s->times, s->key_count, keys);
    io_warn(r, at, "input", "does not increase strictly; %u of %u keys are used, sorted", count,
            s->key_count);
    float *times = io_alloc_raw(r, "animation", count, sizeof *times);
    float *values = io_alloc_raw(r, "animation", count, width * sizeof *values);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        times[i] = keys[i].time;
        memcpy(values + width * i, s->values + width * keys[i].index, width * sizeof *values);
    }
    mem_free(keys);
    s->key_count = count;
    s->times = times;
    s->values = values;
    return io_is_ok(r) && count > 0;
}

/* ---- rotations ---- */

/* Quaternions beyond this tolerance are normalized; others are kept as rounded by the exporter. */
static const double UNIT_TOLERANCE = 1e-5;
static const double FAR_OFF = 0.01; /* tolerance of a warning */

static double length_of(const float q[4])
{
    return sqrt((double)q[0] * (double)q[0] + (double)q[1] * (double)q[1] + (double)q[2] * (double)q[2] +
                (double)q[3] * (double)q[3]);
}

/* Normalizes the rotations of a sampler; tangents of splines are scaled with them. */
static bool repair_rotations(io_reader *r, const json_place *at, scene_sampler *s)
{
    bool is_cubic = s->interpolation == SCENE_CUBIC_SPLINE;
    size_t step = is_cubic ? 12 : 4;
    bool is_unit = true;
    for (size_t i = 0; i < s->key_count; i++)
        is_unit &= fabs(length_of(s->values + step * i + (is_cubic ? 4 : 0)) - 1.0) <= UNIT_TOLERANCE;
    if (is_unit)
        return true;
    float *values = io_alloc_raw(r, "animation", s->key_count, step * sizeof *values);
    if (!values)
        return false;
    memcpy(values, s->values, s->key_count * step * sizeof *values);
    size_t far_off = 0;
    for (size_t i = 0; i < s->key_count; i++) {
        float *q = values + step * i + (is_cubic ? 4 : 0);
        double length = gltf_normalize_rotation(q);
        far_off += fabs(length - 1.0) <= FAR_OFF ? 0u : 1u;
        for (int k = 0; is_cubic && length > 0.0 && k < 4; k++) {
            q[k - 4] = (float)((double)q[k - 4] / length);
            q[k + 4] = (float)((double)q[k + 4] / length);
        }
    }
    if (far_off)
        io_warn(r, at, "output", "has %zu rotations that are not of length 1", far_off);
    s->values = values;
    return true;
}

/* ---- samplers ---- */

/* The checks that do not depend on the target, made for unused samplers, too. */
static void check_animation_sampler(io_reader *r, const json_place *at)
{
    static const char *const keys[2] = {"input", "output"};
    for (int i = 0; i < 2; i++) {
        uint32_t index = gltf_get_required_accessor(r, at, keys[i]);
        if (index == SCENE_NONE)
            return;
        const gltf_accessor *a = &r->gltf->accessors[index];
        if (a->view != SCENE_NONE && r->gltf->views[a->view].stride)
            io_note(r, at, keys[i], "accessor %u is in a buffer view with byteStride", index);
    }
}

static scene_interpolation get_interpolation(io_reader *r, const json_place *at)
{
    static const char *const names[] = {
        [SCENE_STEP] = "STEP", [SCENE_LINEAR] = "LINEAR", [SCENE_CUBIC_SPLINE] = "CUBICSPLINE"};
    const char *name = io_get_string(r, at, "interpolation", "LINEAR");
    if (io_leave_out(r, "LINEAR is used"))
        return SCENE_LINEAR;
    for (int i = 0; i < 3; i++)
        if (strcmp(name, names[i]) == 0)
            return (scene_interpolation)i;
    io_warn(r, at, "interpolation", "\"%.40s\" is not one of LINEAR, STEP, CUBICSPLINE; LINEAR is used",
            name);
    return SCENE_LINEAR;
}

/* The keys of the file. False: an error is recorded, or a warning reports the reason. */
static bool read_sampler(io_reader *r, const json_place *at, scene_sampler *out)
{
    uint32_t input = gltf_get_required_accessor(r, at, "input");
    uint32_t output = gltf_get_required_accessor(r, at, "output");
    if (!io_is_ok(r))
        return false;
    const gltf_accessor *times = &r->gltf->accessors[input];
    const gltf_accessor *values = &r->gltf->accessors[output];
    if (times->type != GLTF_SCALAR || !gltf_is_float(times->component)) {
        io_warn(r, at, "input", "accessor %u must have SCALAR elements of floats; it animates nothing",
                input);
        return false;
    }
    if (!gltf_has_accessor_source(r, input) || !gltf_has_accessor_source(r, output)) {
        io_warn(r, at, NULL, "is in a buffer without bytes; it animates nothing");
        return false;
    }
    *out = (scene_sampler){.interpolation = get_interpolation(r, at), .key_count = times->count};
    /* Several elements form a value of an array: as many per key as there are weights. */
    uint64_t per_element = out->interpolation == SCENE_CUBIC_SPLINE ? 3 : 1;
    uint64_t keys = per_element * out->key_count;
    if (keys == 0 || values->count < keys || values->count % keys != 0) {
        io_warn(r, at, "output",
                "accessor %u has %u elements, which is no multiple of %llu as %u keys need it; nothing "
                "moves by it",
                output, values->count, (unsigned long long)keys, out->key_count);
        return false;
    }
    if (!io_spend(r, at, out->key_count + (uint64_t)values->count))
        return false;
    out->times = gltf_get_accessor_floats(r, at, input);
    out->values = gltf_get_finite(r, at, output, "values");
    out->width = (uint32_t)(values->count / keys) * gltf_component_counts[values->type]; /* below 2^30 here */
    return out->times && out->values;
}

/* Keys in the form of scene_sampler; is_rotation: values of 4 floats become unit. False: an error is
 * recorded, or a warning reports why it animates nothing. */
static bool read_animation_sampler(io_reader *r, const json_place *at, bool is_rotation, scene_sampler *out)
{
    if (!read_sampler(r, at, out))
        return false;
    if (!is_increasing(out->times, out->key_count) && !repair_times(r, at, out))
        return false;
    if (out->times[0] < 0.0f)
        io_note(r, at, "input", "begins before 0 s");
    return !is_rotation || out->width != 4 || repair_rotations(r, at, out);
}

/* ---- channels ---- */

/* The animation that is being read. */
typedef struct animation_reader {
    json_place samplers; /* of the file */
    /* Per sampler of the file, plain and as rotations: its index in the scene, NOT_YET or USELESS. */
    uint32_t (*indices)[2];
    scene_sampler *made;
    uint32_t made_count;
    scene_channel *channels;
    size_t channel_count, channel_capacity;
} animation_reader;

static const uint32_t NOT_YET = UINT32_MAX;
static const uint32_t USELESS = UINT32_MAX - 1; /* a warning gave the reason */

/* ---- samplers ---- */

/* The index in the scene of a sampler of the file, or USELESS. */
static uint32_t get_sampler(io_reader *r, animation_reader *a, uint32_t index, bool is_rotation)
{
    uint32_t *number = &a->indices[index][is_rotation];
    if (*number != NOT_YET)
        return *number;
    json_place at = io_get_element_object(r, &a->samplers, index);
    scene_sampler *out = &a->made[a->made_count];
    *number = USELESS;
    if (!read_animation_sampler(r, &at, is_rotation, out))
        return USELESS;
    *number = a->made_count++;
    return *number;
}

/* ---- channels ---- */

static void add_channel(io_reader *r, animation_reader *a, const scene_channel *channel)
{
    if (!mem_reserve(r->allocator, (void **)&a->channels, &a->channel_capacity, a->channel_count + 1,
                     sizeof *a->channels)) {
        io_fail_memory(r, "animation", a->channel_count * sizeof *a->channels);
        return;
    }
    a->channels[a->channel_count++] = *channel;
}

/* The target of node and path. False: no target; a warning reports it if the file is invalid. */
static bool find_core_target(io_reader *r, const json_place *target, const char *path, gltf_target *out)
{
    static const struct {
        const char *path;
        scene_target_kind kind;
        uint32_t width;
        size_t offset;
    } paths[] = {{"translation", SCENE_TARGET_NODE, 3, offsetof(scene_node, translation)},
                 {"rotation", SCENE_TARGET_NODE, 4, offsetof(scene_node, rotation)},
                 {"scale", SCENE_TARGET_NODE, 3, offsetof(scene_node, scale)},
                 {"weights", SCENE_TARGET_WEIGHTS, 0, 0}};
    uint32_t node = io_get_index(r, target, "node", r->gltf->file_node_count, "node");
    size_t i = 0;
    while (i < 4 && strcmp(path, paths[i].path) != 0)
        i++;
    if (i == 4)
        io_warn(r, target, "path", "\"%.40s\" is not a target path", path);
    if (i == 4 || node == SCENE_NONE)
        return false;
    *out = (gltf_target){.channel = {.kind = paths[i].kind,
                                     .index = node,
                                     .offset = paths[i].offset,
                                     .scale = 1.0f,
                                     .is_rotation = i == 1},
                         .width = paths[i].width};
    if (paths[i].kind == SCENE_TARGET_NODE)
        return true;
    uint32_t mesh = r->scene->nodes[node].mesh;
    out->width = mesh == SCENE_NONE ? 0 : r->scene->meshes[mesh].weight_count;
    if (mesh == SCENE_NONE)
        io_warn(r, target, NULL, "targets weights of node %u, which has no mesh", node);
    else if (out->width == 0)
        io_warn(r, target, NULL, "targets weights of node %u, whose mesh has no morph targets", node);
    return out->width > 0;
}

static bool find_pointed_target(io_reader *r, const json_place *target, gltf_target *out)
{
    json_place extension = io_get_extension(r, target, "KHR_animation_pointer");
    const char *pointer = io_get_string(r, &extension, "pointer", NULL);
    if (!io_is_ok(r))
        return false;
    if (!pointer) {
        io_warn(r, target, "path", "is \"pointer\", but the pointer is missing");
        return false;
    }
    if (io_has_member(target, "node"))
        io_note(r, target, "node", "is present beside a pointer; it is ignored");
    const char *message = gltf_resolve_pointer(r, pointer, out);
    if (message && io_is_ok(r))
        io_warn(r, &extension, "pointer", "\"%.200s\" %s; it is ignored", pointer, message);
    return !message;
}

/* Weights of a mesh apply to every node that uses it without weights of its own: a channel for each, as in
 * a file without pointers. */
static void add_mesh_channels(io_reader *r, animation_reader *a, const scene_channel *channel, uint32_t width)
{
    const facet_scene *scene = r->scene;
    if (!io_spend(r, NULL, scene->node_count))
        return;
    bool is_whole = channel->offset == 0 && width == scene->meshes[channel->index].weight_count;
    for (uint32_t i = 0; i < scene->node_count && io_is_ok(r); i++) {
        if (scene->nodes[i].mesh != channel->index || scene->nodes[i].weights)
            continue;
        char pointer[64];
        snprintf(pointer, sizeof pointer, "/nodes/%u/weights/%zu", i, channel->offset);
        scene_channel own = *channel;
        own.index = i;
        own.pointer = is_whole ? NULL : arena_strdup(scene->arena, pointer);
        if (!is_whole && !own.pointer)
            io_fail_memory(r, "animation", sizeof pointer);
        add_channel(r, a, &own);
    }
}

/* The copies of a node with several parents move with it. */
static void add_node_channels(io_reader *r, animation_reader *a, const scene_channel *channel)
{
    add_channel(r, a, channel);
    if (channel->kind != SCENE_TARGET_NODE && channel->kind != SCENE_TARGET_WEIGHTS &&
        channel->kind != SCENE_TARGET_VISIBLE)
        return;
    const char *rest = channel->pointer ? strchr(channel->pointer + strlen("/nodes/"), '/') : NULL;
    for (uint32_t i = gltf_next_node_copy(r, channel->index); i != SCENE_NONE && io_spend(r, NULL, 1);
         i = gltf_next_node_copy(r, i)) {
        scene_channel own = *channel;
        own.index = i;
        if (rest) {
            char *pointer = io_alloc_raw(r, "animation", strlen(rest) + sizeof "/nodes/4294967295", 1);
            if (!pointer)
                return;
            sprintf(pointer, "/nodes/%u%s", i, rest);
            own.pointer = pointer;
        }
        add_channel(r, a, &own);
    }
}

static void read_channel(io_reader *r, animation_reader *a, const json_place *at)
{
    uint32_t sampler =
        io_get_required_index(r, at, "sampler", (uint32_t)io_get_count(&a->samplers), "sampler");
    json_place target = io_get_object(r, at, "target");
    if (io_is_ok(r) && !target.value)
        io_fail(r, at, "target", FACET_ERROR_INVALID, "is missing");
    const char *path = io_get_string(r, &target, "path", "");
    gltf_target found;
    if (!io_is_ok(r) || !(strcmp(path, "pointer") == 0 ? find_pointed_target(r, &target, &found)
                                                       : find_core_target(r, &target, path, &found)))
        return;
    uint32_t number = get_sampler(r, a, sampler, found.channel.is_rotation);
    if (number == USELESS)
        return;
    found.channel.sampler = number;
    const scene_sampler *s = &a->made[number];
    if (s->width != found.width) {
        io_warn(r, at, "sampler", "has %u numbers per key, but its target has %u; it is ignored", s->width,
                found.width);
        return;
    }
    if (found.needs_steps && s->interpolation != SCENE_STEP) {
        io_warn(r, at, "sampler", "must have interpolation STEP to animate a boolean; it is ignored");
        return;
    }
    if (found.channel.kind == SCENE_TARGET_NODE && r->scene->nodes[found.channel.index].has_matrix)
        io_warn(r, &target, NULL, "animates node %u, which has a matrix", found.channel.index);
    if (found.is_of_mesh)
        add_mesh_channels(r, a, &found.channel, s->width);
    else
        add_node_channels(r, a, &found.channel);
}

/* ---- animations ---- */

static void finish_animation(io_reader *r, const animation_reader *a, scene_animation *out)
{
    scene_channel *channels = io_alloc_raw(r, "animation", a->channel_count, sizeof *channels);
    if (!channels)
        return;
    if (a->channel_count)
        memcpy(channels, a->channels, a->channel_count * sizeof *channels);
    out->channels = channels;
    out->channel_count = (uint32_t)a->channel_count;
    out->samplers = a->made;
    out->sampler_count = a->made_count;
    for (uint32_t i = 0; i < a->made_count; i++) {
        const scene_sampler *s = &a->made[i];
        float last = s->times[s->key_count - 1];
        out->begin_s = i == 0 || s->times[0] < out->begin_s ? s->times[0] : out->begin_s;
        out->end_s = i == 0 || last > out->end_s ? last : out->end_s;
    }
}

static void read_animation(io_reader *r, const json_place *at, scene_animation *out)
{
    static const char consequence[] = "it animates nothing";
    animation_reader a = {.samplers = io_get_array(r, at, "samplers")};
    json_place channels = io_get_array(r, at, "channels");
    out->name = io_get_name(r, at);
    if (io_is_ok(r) && (!a.samplers.value || !channels.value))
        io_fail(r, at, a.samplers.value ? "channels" : "samplers", FACET_ERROR_INVALID, "is missing");
    if (io_leave_out(r, consequence))
        a.samplers.value = channels.value = NULL;
    size_t count = io_get_count(&a.samplers);
    a.made = io_alloc(r, "animation", count, 2 * sizeof *a.made);
    a.indices = mem_alloc(r->allocator, count, sizeof *a.indices);
    if (!a.indices)
        io_fail_memory(r, "animation", count * sizeof *a.indices);
    else
        memset(a.indices, 0xff, count * sizeof *a.indices); /* NOT_YET */
    for (size_t i = 0; i < io_get_count(&channels) && io_is_ok(r); i++) {
        json_place channel = io_get_element_object(r, &channels, i);
        read_channel(r, &a, &channel);
        io_leave_out(r, consequence);
    }
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place sampler = io_get_element_object(r, &a.samplers, i);
        if (a.indices[i][0] != USELESS && a.indices[i][1] != USELESS)
            check_animation_sampler(r, &sampler);
        io_leave_out(r, consequence);
    }
    if (io_is_ok(r))
        finish_animation(r, &a, out);
    out->meta = gltf_get_meta(r, at);
    mem_free(a.indices);
    mem_free(a.channels);
}

void gltf_read_animations(io_reader *r, const json_place *root)
{
    json_place array = io_get_array(r, root, "animations");
    size_t count = io_get_count(&array);
    io_leave_out(r, "they animate nothing");
    r->scene->animations = io_alloc(r, "animations", count, sizeof *r->scene->animations);
    for (size_t i = 0; i < count && io_is_ok(r); i++) {
        json_place at = io_get_element_object(r, &array, i);
        r->scene->animations[i].name = "";
        if (!io_leave_out(r, "it animates nothing"))
            read_animation(r, &at, &r->scene->animations[i]);
        r->scene->animation_count = (uint32_t)(i + 1);
    }
}
