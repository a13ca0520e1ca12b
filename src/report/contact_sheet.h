/* contact_sheet.h - images of one size in rows, with labels. */
#ifndef REPORT_CONTACT_SHEET_H
#define REPORT_CONTACT_SHEET_H

#include "film/film.h"

/* facet_image_create_sheet(). pictures: layer 0 of each is used; all have the size of the first; out: a
 * film with layer 0 only. */
facet_result contact_sheet_create(const film *const *pictures, uint32_t count,
                                  const facet_contact_sheet_desc *desc, film *out, facet_error *error);

#endif
