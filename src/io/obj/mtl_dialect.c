/* mtl_dialect.c - detects the program that wrote a file, from comments and numbers.
 *
 * Blender's older exporter names its version in the OBJ file only ("# Blender v2.79 (sub 0) OBJ File:
 * ''"); its MTL files all begin "# Blender MTL File: '..'". It wrote Ns = (hardness - 1) / 0.51 with an
 * integer hardness up to
 * 2.79, and Ns = (30 (1 - roughness))^2 from 2.80 on: where the version is unknown, an Ns that is not a multiple of 1
 * / 0.51 decides. The exporter of 3.1 and later writes "# Blender 3.3.0 MTL File: '..'" and "# Blender 3.3.0". */
#include <math.h>
#include <string.h>
#include <strings.h>

#include "io/obj/mtl_parts.h"

/* The position behind word in s; NULL: not found. */
static const char *find_word(mtl_span s, const char *word)
{
    size_t length = strlen(word);
    for (const char *c = s.begin; c + length <= s.end; c++)
        if (strncasecmp(c, word, length) == 0)
            return c + length;
    return NULL;
}

/* "2.79 (sub 0)": 279; "3.3.0": 303; 0: no version. */
static int parse_version(const char *at, const char *end)
{
    int parts[2] = {0, 0};
    for (int i = 0; i < 2; i++) {
        int digits = 0;
        for (; at < end && *at >= '0' && *at <= '9' && digits < 3; at++, digits++)
            parts[i] = parts[i] * 10 + (*at - '0');
        if (digits == 0 || (i == 0 && (at == end || *at != '.')))
            return 0;
        at += i == 0;
    }
    return parts[0] * 100 + parts[1];
}

static facet_mtl_dialect dialect_of_blender(mtl_span comment, const char *at)
{
    while (at < comment.end && *at == ' ')
        at++;
    bool is_old_exporter = at < comment.end && *at == 'v';
    int version = parse_version(at + is_old_exporter, comment.end);
    if (version == 0)
        return FACET_MTL_DIALECT_AUTO;
    return version < 280                      ? FACET_MTL_DIALECT_BLENDER27
           : is_old_exporter || version < 300 ? FACET_MTL_DIALECT_BLENDER28
                                              : FACET_MTL_DIALECT_BLENDER3;
}

void mtl_clues_comment(mtl_clues *clues, mtl_span comment, bool is_obj)
{
    facet_mtl_dialect *out = is_obj ? &clues->obj : &clues->mtl;
    if (*out != FACET_MTL_DIALECT_AUTO)
        return;
    const char *blender = find_word(comment, "blender ");
    if (blender) {
        *out = dialect_of_blender(comment, blender);
        clues->is_old_blender |= !is_obj && *out == FACET_MTL_DIALECT_AUTO && find_word(comment, "MTL File");
    } else if (find_word(comment, "obj2gltf")) {
        *out = find_word(comment, "specularGlossiness")  ? FACET_MTL_DIALECT_OBJ2GLTF_SG
               : find_word(comment, "metallicRoughness") ? FACET_MTL_DIALECT_OBJ2GLTF_MR
                                                         : FACET_MTL_DIALECT_AUTO;
    } else if (find_word(comment, "3ds max") || find_word(comment, "assimp") ||
               find_word(comment, "Open Asset Import Library") || find_word(comment, "written by facet")) {
        *out = FACET_MTL_DIALECT_SPEC;
    }
}

void mtl_clues_shininess(mtl_clues *clues, float shininess)
{
    double steps = 0.51 * (double)shininess;
    /* Ns is written with six decimals: half a unit of the last one, and the rounding of the float. */
    clues->has_odd_shininess |= fabs(steps - round(steps)) > 1e-6 + 1e-7 * steps;
}

facet_mtl_dialect mtl_clues_decide(const mtl_clues *clues, bool *is_known)
{
    facet_mtl_dialect dialect = clues->mtl != FACET_MTL_DIALECT_AUTO ? clues->mtl : clues->obj;
    bool is_27_or_28 = dialect == FACET_MTL_DIALECT_BLENDER27 || dialect == FACET_MTL_DIALECT_BLENDER28;
    if (clues->mtl == FACET_MTL_DIALECT_AUTO && clues->is_old_blender && !is_27_or_28)
        dialect = clues->has_odd_shininess ? FACET_MTL_DIALECT_BLENDER28 : FACET_MTL_DIALECT_BLENDER27;
    *is_known = dialect != FACET_MTL_DIALECT_AUTO;
    return *is_known ? dialect : FACET_MTL_DIALECT_SPEC;
}
