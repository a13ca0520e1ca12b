/* ogl1_parameters.h - the parameters of rgl's material3d() by name, for reading and writing. */
#ifndef IO_OGL1_PARAMETERS_H
#define IO_OGL1_PARAMETERS_H

#include "scene/legacy.h"

/* Parameters stored in one member of legacy_material: 3 floats, a float, a bool. */
typedef enum ogl1_kind { OGL1_COLOR, OGL1_NUMBER, OGL1_BOOLEAN } ogl1_kind;
typedef struct ogl1_parameter {
    const char *name;
    ogl1_kind kind;
    size_t offset;
    double minimum, maximum; /* of a number */
} ogl1_parameter;
enum { OGL1_PARAMETER_COUNT = 7 };
extern const ogl1_parameter OGL1_PARAMETERS[OGL1_PARAMETER_COUNT];

/* Numbers of MTL files without a counterpart in rgl: in the member "mtl", by the names of the statements. */
typedef struct ogl1_statement {
    const char *name;
    uint32_t field; /* LEGACY_IOR, .. */
    size_t offset;
    double minimum, maximum;
} ogl1_statement;
enum { OGL1_STATEMENT_COUNT = 9 };
extern const ogl1_statement OGL1_STATEMENTS[OGL1_STATEMENT_COUNT];

/* Names by number, NULL at the end. */
extern const char *const OGL1_TEXTYPES[];    /* legacy_texture_type */
extern const char *const OGL1_TEXMODES[];    /* legacy_texture_mode */
extern const char *const OGL1_MAG_FILTERS[]; /* scene_filter */
extern const char *const OGL1_SIDES[];       /* front, back */
enum { OGL1_FILLED, OGL1_LINES, OGL1_POINTS, OGL1_CULLED };

typedef struct ogl1_min_filter {
    const char *name;
    scene_filter filter;
    scene_mip_filter mip_filter; /* SCENE_MIP_NONE without texmipmap */
} ogl1_min_filter;
enum { OGL1_MIN_FILTER_COUNT = 6 };
extern const ogl1_min_filter OGL1_MIN_FILTERS[OGL1_MIN_FILTER_COUNT];

/* Whether key is a parameter that is used. */
bool ogl1_is_parameter(const char *key);

#endif
