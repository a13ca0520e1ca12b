/* texture_set.c - which images the textures of a render show, and how. See texture.h. */
#include "draw/texture_set.h"

#include "base/memory.h"
#include "base/result.h"

/* Collects what textures need of their images; returns the number of images that are read. wants:
 * scene->image_count of them, zero. */
static size_t collect_wants(const facet_scene *scene, const texture_use *uses, texture_want *wants)
{
    for (uint32_t t = 0; t < scene->texture_count; t++) {
        const scene_texture *texture = &scene->textures[t];
        if (!(uses[t].is_read_as_color || uses[t].is_read_as_data) || texture->image >= scene->image_count ||
            !scene->images[texture->image].bytes)
            continue;
        texture_want *want = &wants[texture->image];
        bool is_new = !want->is_read[0] && !want->is_read[1];
        /* Without mips the full image is read, at any distance. */
        float min_lod = texture->mip_filter == SCENE_MIP_NONE ? 0.0f : uses[t].min_lod;
        if (!(min_lod > 0.0f))
            min_lod = 0.0f;
        want->min_lod = is_new || min_lod < want->min_lod ? min_lod : want->min_lod;
        want->is_read[0] |= uses[t].is_read_as_data;
        want->is_read[1] |= uses[t].is_read_as_color;
    }
    return texture_wants_compact(wants, scene->image_count);
}

/* Connects textures with the pyramids. Levels finer than this render asked for are not used. */
static void bind(texture_set *set, const facet_scene *scene, const texture_want *wants, size_t count)
{
    for (size_t i = 0; i < count; i++)
        for (int as_color = 0; as_color < 2; as_color++) {
            texture_pyramid *p = &set->pyramids[2 * (size_t)wants[i].image + !as_color];
            if (!wants[i].pyramid[as_color])
                continue;
            *p = *wants[i].pyramid[as_color];
            p->blocks[0] = p->blocks[1] = NULL;
            p->first_level = wants[i].first_level;
        }
    for (uint32_t t = 0; t < scene->texture_count; t++) {
        const scene_texture *texture = &scene->textures[t];
        texture_binding *b = &set->bindings[t];
        *b = (texture_binding){.wrap_u = texture->wrap_u,
                               .wrap_v = texture->wrap_v,
                               .mag_filter = texture->mag_filter,
                               .min_filter = texture->min_filter,
                               .mip_filter = texture->mip_filter};
        if (texture->image >= scene->image_count)
            continue;
        const texture_pyramid *pyramids = &set->pyramids[2 * (size_t)texture->image];
        b->color = pyramids[0].level_count ? &pyramids[0] : NULL;
        b->data = pyramids[1].level_count ? &pyramids[1] : NULL;
    }
}

/* From a store; owned: released with the set. */
static facet_result create(texture_store *store, const facet_scene *scene, const texture_use *uses,
                           const facet_allocator *allocator, const facet_log *log, uint32_t thread_count,
                           texture_set **out, facet_error *error)
{
    facet_result result = FACET_OK;
    texture_want *wants = mem_zalloc(allocator, scene->image_count, sizeof *wants);
    texture_set *set = mem_zalloc(allocator, 1, sizeof *set);
    if (set) {
        set->binding_count = scene->texture_count;
        set->image_count = scene->image_count;
        set->bindings = mem_zalloc(allocator, scene->texture_count, sizeof *set->bindings);
        set->pyramids = mem_zalloc(allocator, scene->image_count, 2 * sizeof *set->pyramids);
    }
    if (!wants || !set || !set->bindings || !set->pyramids) {
        result = fail_memory(error, "textures", scene->image_count * 2 * sizeof *set->pyramids);
        goto done;
    }
    size_t count = collect_wants(scene, uses, wants);
    result = texture_store_get(store, wants, count, log, thread_count, &set->decoded_texels, error);
    if (result != FACET_OK)
        goto done;
    bind(set, scene, wants, count);
    *out = set;
    set = NULL;

done:
    texture_set_destroy(set);
    mem_free(wants);
    return result;
}

facet_result texture_set_create(const facet_scene *scene, const texture_use *uses,
                                const facet_allocator *allocator, const facet_log *log, uint32_t thread_count,
                                texture_set **out, facet_error *error)
{
    *out = NULL;
    texture_store *store;
    facet_result result = texture_store_create(scene, allocator, &store, error);
    if (result == FACET_OK)
        result = create(store, scene, uses, allocator, log, thread_count, out, error);
    if (result == FACET_OK)
        (*out)->own_store = store;
    else
        texture_store_destroy(store);
    return result;
}

facet_result texture_set_create_from(texture_store *store, const facet_scene *scene, const texture_use *uses,
                                     const facet_allocator *allocator, const facet_log *log,
                                     uint32_t thread_count, texture_set **out, facet_error *error)
{
    *out = NULL;
    return create(store, scene, uses, allocator, log, thread_count, out, error);
}

void texture_set_destroy(texture_set *set)
{
    if (!set)
        return;
    texture_store_destroy(set->own_store);
    mem_free(set->pyramids);
    mem_free(set->bindings);
    mem_free(set);
}

uint64_t texture_set_decoded_texels(const texture_set *set)
{
    return set->decoded_texels;
}

bool texture_full_size(const facet_scene *scene, uint32_t texture, float size[2])
{
    uint32_t index = texture < scene->texture_count ? scene->textures[texture].image : SCENE_NONE;
    if (index >= scene->image_count || !scene->images[index].bytes)
        return false;
    const scene_image *i = &scene->images[index];
    image header = {.width = i->width, .height = i->height};
    image_codec codec;
    if ((header.width == 0 || header.height == 0) &&
        image_probe(i->bytes, i->size, "", &header, &codec, NULL) != FACET_OK)
        return false;
    size[0] = (float)header.width;
    size[1] = (float)header.height;
    return true;
}
