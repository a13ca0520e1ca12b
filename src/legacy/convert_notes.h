/* convert_notes.h - what a conversion has to say of single materials and of the scene: codes, sentences, and which of
 * them a user hears of while it runs. */
#ifndef LEGACY_CONVERT_NOTES_H
#define LEGACY_CONVERT_NOTES_H

#include "scene/legacy.h"

/* In the order in which the report has them for one material. */
typedef enum note_code {
    NOTE_LEGACY_LIGHT_PI,
    NOTE_COLOR_SPACE_ASSUMED,
    NOTE_DIALECT_GUESSED,
    NOTE_FOG_DROPPED,
    NOTE_POINT_LIGHT_ATTENUATION,
    NOTE_VIEWPOINT_LIGHT,
    NOTE_LIGHT_SIMPLIFIED,
    NOTE_ENERGY_GAIN,
    NOTE_BASE_CLAMPED,
    NOTE_SPECULAR_CLAMPED,
    NOTE_SHININESS_CLAMPED,
    NOTE_LOW_EXPONENT,
    NOTE_HIGHLIGHT_IGNORED,
    NOTE_HUE_LOST,
    NOTE_HUE_KEPT,
    NOTE_METAL_WITHOUT_DIFFUSE,
    NOTE_AMBIENT_DROPPED,
    NOTE_ILLUM_IGNORED,
    NOTE_ILLUM_HONOURED,
    NOTE_MIRROR_IGNORED,
    NOTE_MIRROR_IGNORED_QUIETLY, /* the same code, in the report only */
    NOTE_KS_MAP_USED_AS_SPECULAR,
    NOTE_BLACK_KD_WITH_MAP,
    NOTE_BLACK_KE_WITH_MAP,
    NOTE_ZERO_ALPHA,
    NOTE_TR_AMBIGUOUS,
    NOTE_HALO_DROPPED,
    NOTE_TEXTURE_MISSING,
    NOTE_TEXTURE_OPTION_DROPPED,
    NOTE_TEXTURE_MODE_DROPPED,
    NOTE_TEXTURE_AVERAGED,
    NOTE_SHININESS_SPREAD,
    NOTE_BUMP_AS_NORMAL,
    NOTE_MAP_DROPPED,
    NOTE_SHARPNESS_DROPPED,
    NOTE_UNKNOWN_KEY,
    NOTE_EXTENSION_NOT_WRITTEN,
    NOTE_COUNT
} note_code;

typedef struct note {
    uint32_t material; /* SCENE_NONE: the scene's */
    note_code code;
    const char *text; /* in the scene's arena */
} note;

typedef struct note_list {
    facet_scene *scene;
    note *notes;
    size_t count, capacity;
    bool has_failed; /* no memory */
} note_list;

/* A sentence without the material's name and without a full stop. One per material and code: the first. */
void note_add(note_list *list, uint32_t material, note_code code, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void note_list_destroy(note_list *list);

/* Puts them into out, whose materials are there, and tells log of those that mean that something was lost: one line
 * per code. False: no memory. */
bool note_list_finish(note_list *list, const facet_log *log, scene_conversion *out);

#endif
