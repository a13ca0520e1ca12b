/* gl_material.c - see gl_material.h. Materials are indexed as in render_geometry: a pose changes factors,
 * never textures. */
#include "gl/scene/gl_material.h"

#include <string.h>

#include "base/memory.h"
#include "base/result.h"
#include "gl/core/gl_api.h"
#include "gl/core/gl_texture.h"
#include "gl/scene/gl_material_block.h"
#include "scene/material_table.h"

_Static_assert((int)GL_SURFACE_PAIRS == (int)GL_SURFACE_TEXTURES + (int)SCENE_TEXTURE_SLOT_COUNT &&
                   (int)GL_SURFACE_LAYERS == (int)GL_SURFACE_PAIRS + (int)GL_SLOT_PAIR_COUNT,
               "the features of gl_program.h have the order of the slots and pairs");

_Static_assert(sizeof(gl_material_block) <= GL_MATERIAL_BLOCK_SIZE, "gl_material.h has the size");

/* ---- the set ---- */

/* As uploaded. */
typedef struct gl_material {
    gl_material_block block;
    bool is_known;
    bool is_reported;           /* too many textures for the units */
    bool is_occlusion_reported; /* its occlusion texture is left out */
} gl_material;

struct gl_material_set {
    gl_context *context;
    const facet_scene *scene;
    facet_allocator allocator;
    gl_texture_set *textures;
    const gl_phong *phong; /* of legacy materials; NULL: they are drawn as glTF materials */
    gl_material *items;    /* by material_id */
    texture_use *uses;     /* by texture */
    GLuint buffer;
    size_t stride;           /* of the blocks in the buffer, bytes */
    uint64_t image_features; /* of lit materials */
    uint64_t channel_feature;
};

facet_result gl_material_create(gl_context *context, const facet_scene *scene,
                                const facet_allocator *allocator, gl_material_set **out, facet_error *error)
{
    gl_material_set *set = mem_zalloc(allocator, 1, sizeof *set);
    size_t count = (size_t)scene->material_count + 1;
    *out = NULL;
    if (!set)
        return fail_memory(error, "materials", sizeof *set);
    set->context = context;
    set->scene = scene;
    set->allocator = allocator ? *allocator : (facet_allocator){0};
    set->items = mem_zalloc(allocator, count, sizeof *set->items);
    set->uses = mem_zalloc(allocator, scene->texture_count, sizeof *set->uses);
    facet_result result = FACET_OK;
    if (!set->items || !set->uses)
        result = fail_memory(error, "materials", count * sizeof *set->items);
    if (result == FACET_OK)
        result = gl_texture_create(context, scene, allocator, &set->textures, error);
    if (result != FACET_OK) {
        gl_material_destroy(set);
        return result;
    }
    GLint alignment = 256;
    glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &alignment);
    size_t step = alignment > 0 ? (size_t)alignment : 256;
    set->stride = (sizeof(gl_material_block) + step - 1) / step * step;
    glGenBuffers(1, &set->buffer);
    glBindBuffer(GL_UNIFORM_BUFFER, set->buffer);
    glBufferData(GL_UNIFORM_BUFFER, (GLsizeiptr)(count * set->stride), NULL, GL_DYNAMIC_DRAW);
    *out = set;
    return gl_context_check(context, "materials", error);
}

void gl_material_destroy(gl_material_set *set)
{
    if (!set)
        return;
    if (set->buffer)
        glDeleteBuffers(1, &set->buffer);
    gl_texture_destroy(set->textures);
    mem_free(set->items);
    mem_free(set->uses);
    mem_free(set);
}

/* ---- textures in use ---- */

static const scene_texture_ref *ref_of(const gl_batch *batch, int slot)
{
    return &batch->geometry->material->textures[slot];
}

static uint32_t name_of(const gl_material_set *set, const gl_batch *batch, int slot)
{
    return gl_texture_name(set->textures, ref_of(batch, slot)->texture, material_textures[slot].is_color);
}

