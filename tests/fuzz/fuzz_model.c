/* fuzz_model.c - all operations of the command on a model, on arbitrary bytes: read, describe, frame, render
 * one pixel with the preview and the path tracer, convert to glTF and back to OpenGL 1, write, read again. */
#include "fuzz_support.h"

/* One pixel in the center of the default framing. */
static void render(const facet_scene *scene, const facet_pose_desc *pose, const facet_allocator *allocator)
{
    facet_error error = {0};
    const facet_orbit orbit = facet_orbit_default();
    facet_camera camera;
    facet_result result = facet_camera_from_orbit(scene, pose, &orbit, 1.0f, &camera, &error);
    fuzz_check_error(result, &error);
    for (int i = 0; result == FACET_OK && i < 2; i++) {
        const facet_render_desc desc = {.allocator = *allocator,
                                        .log = {.message = fuzz_ignore},
                                        .thread_count = 1,
                                        .width = 1,
                                        .height = 1,
                                        .pose = *pose,
                                        .camera = &camera,
                                        .renderer =
                                            i ? FACET_RENDERER_KIND_PATH : FACET_RENDERER_KIND_PREVIEW,
                                        .samples = 1,
                                        .path = {.max_depth = 4}};
        facet_image *image = NULL;
        fuzz_check_error(facet_render(scene, &desc, &image, &error), &error);
        facet_image_destroy(image);
    }
}

static void read_again(const char *path, const facet_scene_desc *desc)
{
    facet_scene *scene = NULL;
    facet_error error = {0};
    fuzz_check_error(facet_scene_load(path, desc, &scene, &error), &error);
    facet_scene_destroy(scene);
}

static void convert(facet_scene *scene, const facet_scene_desc *desc)
{
    char path[64];
    snprintf(path, sizeof path, "/dev/shm/facet-fuzz-%ld.glb", (long)getpid());
    const facet_scene_save_desc save = {
        .allocator = desc->allocator, .log = desc->log, .thread_count = 1, .is_glb = true};
    facet_error error = {0};
    facet_result result = facet_scene_save(scene, path, &save, &error);
    fuzz_check_error(result, &error);
    if (result == FACET_OK)
        read_again(path, desc);
    unlink(path);
    result = facet_scene_convert_materials(scene, FACET_MATERIAL_MODEL_OGL1, NULL, &desc->log, &error);
    fuzz_check_error(result, &error);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    facet_budget *budget = fuzz_begin((uint64_t)64 << 20);
    const facet_scene_desc desc = {.allocator = facet_budget_allocator(budget),
                                   .log = {.message = fuzz_ignore},
                                   .thread_count = 1,
                                   .max_texture_size = 64};
    facet_scene *scene = NULL;
    facet_error error = {0};
    facet_result result = facet_scene_load_memory(data, size, "fuzz", &desc, &scene, &error);
    fuzz_check_error(result, &error);
    if (result == FACET_OK) {
        const facet_allocator allocator = desc.allocator;
        char *text = NULL;
        fuzz_check_error(facet_scene_describe_json(scene, &text, &error), &error);
        facet_text_destroy(text);
        const uint32_t first = 0;
        facet_pose_desc pose = {.animations = &first};
        render(scene, &pose, &allocator);
        if (facet_scene_get_counts(scene).animations) {
            pose.animation_count = 1;
            pose.time_s = 0.5;
            render(scene, &pose, &allocator);
        }
        convert(scene, &desc);
    }
    facet_scene_destroy(scene);
    fuzz_end(budget);
    return 0;
}
