/* joining.h - a scene with the contents of another behind its own. */
#ifndef SCENE_JOINING_H
#define SCENE_JOINING_H

#include "scene/scene.h"

/* out becomes `to` with everything of `from` behind its own, except scenes and parts; both stay as they are until
 * the caller copies out. */
typedef struct joining {
    const facet_scene *to, *from;
    facet_scene out;
    struct {
        uint32_t image, texture, material, mesh;
    } shift;     /* of the indices in `from`: how many `to` has before them */
    bool shares; /* these four and the variants are there already, at shift */
    bool grows;  /* more scenes will follow: arrays get space */
    bool lacks_memory;
} joining;

joining joining_begin(const facet_scene *to, const facet_scene *from);
void joining_run(joining *j);

/* ---- arrays in the arena of `to`; NULL, with lacks_memory set: no memory ---- */

void *joining_array(joining *j, size_t count, size_t size);
/* Both arrays in one. */
void *joining_both(joining *j, const void *a, uint32_t a_count, const void *b, uint32_t b_count, size_t size);
/* The same with space behind b from the third part on, so that the time and memory of appending one scene
 * after the other are linear. What is in that space belongs to no scene before the end; a itself stays. */
void *joining_extended(joining *j, const void *a, uint32_t a_count, const void *b, uint32_t b_count,
                       size_t size);
uint32_t joining_shifted(uint32_t index, uint32_t by); /* SCENE_NONE stays */
const uint32_t *joining_list(joining *j, const uint32_t *list, uint32_t count, uint32_t by);

/* Joins an array and its count, and runs the statement behind it for each appended index i. */
#define JOIN(j, array, count, i)                                                                             \
    (j)->out.array = joining_extended(j, (j)->to->array, (j)->to->count, (j)->from->array, (j)->from->count, \
                                      sizeof *(j)->out.array);                                               \
    (j)->out.count = (j)->to->count + (j)->from->count;                                                      \
    for (uint32_t i = (j)->to->count; !(j)->lacks_memory && i < (j)->out.count; i++)

#endif
