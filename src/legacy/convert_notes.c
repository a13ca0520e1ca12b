/* convert_notes.c - see convert_notes.h. */
#include "legacy/convert_notes.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/result.h"

/* Notes of every conversion, and those that readers have logged already, are in the report only. */
static const struct {
    const char *name;
    bool is_warning;
} CODES[NOTE_COUNT] = {
    [NOTE_LEGACY_LIGHT_PI] = {"legacy-light-pi", false},
    [NOTE_COLOR_SPACE_ASSUMED] = {"color-space-assumed", false},
    [NOTE_COLORS_MAY_BE_LINEAR] = {"colors-may-be-linear", true},
    [NOTE_DIALECT_GUESSED] = {"dialect-guessed", false},
    [NOTE_FOG_DROPPED] = {"fog-dropped", true},
    [NOTE_POINT_LIGHT_ATTENUATION] = {"point-light-attenuation", true},
    [NOTE_VIEWPOINT_LIGHT] = {"viewpoint-light", true},
    [NOTE_LIGHT_SIMPLIFIED] = {"light-simplified", true},
    [NOTE_ENERGY_GAIN] = {"energy-gain", false},
    [NOTE_BASE_CLAMPED] = {"base-clamped", true},
    [NOTE_SPECULAR_CLAMPED] = {"specular-clamped", true},
    [NOTE_SHININESS_CLAMPED] = {"shininess-clamped", true},
    [NOTE_LOW_EXPONENT] = {"low-exponent", false},
    [NOTE_HIGHLIGHT_IGNORED] = {"highlight-ignored", true},
    [NOTE_HUE_LOST] = {"hue-lost", true},
    [NOTE_HUE_KEPT] = {"hue-kept", false},
    [NOTE_METAL_WITHOUT_DIFFUSE] = {"metal-without-diffuse", false},
    [NOTE_AMBIENT_DROPPED] = {"ambient-dropped", true},
    [NOTE_ILLUM_IGNORED] = {"illum-ignored", true},
    [NOTE_ILLUM_HONOURED] = {"illum-honoured", false},
    [NOTE_MIRROR_IGNORED] = {"mirror-ignored", true},
    [NOTE_MIRROR_IGNORED_QUIETLY] = {"mirror-ignored", false},
    [NOTE_KS_MAP_USED_AS_SPECULAR] = {"ks-map-used-as-specular", false},
    [NOTE_BLACK_KD_WITH_MAP] = {"black-kd-with-map", true},
    [NOTE_BLACK_KE_WITH_MAP] = {"black-ke-with-map", true},
    [NOTE_ZERO_ALPHA] = {"zero-alpha", true},
    [NOTE_TR_AMBIGUOUS] = {"tr-ambiguous", true},
    [NOTE_HALO_DROPPED] = {"halo-dropped", true},
    [NOTE_TEXTURE_MISSING] = {"texture-missing", false},
    [NOTE_TEXTURE_OPTION_DROPPED] = {"texture-option-dropped", true},
    [NOTE_TEXTURE_MODE_DROPPED] = {"texture-mode-dropped", true},
    [NOTE_TEXTURE_AVERAGED] = {"texture-averaged", true},
    [NOTE_SHININESS_SPREAD] = {"shininess-spread", false},
    [NOTE_BUMP_AS_NORMAL] = {"bump-as-normal", false},
    [NOTE_MAP_DROPPED] = {"map-dropped", true},
    [NOTE_SHARPNESS_DROPPED] = {"sharpness-dropped", false},
    [NOTE_UNKNOWN_KEY] = {"unknown-key", false},
    [NOTE_EXTENSION_NOT_WRITTEN] = {"extension-not-written", true},
};

void note_add(note_list *list, uint32_t material, note_code code, const char *format, ...)
{
    char text[512];
    va_list arguments;
    /* Notes of a material are consecutive. */
    for (size_t i = list->count; i-- > 0 && list->notes[i].material == material;)
        if (list->notes[i].code == code)
            return;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    const char *copy = arena_strdup(list->scene->arena, text);
    if (!copy || !mem_reserve(&list->scene->allocator, (void **)&list->notes, &list->capacity,
                              list->count + 1, sizeof *list->notes)) {
        list->has_failed = true;
        return;
    }
    list->notes[list->count++] = (note){.material = material, .code = code, .text = copy};
}

void note_list_destroy(note_list *list)
{
    mem_free(list->notes);
}

/* Logs "FILE: material "gold" and 3 more: SENTENCE." with the first sentence of a code. */
static void warn_of_code(const note_list *list, note_code code, const facet_log *log)
{
    const note *first = NULL;
    size_t more = 0;
    for (size_t i = 0; i < list->count; i++) {
        if (list->notes[i].code != code)
            continue;
        more += first != NULL;
        first = first ? first : &list->notes[i];
    }
    if (!first)
        return;
    if (first->material == SCENE_NONE) {
        scene_warn(list->scene, log, "%s: %s", list->scene->source, first->text);
        return;
    }
    char others[40] = "";
    if (more > 0)
        snprintf(others, sizeof others, " and %zu more", more);
    scene_warn(list->scene, log, "%s: material \"%s\"%s: %s", list->scene->source,
               list->scene->materials[first->material].name, others, first->text);
}

bool note_list_finish(note_list *list, const facet_log *log, scene_conversion *out)
{
    arena *memory = list->scene->arena;
    if (list->has_failed)
        return false;
    uint32_t *counts = mem_zalloc(&list->scene->allocator, (size_t)out->material_count + 1, sizeof *counts);
    conversion_warning *warnings = arena_alloc(memory, list->count + 1, sizeof *warnings);
    if (!counts || !warnings) {
        mem_free(counts);
        return false;
    }
    /* Counts notes, then distributes them to their materials; those of the scene come last. */
    for (size_t i = 0; i < list->count; i++) {
        uint32_t owner = list->notes[i].material;
        counts[owner == SCENE_NONE ? out->material_count : owner]++;
    }
    size_t begin = 0;
    for (uint32_t i = 0; i <= out->material_count; i++) {
        if (i < out->material_count) {
            out->materials[i].warnings = warnings + begin;
            out->materials[i].warning_count = out->materials[i].summary.warning_count = counts[i];
        } else {
            out->warnings = warnings + begin;
            out->warning_count = counts[i];
        }
        uint32_t count = counts[i];
        counts[i] = (uint32_t)begin;
        begin += count;
    }
    for (int code = 0; code < NOTE_COUNT; code++)
        for (size_t i = 0; i < list->count; i++) {
            const note *n = &list->notes[i];
            if ((int)n->code != code)
                continue;
            uint32_t owner = n->material == SCENE_NONE ? out->material_count : n->material;
            warnings[counts[owner]++] = (conversion_warning){.code = CODES[code].name, .text = n->text};
        }
    mem_free(counts);
    for (int code = 0; code < NOTE_COUNT; code++)
        if (CODES[code].is_warning)
            warn_of_code(list, (note_code)code, log);
    return true;
}