/* Whether both sample the same texel. Alpha is the same whether an image is read as color or as data. */
static bool is_pair(const gl_material_set *set, const scene_texture_ref *a, const scene_texture_ref *b)
{
    const scene_texture *textures = set->scene->textures;
    uint32_t count = set->scene->texture_count;
    return a->texture < count && b->texture < count &&
           textures[a->texture].image == textures[b->texture].image &&
           gl_texture_sampler(set->textures, a->texture) == gl_texture_sampler(set->textures, b->texture) &&
           a->texcoord == b->texcoord && a->has_transform == b->has_transform &&
           (!a->has_transform || memcmp(a->transform, b->transform, sizeof a->transform) == 0);
}

/* Features of the pairs among the sampled slots. */
static uint64_t pair_features(const gl_material_set *set, const gl_batch *batch, uint32_t slots)
{
    uint64_t features = 0;
    for (int i = 0; i < GL_SLOT_PAIR_COUNT; i++) {
        const gl_slot_pair *p = &gl_slot_pairs[i];
        if (slots >> p->first & slots >> p->second & 1 &&
            is_pair(set, ref_of(batch, (int)p->first), ref_of(batch, (int)p->second)))
            features |= 1ull << (GL_SURFACE_PAIRS + i);
    }
    return features;
}

/* Bits of the slots that a batch samples. The CPU traces real distances through volumes; here the thickness
 * texture gives them. */
static uint32_t slots_of(const gl_material_set *set, const gl_batch *batch)
{
    uint32_t slots = batch->plan->textures;
    uint32_t occlusion = ref_of(batch, SCENE_OCCLUSION_TEXTURE)->texture;
    if (material_plan_drops_occlusion(batch->geometry->material,
                                      gl_texture_lacks_red(set->textures, occlusion)))
        slots &= ~(1u << SCENE_OCCLUSION_TEXTURE);
    if (batch->plan->is_volume && scene_material_has(batch->geometry->material, SCENE_THICKNESS_TEXTURE))
        slots |= 1u << SCENE_THICKNESS_TEXTURE;
    return slots;
}

/* Units for the textures of a batch: rays through a transmissive one take the last. */
static int units_of(const gl_batch *batch)
{
    return GL_MATERIAL_UNITS - (batch->plan->lets_rays_through ? 1 : 0);
}

/* Texture features of a batch. *lost: slots that are dropped for lack of units. */
static uint64_t texture_features(const gl_material_set *set, const gl_batch *batch, uint32_t *lost)
{
    uint32_t slots = slots_of(set, batch);
    uint64_t pairs = pair_features(set, batch, slots);
    for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++) {
        if (!(slots >> slot & 1) || name_of(set, batch, slot))
            continue;
        bool is_read_elsewhere = false;
        for (int i = 0; i < GL_SLOT_PAIR_COUNT; i++)
            is_read_elsewhere |= (int)gl_slot_pairs[i].second == slot &&
                                 pairs >> (GL_SURFACE_PAIRS + i) & 1 &&
                                 name_of(set, batch, (int)gl_slot_pairs[i].first);
        if (!is_read_elsewhere)
            slots &= ~(1u << slot);
    }
    *lost = 0;
    for (int i = 0; i <= SCENE_TEXTURE_SLOT_COUNT; i++) {
        uint64_t features = (uint64_t)slots << GL_SURFACE_TEXTURES | pair_features(set, batch, slots);
        int8_t units[SCENE_TEXTURE_SLOT_COUNT];
        if (gl_material_slot_units(features, units) <= units_of(batch) || i == SCENE_TEXTURE_SLOT_COUNT)
            return features;
        uint32_t given_up = 1u << gl_slots_by_loss[i];
        /* the second slot of a pair cannot be sampled without the first */
        for (int k = 0; k < GL_SLOT_PAIR_COUNT; k++)
            if (gl_slot_pairs[k].first == gl_slots_by_loss[i] && features >> (GL_SURFACE_PAIRS + k) & 1)
                given_up |= 1u << gl_slot_pairs[k].second;
        *lost |= slots & given_up;
        slots &= ~given_up;
    }
    return 0;
}

