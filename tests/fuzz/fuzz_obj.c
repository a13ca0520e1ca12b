/* fuzz_obj.c - the OBJ reader on arbitrary bytes; the first byte chooses the normals and the number of
 * threads. */
#include "fuzz_support.h"

#include "fuzz_scene.h"
#include "io/obj/obj.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size == 0)
        return 0;
    facet_budget *budget = fuzz_begin((uint64_t)64 << 20);
    facet_allocator allocator = facet_budget_allocator(budget);
    facet_scene_desc desc = {.allocator = allocator,
                             .log = {.message = fuzz_ignore},
                             .thread_count = 1,
                             .obj_normals = (facet_obj_normals)(data[0] % 3),
                             .has_flipped_texcoords = data[0] & 4};
    facet_scene *scene = NULL;
    facet_error error = {0};
    obj_detect(data + 1, size - 1);
    obj_has_faces(data + 1, size - 1);
    if (obj_load_memory(data + 1, size - 1, "fuzz", &desc, &scene, &error) == FACET_OK)
        fuzz_use_scene(scene, &allocator);
    else if (scene || error.message[0] == 0)
        abort();
    scene_destroy(scene);
    fuzz_end(budget);
    return 0;
}
