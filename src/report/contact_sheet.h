/* contact_sheet.h - pictures of one size side by side, with a word below each. */
#ifndef REPORT_CONTACT_SHEET_H
#define REPORT_CONTACT_SHEET_H

#include "film/film.h"

/* See facet_image_create_sheet(). pictures: layer 0 of each, all of the first's size; out: a film with layer 0 only. */
facet_result contact_sheet_create(const film *const *pictures, uint32_t count,
                                  const facet_contact_sheet_desc *desc, film *out, facet_error *error);

#endif