/* Whether slots a and b are read at the same places, through pixels of the same footprint. */
static bool has_same_footprint(const gl_material_set *set, const gl_batch *batch, int a, int b)
{
    const gl_material_block *block = &set->items[batch->geometry->material_id].block;
    const uint32_t *of_a =
        gl_texture_size(set->textures, ref_of(batch, a)->texture, material_textures[a].is_color);
    const uint32_t *of_b =
        gl_texture_size(set->textures, ref_of(batch, b)->texture, material_textures[b].is_color);
    return memcmp(of_a, of_b, 2 * sizeof *of_a) == 0 &&
           memcmp(block->texcoords[a], block->texcoords[b], sizeof block->texcoords[a]) == 0;
}

/* GL_SURFACE_HAS_ONE_FOOTPRINT, where two textures or more of those in features have the same, and probes are taken. */
static uint64_t footprint_feature(const gl_material_set *set, const gl_batch *batch, uint64_t features)
{
    const gl_material *item = &set->items[batch->geometry->material_id];
    int8_t units[SCENE_TEXTURE_SLOT_COUNT];
    if (gl_material_slot_units(features, units) < 2)
        return 0;
    int first = 0;
    while (units[first] != 0)
        first++;
    if (item->block.texcoords[first][1][3] <= 0.0f)
        return 0;
    for (int slot = first + 1; slot < SCENE_TEXTURE_SLOT_COUNT; slot++)
        if (units[slot] > 0 && !has_same_footprint(set, batch, first, slot))
            return 0;
    return 1ull << GL_SURFACE_HAS_ONE_FOOTPRINT;
}

/* Records the textures that the batch reads. */
static void add_uses(gl_material_set *set, const gl_batch *batch)
{
    uint32_t slots = slots_of(set, batch);
    uint64_t pairs = pair_features(set, batch, slots);
    for (int i = 0; i < GL_SLOT_PAIR_COUNT; i++)
        if (pairs >> (GL_SURFACE_PAIRS + i) & 1)
            slots &= ~(1u << gl_slot_pairs[i].second);
    for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++) {
        uint32_t texture = ref_of(batch, slot)->texture;
        if (!(slots >> slot & 1) || texture >= set->scene->texture_count)
            continue;
        if (material_textures[slot].is_color)
            set->uses[texture].is_read_as_color = true;
        else
            set->uses[texture].is_read_as_data = true;
    }
}

/* ---- updates ---- */

static void update_block(gl_material_set *set, const gl_batch *batch)
{
    gl_material *item = &set->items[batch->geometry->material_id];
    gl_material_block block;
    gl_material_block_fill(set->scene, batch->geometry->material, &block);
    block.row = (float)batch->geometry->material_id;
    if (item->is_known && memcmp(&block, &item->block, sizeof block) == 0)
        return;
    item->block = block;
    item->is_known = true;
    glBufferSubData(GL_UNIFORM_BUFFER, (GLintptr)(batch->geometry->material_id * set->stride), sizeof block,
                    &block);
}

static void warn_lost(gl_material_set *set, const gl_batch *batch, const facet_log *log)
{
    gl_material *item = &set->items[batch->geometry->material_id];
    uint32_t lost;
    if ((batch->plan->textures & ~slots_of(set, batch)) >> SCENE_OCCLUSION_TEXTURE & 1 &&
        !item->is_occlusion_reported) {
        item->is_occlusion_reported = true;
        material_plan_warn_occlusion(set->scene, batch->geometry->material_id - 1, log);
    }
    texture_features(set, batch, &lost);
    if (!lost || item->is_reported)
        return;
    item->is_reported = true;
    const scene_address at =
        scene_get_address(set->scene, SCENE_ITEM_MATERIAL, batch->geometry->material_id - 1);
    for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++)
        if (lost >> slot & 1)
            log_warning(
                log, "%s: material %u \"%s\": more textures than OpenGL's %d units: it is drawn without %s",
                at.source, at.number, batch->geometry->material->name ? batch->geometry->material->name : "",
                units_of(batch), material_textures[slot].key);
}

