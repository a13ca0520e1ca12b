/* model_file.c - see model_file.h. */
#include "io/model_file.h"

#include <string.h>
#include <strings.h>

#include "base/result.h"
#include "io/arrays/arrays.h"
#include "io/file_source.h"
#include "io/gltf/gltf.h"
#include "io/model_kind.h"
#include "io/obj/obj.h"
#include "io/ogl1/ogl1_json.h"
#include "io/ply/ply.h"
#include "io/stl/stl.h"
#include "io/usd/usd.h"
#include "scene/legacy.h"
#include "scene/origin.h"
#include "scene/unseen.h"

/* Reads STL or PLY from bytes. folder: of the file; NULL: from memory. */
static facet_result load_bytes(model_kind kind, const void *bytes, size_t size, const char *name,
                               const char *folder, const facet_scene_desc *desc, facet_scene **scene,
                               facet_error *error)
{
    return kind == MODEL_STL ? stl_load_memory(bytes, size, name, desc, scene, error)
                             : ply_load_memory(bytes, size, name, folder, desc, scene, error);
}

/* The same from an open file, which the scene records. */
static facet_result load_open(model_kind kind, const file_bytes *file, const char *path,
                              const facet_scene_desc *desc, facet_scene **scene, facet_error *error)
{
    char *folder = path_folder(&desc->allocator, path);
    facet_result result = folder ? load_bytes(kind, file->data, file->size, path, folder, desc, scene, error)
                                 : fail_memory(error, "path", strlen(path));
    if (result == FACET_OK && !scene_note_file(*scene, file, path)) {
        scene_destroy(*scene);
        *scene = NULL;
        result = fail_memory(error, "files", sizeof *file);
    }
    mem_free(folder);
    return result;
}

/* An empty file is left to the glTF reader, which reports it. */
static bool is_refused(model_kind kind, size_t size)
{
    return kind == MODEL_FOREIGN || (kind == MODEL_UNKNOWN && size > 0);
}

static bool is_url(const char *path)
{
    return strncasecmp(path, "http://", 7) == 0 || strncasecmp(path, "https://", 8) == 0;
}

/* The last step after every reader. */
static facet_result settle(facet_result result, const facet_scene_desc *desc, facet_scene **scene,
                           facet_error *error)
{
    if (result == FACET_OK) {
        unseen_tighten_bounds(*scene);
        result = scene_settle_origin(*scene, NULL, &desc->log, error);
    }
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
    *scene = NULL;
    facet_result result = model_file_open(path, desc, &file, error);
    if (result == FACET_ERROR_READ && is_url(path))
        return fail(error, FACET_ERROR_READ,
                    "%s: facet reads files, not URLs; try: curl -sL %s | facet render - -o out.png", path,
                    path);
    if (result != FACET_OK)
        return result;
    model_kind kind = model_kind_detect(file.data, file.size, path);
    bool is_here = true;
    if (is_refused(kind, file.size))
        result = model_kind_refuse(file.data, file.size, path, error);
    else if (kind == MODEL_STL || kind == MODEL_PLY)
        result = load_open(kind, &file, path, desc, scene, error);
    else
        is_here = false;
    file_close(&file);
    if (!is_here) /* these readers open the file themselves */
        result = kind == MODEL_OBJ          ? obj_load(path, desc, scene, error)
                 : kind == MODEL_PARAMETERS ? ogl1_json_load(path, desc, scene, error)
                                            : gltf_load(path, desc, scene, error);
    return settle(result, desc, scene, error);
}

facet_result model_file_load_memory(const void *bytes, size_t size, const char *name,
                                    const facet_scene_desc *desc, facet_scene **scene, facet_error *error)
{
    model_kind kind = model_kind_detect(bytes, size, name);
    facet_result result;
    *scene = NULL;
    if (is_refused(kind, size))
        result = model_kind_refuse(bytes, size, name, error);
    else if (kind == MODEL_STL || kind == MODEL_PLY)
        result = load_bytes(kind, bytes, size, name, NULL, desc, scene, error);
    else
        result = kind == MODEL_OBJ          ? obj_load_memory(bytes, size, name, desc, scene, error)
                 : kind == MODEL_PARAMETERS ? ogl1_json_load_memory(bytes, size, name, desc, scene, error)
                                            : gltf_load_memory(bytes, size, name, desc, scene, error);
    return settle(result, desc, scene, error);
}

facet_result model_file_create(const facet_arrays_desc *arrays, const facet_scene_desc *desc,
                               facet_scene **scene, facet_error *error)
{
    return settle(arrays_load(arrays, desc, scene, error), desc, scene, error);
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
    if (!desc->is_glb && strcasecmp(extension, "usdz") == 0)
        return usdz_save(scene, path, generator, desc, error);
    if (is_obj)
        return obj_save(scene, path, generator, desc, error);
    if (is_parameters)
        return ogl1_json_save(scene, path, generator, desc, error);
    return gltf_save(scene, path, generator, desc, error);
}
