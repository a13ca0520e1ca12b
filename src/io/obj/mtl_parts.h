/* mtl_parts.h - what the files of the MTL reader and writer share. */
#ifndef IO_MTL_PARTS_H
#define IO_MTL_PARTS_H

#include "base/index_table.h"
#include "io/obj/mtl.h"
#include "io/uri.h"

/* ---- text ---- */

/* Characters of a file, not terminated. */
typedef struct mtl_span {
    const char *begin, *end;
} mtl_span;

static inline size_t mtl_length(mtl_span s)
{
    return (size_t)(s.end - s.begin);
}
mtl_span mtl_trim(mtl_span s);
/* Takes the next word off the front of *rest; empty: there is none. */
mtl_span mtl_next_word(mtl_span *rest);
bool mtl_is_word(mtl_span s, const char *word); /* ignores case */
/* Parses all of s as a finite number. */
bool mtl_to_number(mtl_span s, double *out);

/* Statements of a file: lines, with continued ones joined, trimmed, not empty. */
typedef struct mtl_lines {
    const char *at, *end;
    size_t line; /* line number where the current line begins */
    size_t next;
    text joined; /* holds a continued line until the next call; text_destroy() at the end */
} mtl_lines;
mtl_lines mtl_lines_begin(const facet_allocator *allocator, const void *bytes, size_t size);
/* False: no more lines, or (joined.has_failed) no memory. */
bool mtl_next_line(mtl_lines *lines, mtl_span *out);

/* ---- materials as they are read ---- */

/* A material with the state of its parser. */
typedef struct mtl_draft {
    legacy_material m;
    text unknown; /* lines for m.unknown */
    bool has_d, has_tr, has_map_d, has_ke;
    float tr;
    bool is_clamped[LEGACY_MAP_COUNT];      /* -clamp on */
    const char *resolved[LEGACY_MAP_COUNT]; /* path whose texture was searched already */
    size_t gltf_line;                       /* line of the comment "#facet-gltf" */
    struct mtl_gltf *gltf;                  /* its contents, if they are to be restored; NULL */
} mtl_draft;

/* Spectra that were read, so that each file is parsed once. {0}: none. */
typedef struct mtl_spectra {
    struct mtl_spectrum *list;
    size_t count, capacity;
    index_table by_file;
} mtl_spectra;
void mtl_spectra_destroy(mtl_spectra *spectra);

/* The state of a parser. */
typedef struct mtl_parser {
    arena *arena; /* for strings */
    const facet_allocator *allocator;
    facet_scene *scene; /* for warnings; NULL: no warnings */
    const facet_log *log;
    const char *file; /* for warnings */
    size_t line;
    bool has_flipped_texcoords, has_srgb_colors;
    bool has_failed; /* no memory */
    /* Opens the file of a spectrum by its name in the library; NULL: no files. Goes with spectra. */
    mtl_spectra *spectra;
    bool (*open)(void *user, const char *name, uri_bytes *out);
    void *user;
} mtl_parser;

mtl_draft mtl_draft_begin(const facet_allocator *allocator);
/* Combines the statements: m is complete afterwards, except for textures. */
void mtl_draft_end(mtl_parser *p, mtl_draft *draft);
/* One statement of a material: all but newmtl and comments. */
void mtl_parse_statement(mtl_parser *p, mtl_span line, mtl_draft *draft);
/* "FILE: line N: ..." */
void mtl_warn(mtl_parser *p, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* A copy in the arena; "" where there is no memory (has_failed). */
const char *mtl_keep(mtl_parser *p, mtl_span s);

/* mtl_values.c: options and name of a map. False: it names no file, which is reported. */
bool mtl_parse_map(mtl_parser *p, const char *keyword, mtl_span arguments, legacy_map *map, bool *is_clamped);
/* Options alone, in the form of legacy_map.options. */
void mtl_parse_options(mtl_parser *p, const char *options, legacy_map *map, bool *is_clamped);

/* r [g b], spectral .., xyz ..; false: a warning gives the reason. */
bool mtl_parse_color(mtl_parser *p, const char *keyword, mtl_span arguments, float out[3]);

/* mtl_dialect.c: evidence for the program that wrote a file. */
typedef struct mtl_clues {
    facet_mtl_dialect obj, mtl; /* AUTO: unknown */
    bool is_old_blender;        /* 2.x, from the comment of the library */
    bool has_odd_shininess;     /* an Ns that Blender 2.7 cannot have written */
} mtl_clues;
void mtl_clues_comment(mtl_clues *clues, mtl_span comment, bool is_obj);
void mtl_clues_shininess(mtl_clues *clues, float shininess);
facet_mtl_dialect mtl_clues_decide(const mtl_clues *clues, bool *is_known);

/* mtl_files.c: files of libraries and maps, textures. */
typedef struct mtl_files {
    file_scope scope;
    struct mtl_image *images; /* all image files that were opened */
    size_t image_count, image_capacity;
    index_table images_by_file;
    uint32_t readable_count; /* readable ones */
    scene_texture *textures;
    size_t texture_count, texture_capacity;
    index_table textures_by_hash;
    bool has_failed;
} mtl_files;

/* Finds the file of a name as libraries write it: below folder ("" or "materials/") or beside the OBJ
 * file. *found: its path below the OBJ file's folder, in the scene's arena. NULL in *found: out->message
 * gives the reason. */
bool mtl_files_open_named(mtl_files *f, const char *folder, const char *name, uri_bytes *out,
                          const char **found);
/* The same, with the base name as the last resort. */
bool mtl_files_open(mtl_files *f, const char *folder, const char *name, uri_bytes *out, const char **found);
/* The index of the image of a name; SCENE_NONE: not readable, which p reports. */
uint32_t mtl_files_image(mtl_files *f, mtl_parser *p, const char *folder, const char *name);
uint32_t
mtl_hash_texture(const scene_texture *texture); /* equal for textures with the same image and sampler */
/* The index of an equal texture, which is added if necessary; SCENE_NONE: no memory. */
uint32_t mtl_files_texture(mtl_files *f, const scene_texture *texture);
/* Puts images and textures into the scene. False: no memory. */
bool mtl_files_finish(mtl_files *f);
void mtl_files_destroy(mtl_files *f);

/* mtl_reader.c: reads a library from memory, as if it were a file of that name beside the OBJ file. */
facet_result mtl_reader_load_bytes(mtl_reader *reader, const char *name, const void *bytes, size_t size,
                                   facet_error *error);

/* mtl_gltf.c: comments "#facet-gltf". */
typedef struct mtl_gltf mtl_gltf; /* parsed comment */
/* Parses the comment and compares it with the statements; its images become textures. NULL: unusable (p
 * reports broken ones), or has_failed. */
mtl_gltf *mtl_gltf_begin(mtl_parser *p, mtl_files *f, const char *folder, const legacy_material *m);
/* Reads the material into *out, after the textures are in the scene. False: broken, *out is unchanged.
 * Releases g. */
bool mtl_gltf_end(mtl_gltf *g, mtl_parser *p, scene_material *out);
void mtl_gltf_destroy(mtl_gltf *g); /* NULL is allowed */
/* Appends the comment's JSON for a material of that name with those statements to out. */
void mtl_gltf_write(const facet_scene *scene, uint32_t material, const char *name, const char *statements,
                    const char *const *image_names, const facet_scene_save_desc *desc, text *out);

#endif