typedef void batch_function(gl_material_set *set, const gl_batch *batch);

static void for_each_batch(gl_material_set *set, const gl_mesh_set *meshes, batch_function *call)
{
    for (gl_pass pass = GL_PASS_OPAQUE; pass < GL_PASS_COUNT; pass++) {
        uint32_t count;
        const gl_batch *batches = gl_mesh_batches(meshes, pass, &count);
        for (uint32_t i = 0; i < count; i++)
            call(set, &batches[i]);
    }
}

void gl_material_show(gl_material_set *set, facet_channel channel)
{
    set->channel_feature =
        channel == FACET_CHANNEL_LIGHT ? 0 : gl_program_feature(GL_MAIN_SURFACE, "HAS_CHANNEL");
}

facet_result gl_material_update(gl_material_set *set, const gl_mesh_set *meshes,
                                const facet_render_desc *desc, facet_error *error)
{
    set->image_features = 0;
    if (desc->has_specular_antialiasing)
        set->image_features |= 1ull << GL_SURFACE_HAS_SPECULAR_ANTIALIASING;
    if (desc->gl.brdf == FACET_BRDF_SCHLICK_GGX)
        set->image_features |= gl_program_feature(GL_MAIN_SURFACE, "HAS_SCHLICK_GGX");
    gl_material_show(set, desc->gl.channel);
    memset(set->uses, 0, set->scene->texture_count * sizeof *set->uses);
    for_each_batch(set, meshes, add_uses);
    TRY(gl_texture_update(set->textures, set->uses, &desc->log, desc->thread_count, error));
    glBindBuffer(GL_UNIFORM_BUFFER, set->buffer);
    for_each_batch(set, meshes, update_block);
    for (gl_pass pass = GL_PASS_OPAQUE; pass < GL_PASS_COUNT; pass++) {
        uint32_t count;
        const gl_batch *batches = gl_mesh_batches(meshes, pass, &count);
        for (uint32_t i = 0; i < count; i++)
            warn_lost(set, &batches[i], &desc->log);
    }
    return gl_context_check(set->context, "materials", error);
}

/* ---- drawing ---- */

void gl_material_use_phong(gl_material_set *set, const gl_phong *phong)
{
    set->phong = phong;
}

gl_main gl_material_main(const gl_material_set *set, const gl_batch *batch)
{
    return set->phong && batch->geometry->legacy ? GL_MAIN_PHONG : GL_MAIN_SURFACE;
}

uint64_t gl_material_features(const gl_material_set *set, const gl_batch *batch)
{
    if (gl_material_main(set, batch) == GL_MAIN_PHONG)
        return gl_phong_features(set->phong, batch);
    const render_geometry *g = batch->geometry;
    const scene_material *m = g->material;
    uint32_t lost;
    uint64_t features = texture_features(set, batch, &lost);
    features |= footprint_feature(set, batch, features) | set->channel_feature;
    features |= (uint64_t)batch->plan->layers << GL_SURFACE_LAYERS;
    if (g->tangents)
        features |= GL_SURFACE_HAS_TANGENTS;
    if (g->is_lit)
        features |= set->image_features | 1ull << GL_SURFACE_IS_LIT;
    if (m->extensions & SCENE_UNLIT)
        features |= 1ull << GL_SURFACE_IS_UNLIT;
    if (m->extensions & SCENE_SPECULAR_GLOSSINESS)
        features |= 1ull << GL_SURFACE_IS_GLOSSY;
    if (g->is_see_through && m->alpha_mode == SCENE_ALPHA_MASK)
        features |= 1ull << GL_SURFACE_HAS_ALPHA_MASK;
    if (g->is_see_through && m->alpha_mode == SCENE_ALPHA_BLEND)
        features |= 1ull << GL_SURFACE_HAS_ALPHA_BLEND;
    if (g->primitive->colors)
        features |= 1ull << GL_SURFACE_HAS_COLORS;
    if (batch->plan->is_volume)
        features |= 1ull << GL_SURFACE_IS_VOLUME;
    return features;
}

