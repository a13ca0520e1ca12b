/* report.h - documents about conversions and bakes: an HTML page of converted materials, a sheet about a baked
 * cube map, contact sheets of images. */
#ifndef REPORT_REPORT_H
#define REPORT_REPORT_H

#include "bake/bake.h"
#include "base/text.h"
#include "film/film.h"

/* facet_scene_report_conversion() as HTML: one self-contained file, readable without scripts, in light and
 * dark themes and in print. Materials are sorted by error, worst first; those after REPORT_IMAGES have no
 * images. Fails with FACET_ERROR_MEMORY; without cairo the curves are omitted, and a line says so. */
enum { REPORT_IMAGES = 100 };
facet_result report_html(const facet_scene *scene, text *out, facet_error *error);

/* A sheet for inspecting a baked cube map: its levels, spheres that it lights, and their error. F32 RGBA,
 * display-referred linear, opaque. Without cairo text is omitted, and the log of the environment gets a
 * warning. FACET_ERROR_MEMORY, _CANCELLED. */
facet_result ibl_sheet_draw(const facet_cube *cube_map, const facet_environment *environment,
                            const facet_sheet_desc *desc, image *out, facet_error *error);

/* facet_image_create_sheet(): images of one size in rows, with labels. Layer 0 of each film is used; all have
 * the size of the first; out: a film with layer 0 only. */
facet_result contact_sheet_create(const film *const *films, uint32_t count,
                                  const facet_contact_sheet_desc *desc, film *out, facet_error *error);

#endif
