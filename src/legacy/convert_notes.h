/* convert_notes.h - notes of a conversion about materials and the scene: codes, sentences, and which of
 * them are logged as warnings. */
#ifndef LEGACY_CONVERT_NOTES_H
#define LEGACY_CONVERT_NOTES_H

#include "scene/legacy.h"

/* In the order of the report. */
typedef enum note_code {
    NOTE_LEGACY_LIGHT_PI,
    NOTE_COLOR_SPACE_ASSUMED,
    NOTE_COLORS_MAY_BE_LINEAR,
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
    uint32_t material; /* SCENE_NONE: of the scene */
    note_code code;
    const char *text; /* in the scene's arena */
} note;

typedef struct note_list {
    facet_scene *scene;
    note *notes;
    size_t count, capacity;
    bool has_failed; /* out of memory */
} note_list;

/* Adds a sentence without the name of the material and without a full stop. Only the first per material
 * and code is kept. */
void note_add(note_list *list, uint32_t material, note_code code, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void note_list_destroy(note_list *list);

/* Moves the notes into out, whose materials exist, and logs those that report a loss as warnings, one line
 * per code. False: out of memory. */
bool note_list_finish(note_list *list, const facet_log *log, scene_conversion *out);

#endif
