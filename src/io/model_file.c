/* model_file.c - see model_file.h. */
#include "io/model_file.h"

#include <strings.h>

#include "base/result.h"
#include "io/gltf/gltf.h"
#include "io/obj/obj.h"
#include "io/ogl1/ogl1_json.h"
#include "scene/legacy.h"
#include "scene/origin.h"

typedef enum model_kind { MODEL_GLTF, MODEL_OBJ, MODEL_PARAMETERS } model_kind;

/* What is none of them is left to the glTF reader, whose message says what was expected. */
static model_kind detect(const void *bytes, size_t size)
{
    if (ogl1_json_detect(bytes, size))
        return MODEL_PARAMETERS;
    return obj_detect(bytes, size) ? MODEL_OBJ : MODEL_GLTF;
}

/* Ends every reader's work. */
static facet_result settle(facet_result result, const facet_scene_desc *desc, facet_scene **scene,
                           facet_error *error)
{
    if (result == FACET_OK)
        result = scene_settle_origin(*scene, &desc->log, error);
    if (result != FACET_OK && *scene) {
        scene_destroy(*scene);
        *scene = NULL;
    }
    return result;
}

facet_result model_file_load(const char *path, const facet_scene_desc *desc, facet_scene **scene,
                             facet_error *error)
{
    file_bytes file = {0};
    facet_result result = file_open(path, desc->max_file_bytes ? desc->max_file_bytes : (uint64_t)1 << 32,
                                    &desc->allocator, &file, error);
    if (result != FACET_OK)
        return result;
    model_kind kind = detect(file.data, file.size);
    file_close(&file);
    result = kind == MODEL_OBJ          ? obj_load(path, desc, scene, error)
             : kind == MODEL_PARAMETERS ? ogl1_json_load(path, desc, scene, error)
                                        : gltf_load(path, desc, scene, error);
    return settle(result, desc, scene, error);
}

facet_result model_file_load_memory(const void *bytes, size_t size, const char *name,
                                    const facet_scene_desc *desc, facet_scene **scene, facet_error *error)
{
    model_kind kind = detect(bytes, size);
    facet_result result = kind == MODEL_OBJ ? obj_load_memory(bytes, size, name, desc, scene, error)
                          : kind == MODEL_PARAMETERS
                              ? ogl1_json_load_memory(bytes, size, name, desc, scene, error)
                              : gltf_load_memory(bytes, size, name, desc, scene, error);
    return settle(result, desc, scene, error);
}

facet_result model_file_save(const facet_scene *scene, const char *path, const char *generator,
                             const facet_scene_save_desc *desc, facet_error *error)
{
    const facet_scene_save_desc defaults = {0};
    desc = desc ? desc : &defaults;
    const char *extension = path_extension(path);
    bool is_obj = !desc->is_glb && strcasecmp(extension, "obj") == 0;
    bool is_parameters = !desc->is_glb && strcasecmp(extension, "json") == 0;
    if ((is_obj || is_parameters) && !scene_has_legacy_materials(scene))
        return fail(error, FACET_ERROR_ARGUMENT,
                    "%s: the scene has no materials of OpenGL 1; facet_scene_convert_materials() makes them",
                    path);
    if (is_obj)
        return obj_save(scene, path, generator, desc, error);
    if (is_parameters)
        return ogl1_json_save(scene, path, generator, desc, error);
    return gltf_save(scene, path, generator, desc, error);
}
