/* mtl.h - MTL files: the materials of OBJ. */
#ifndef IO_MTL_H
#define IO_MTL_H

#include "base/text.h"
#include "scene/legacy.h"

/* Collects the materials of the libraries that an OBJ file names. */
typedef struct mtl_reader mtl_reader;

/* folder: of the OBJ file, which names of libraries and maps start from; NULL: from memory, only desc->root. Files
 * outside the root are not opened. */
facet_result mtl_reader_create(facet_scene *scene, const facet_scene_desc *desc, const char *folder,
                               mtl_reader **out, facet_error *error);
void mtl_reader_destroy(mtl_reader *reader); /* NULL is allowed */
/* The arguments of an mtllib statement: one or more names; names with spaces and Windows paths are found where the
 * literal reading finds no file. One that was read already is not read again. Fails with FACET_ERROR_MEMORY only. */
facet_result mtl_reader_load(mtl_reader *reader, const char *names, size_t length, facet_error *error);
/* After the last statement: warns of libraries that are missing. Where none was read and materials are needed, the one
 * that is named like the OBJ file is read. Fails with FACET_ERROR_MEMORY only. */
facet_result mtl_reader_settle(mtl_reader *reader, bool needs_materials, facet_error *error);
/* A comment of the OBJ file, without its #: the first ones name the program that wrote it. Libraries that name one
 * themselves count more. */
void mtl_reader_hint(mtl_reader *reader, const char *comment, size_t length);
/* A material of that name: the first; SCENE_NONE: none. */
uint32_t mtl_reader_find(mtl_reader *reader, const char *name, size_t length);
/* A material that no library has: appended with the defaults. SCENE_NONE: no memory. */
uint32_t mtl_reader_add(mtl_reader *reader, const char *name, size_t length);
/* Puts materials, textures and images into the scene, and scene->legacy. Images are found, not decoded; a missing one is
 * a warning. */
facet_result mtl_reader_finish(mtl_reader *reader, facet_error *error);

/* What usemtl and newmtl call the materials of a scene: their names where those are plain and no other has them. One
 * block of mem_alloc(); NULL: no memory. */
const char **mtl_names_create(const facet_scene *scene, const facet_allocator *allocator);
/* Text of an MTL file of scene->legacy. image_names: file name per image of the scene, NULL: it is not written. */
void mtl_write(const facet_scene *scene, const char *generator, const char *const *image_names,
               const facet_scene_save_desc *desc, text *out);

#endif
