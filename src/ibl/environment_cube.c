/* environment_cube.c - environments that are read from cube maps: six files, or one of KTX2. */
#include <assert.h>

#include "base/file.h"
#include "base/result.h"
#include "ibl/cube_faces.h"

/* The environment of faces that were decoded. */
static facet_result take_faces(facet_environment *e, cube_face faces[6], const char *name,
                               const char *const places[6], uint32_t thread_count, facet_error *error)
{
    environment_repairs repairs = {.first = UINT64_MAX};
    facet_result result = cube_faces_assemble(faces, &e->allocator, thread_count, &e->faces, &repairs, error);
    if (result != FACET_OK)
        return result;
    uint32_t face, x, y;
    cube_faces_place(&e->faces, repairs.count ? repairs.first : 0, &face, &x, &y);
    environment_report(e, &repairs, name, places[face], x, y);
    cube_fill_borders(&e->faces);
    e->layout = FACET_LAYOUT_FACES;
    e->source_width = e->source_height = e->faces.size;
    return environment_unroll(e, &e->faces, NULL, thread_count, error);
}

/* ---- KTX2 ---- */

facet_result environment_load_ktx2(facet_environment *e, const ktx2 *k, const facet_environment_desc *desc,
                                   facet_error *error)
{
    static const char *const places[6] = {"face +X", "face -X", "face +Y", "face -Y", "face +Z", "face -Z"};
    cube_face faces[6] = {0};
    ktx2_data data = {0};
    image_decode_desc how = environment_decode_desc(desc, NULL);
    if (k->width > how.max_size)
        return fail(error, FACET_ERROR_LIMIT, "%s: %u x %u texels, more than %u along an edge", k->name,
                    k->width, k->height, how.max_size);
    facet_result result = ktx2_load_level(k, 0, &desc->allocator, &data, error);
    for (uint32_t i = 0; i < 6 && result == FACET_OK; i++) {
        how.largest = &faces[i].largest;
        result = ktx2_decode(k, &data, 0, 0, i, &how, &faces[i].picture, error);
    }
    ktx2_data_destroy(&data);
    if (result == FACET_OK)
        result = take_faces(e, faces, k->name, places, desc->thread_count, error);
    cube_faces_destroy(faces);
    return result;
}

/* ---- six files ---- */

static facet_result load_faces(facet_environment *e, const char *const paths[6],
                               const facet_environment_desc *desc, facet_error *error)
{
    file_bytes files[6] = {{0}};
    cube_face faces[6] = {0};
    facet_result result = FACET_OK;
    for (int i = 0; i < 6 && result == FACET_OK; i++) {
        result = file_open(paths[i],
                           desc->max_file_bytes ? desc->max_file_bytes : environment_default_max_file_bytes,
                           &desc->allocator, &files[i], error);
        faces[i].bytes = files[i].data;
        faces[i].size = files[i].size;
        faces[i].name = paths[i];
    }
    if (result == FACET_OK)
        result = cube_faces_decode(faces, desc, error);
    if (result == FACET_OK)
        result = take_faces(e, faces, "faces", paths, desc->thread_count, error);
    for (int i = 0; i < 6 && result == FACET_OK; i++)
        environment_identify(e, files[i].data, files[i].size);
    cube_faces_destroy(faces);
    for (int i = 0; i < 6; i++)
        file_close(&files[i]);
    return result;
}

facet_result facet_environment_load_faces(const char *const paths[6], const facet_environment_desc *desc,
                                          facet_environment **environment, facet_error *error)
{
    static const facet_environment_desc default_desc;
    assert(paths && environment);
    *environment = NULL;
    desc = desc ? desc : &default_desc;
    facet_environment *e = NULL;
    facet_result result = environment_create(desc, &e, error);
    if (result != FACET_OK)
        return result;
    result = load_faces(e, paths, desc, error);
    if (result == FACET_OK)
        *environment = e;
    else
        environment_release(e);
    return result;
}
