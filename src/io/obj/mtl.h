/* mtl.h - MTL files: the materials of OBJ. */
#ifndef IO_MTL_H
#define IO_MTL_H

#include "base/text.h"
#include "scene/legacy.h"

/* Collects the materials of the libraries of an OBJ file. */
typedef struct mtl_reader mtl_reader;

/* folder: of the OBJ file, the base of names of libraries and maps; NULL: from memory, only desc->root.
 * Files outside the root are not opened. */
facet_result mtl_reader_create(facet_scene *scene, const facet_scene_desc *desc, const char *folder,
                               mtl_reader **out, facet_error *error);
void mtl_reader_destroy(mtl_reader *reader); /* NULL is allowed */
/* The arguments of an mtllib statement: one or more names; names with spaces and Windows paths are tried
 * where the literal name is no file. A library is read once. Fails with FACET_ERROR_MEMORY only. */
facet_result mtl_reader_load(mtl_reader *reader, const char *names, size_t length, facet_error *error);
/* After the last statement: warns of missing libraries. If none was read and materials are needed, reads
 * the one that is named like the OBJ file. Fails with FACET_ERROR_MEMORY only. */
facet_result mtl_reader_settle(mtl_reader *reader, bool needs_materials, facet_error *error);
/* A comment of the OBJ file, without its #: the first ones name the program that wrote it. Comments in
 * libraries have precedence. */
void mtl_reader_hint(mtl_reader *reader, const char *comment, size_t length);
/* The first material of that name; SCENE_NONE: none. */
uint32_t mtl_reader_find(mtl_reader *reader, const char *name, size_t length);
/* Appends a material that no library has, with default values. SCENE_NONE: no memory. */
uint32_t mtl_reader_add(mtl_reader *reader, const char *name, size_t length);
/* Puts materials, textures and images into the scene, and scene->legacy. Images are located, not decoded;
 * a missing one is reported. */
facet_result mtl_reader_finish(mtl_reader *reader, facet_error *error);

/* Names for usemtl and newmtl: those of the scene's materials, made plain and unique. One block of
 * mem_alloc(); NULL: no memory. */
const char **mtl_names_create(const facet_scene *scene, const facet_allocator *allocator);
/* The text of an MTL file of scene->legacy. image_names: file name per image of the scene, NULL: not
 * written. */
void mtl_write(const facet_scene *scene, const char *generator, const char *const *image_names,
               const facet_scene_save_desc *desc, text *out);

#endif