bool gl_material_has_coverage(const gl_context *context)
{
    return !context->is_es;
}

/* Not of glass, whose opacity is what it shows of the background. */
static void set_coverage(const gl_material_set *set, const gl_batch *batch)
{
    bool is_mask = batch->geometry->is_see_through && !batch->geometry->legacy &&
                   !batch->plan->lets_rays_through &&
                   batch->geometry->material->alpha_mode == SCENE_ALPHA_MASK;
    if (!gl_material_has_coverage(set->context))
        return;
    if (is_mask) {
        glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
        glEnable(GL_SAMPLE_ALPHA_TO_ONE);
    } else {
        glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
        glDisable(GL_SAMPLE_ALPHA_TO_ONE);
    }
}

void gl_material_bind(const gl_material_set *set, const gl_batch *batch)
{
    set_coverage(set, batch);
    if (gl_material_main(set, batch) == GL_MAIN_PHONG) {
        gl_phong_bind(set->phong, batch);
        return;
    }
    uint32_t lost;
    int8_t units[SCENE_TEXTURE_SLOT_COUNT];
    gl_material_slot_units(texture_features(set, batch, &lost), units);
    for (int slot = 0; slot < SCENE_TEXTURE_SLOT_COUNT; slot++) {
        if (units[slot] < 0)
            continue;
        GLuint unit = (GLuint)GL_UNIT_MATERIAL + (GLuint)units[slot];
        glActiveTexture(GL_TEXTURE0 + unit);
        glBindTexture(GL_TEXTURE_2D, name_of(set, batch, slot));
        glBindSampler(unit, gl_texture_sampler(set->textures, ref_of(batch, slot)->texture));
    }
    glBindBufferRange(GL_UNIFORM_BUFFER, GL_BLOCK_MATERIAL, set->buffer,
                      (GLintptr)(batch->geometry->material_id * set->stride), sizeof(gl_material_block));
    if (batch->geometry->is_double_sided || batch->plan->is_volume)
        glDisable(GL_CULL_FACE);
    else
        glEnable(GL_CULL_FACE);
    glFrontFace(batch->geometry->is_mirrored ? GL_CW : GL_CCW);
}

facet_result gl_material_use(const gl_material_set *set, gl_programs *programs, const gl_batch *batch,
                             uint64_t features, facet_error *error)
{
    uint32_t program;
    TRY(gl_programs_get(programs, (gl_program_key){gl_material_main(set, batch), features}, &program, error));
    glUseProgram(program);
    gl_material_bind(set, batch);
    return FACET_OK;
}

void gl_material_mean(const gl_material_set *set, const scene_material *m, scene_texture_slot slot,
                      float mean[4])
{
    gl_texture_mean(set->textures, m->textures[slot].texture, material_textures[slot].is_color, mean);
}

uint32_t gl_material_texture(const gl_material_set *set, const scene_material *m, scene_texture_slot slot,
                             uint32_t size[2])
{
    uint32_t texture = m->textures[slot].texture;
    memcpy(size, gl_texture_size(set->textures, texture, material_textures[slot].is_color), 2 * sizeof *size);
    return gl_texture_name(set->textures, texture, material_textures[slot].is_color);
}

bool gl_material_is_nearest(const gl_material_set *set, const scene_material *m, scene_texture_slot slot)
{
    uint32_t texture = m->textures[slot].texture;
    return texture < set->scene->texture_count &&
           set->scene->textures[texture].mag_filter == SCENE_FILTER_NEAREST;
}

uint64_t gl_material_decoded_texels(const gl_material_set *set)
{
    return gl_texture_decoded_texels(set->textures);
}
