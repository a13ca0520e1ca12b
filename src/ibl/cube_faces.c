/* cube_faces.c - see cube_faces.h. */
#include "ibl/cube_faces.h"

#include <string.h>

#include "base/parallel.h"
#include "base/result.h"

const char *const cube_face_names[6] = {"+X", "-X", "+Y", "-Y", "+Z", "-Z"};

typedef struct decoding {
    cube_face *faces;
    const facet_environment_desc *desc;
} decoding;

static void decode_faces(void *context, size_t begin, size_t end)
{
    const decoding *job = context;
    for (size_t i = begin; i < end; i++) {
        cube_face *f = &job->faces[i];
        image_decode_desc how = environment_decode_desc(job->desc, &f->largest);
        how.thread_count = 1;
        how.note = &f->note;
        f->result = image_decode(f->bytes, f->size, f->name, &how, &f->picture, &f->error);
        if (f->result == FACET_OK && f->picture.width != f->picture.height)
            f->result = fail(&f->error, FACET_ERROR_INVALID, "%s: %u x %u texels: faces of a cube are square",
                             f->name, f->picture.width, f->picture.height);
    }
}

facet_result cube_faces_decode(cube_face faces[6], const facet_environment_desc *desc, facet_error *error)
{
    decoding job = {faces, desc};
    parallel_for(desc->thread_count, 6, 1, decode_faces, &job);
    facet_result result = FACET_OK;
    for (int i = 0; i < 6 && result == FACET_OK; i++) {
        if (faces[i].result != FACET_OK)
            result = fail(error, faces[i].result, "%s", faces[i].error.message);
        else if (faces[i].picture.width != faces[0].picture.width)
            result = fail(error, FACET_ERROR_INVALID, "%s has %u texels along an edge, face +X has %u",
                          faces[i].name, faces[i].picture.width, faces[0].picture.width);
        else if (i == 0 || strcmp(faces[i].note.text, faces[0].note.text) != 0)
            image_note_log(&faces[i].note, faces[i].name, &desc->log); /* alike ones once */
    }
    if (result != FACET_OK)
        cube_faces_destroy(faces);
    return result;
}

void cube_faces_destroy(cube_face faces[6])
{
    for (int i = 0; i < 6; i++)
        image_destroy(&faces[i].picture);
}

static void fill_face(cube *c, uint32_t face, const float *p)
{
    for (int y = 0; y < (int)c->size; y++)
        for (int x = 0; x < (int)c->size; x++, p += 3)
            *cube_texel(c, face, x, y) = (rgbx){p[0], p[1], p[2], 0.0f};
}

facet_result cube_faces_assemble(cube_face faces[6], const facet_allocator *allocator, uint32_t thread_count,
                                 cube *out, environment_repairs *repairs, facet_error *error)
{
    uint64_t face_texels = (uint64_t)faces[0].picture.width * faces[0].picture.width;
    facet_result result = cube_create(faces[0].picture.width, allocator, out, error);
    for (uint32_t i = 0; i < 6 && result == FACET_OK; i++) {
        image rgb = {0};
        result = environment_repair(&faces[i].picture, faces[i].largest, i * face_texels, allocator,
                                    thread_count, &rgb, repairs, error);
        if (result == FACET_OK)
            fill_face(out, i, rgb.pixels);
        image_destroy(&rgb);
    }
    if (result != FACET_OK)
        cube_destroy(out);
    return result;
}

void cube_faces_place(const cube *c, uint64_t place, uint32_t *face, uint32_t *x, uint32_t *y)
{
    *x = (uint32_t)(place % c->size);
    *y = (uint32_t)(place / c->size % c->size);
    *face = (uint32_t)(place / c->size / c->size);
}
