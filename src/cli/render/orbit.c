/* orbit.c - camera positions in the notation of <model-viewer>. */
#include "cli/render/orbit.h"

#include "cli/shared/value.h"

#include <math.h>
#include <string.h>
#include <strings.h>

#define DEGREE 0.017453292519943295 /* pi / 180 */

typedef enum part_kind { PART_AUTO, PART_NUMBER } part_kind;

/* One part of the list: a number with its unit, or auto. */
typedef struct part {
    part_kind kind;
    double number;
    char unit[4];
} part;

/* Scans the part at *text and what separates it from the next one. False: no such thing. */
static bool scan_part(const char **text, part *out)
{
    const char *at = *text + strspn(*text, " \t");
    *out = (part){0};
    if (strncasecmp(at, "auto", 4) == 0) {
        at += 4;
    } else {
        out->kind = PART_NUMBER;
        if (!scan_number(&at, &out->number))
            return false;
        size_t length = strcspn(at, ", \t");
        if (length >= sizeof out->unit)
            return false;
        memcpy(out->unit, at, length);
        at += length;
    }
    if (*at && !strchr(", \t", *at))
        return false;
    at += strspn(at, " \t");
    if (*at == ',') {
        at++;
        if (!at[strspn(at, " \t")]) /* nothing behind the comma */
            return false;
    }
    *text = at;
    return true;
}

/* Turns number into rad or m by its unit; a missing one is the first. False: unknown unit. */
static bool to_si(part *p, const char *const *names, const double *factors)
{
    for (int i = 0; names[i]; i++)
        if (strcasecmp(p->unit, names[i]) == 0 || (i == 0 && !p->unit[0])) {
            p->number *= factors[i];
            return true;
        }
    return false;
}

static bool to_radians(part *p)
{
    static const char *const names[] = {"deg", "rad", NULL};
    static const double factors[] = {DEGREE, 1.0};
    return to_si(p, names, factors);
}

static bool to_metres(part *p)
{
    static const char *const names[] = {"m", "cm", "mm", NULL};
    static const double factors[] = {1.0, 1e-2, 1e-3};
    return to_si(p, names, factors);
}

static bool set_radius(part *p, facet_orbit *orbit)
{
    bool is_scale = strcmp(p->unit, "%") == 0;
    if ((!is_scale && !to_metres(p)) || !(p->number > 0.0))
        return false;
    orbit->radius = is_scale ? 0.0f : (float)p->number;
    if (is_scale)
        orbit->radius_scale = (float)(p->number / 100.0);
    return true;
}

bool orbit_parse(const char *text, facet_orbit *orbit)
{
    facet_orbit parsed = *orbit;
    for (int i = 0; i < 3 && (i == 0 || text[strspn(text, " \t")]); i++) {
        part p;
        if (!scan_part(&text, &p))
            return false;
        if (p.kind == PART_AUTO)
            continue;
        if (i < 2 && !to_radians(&p))
            return false;
        if (i == 0)
            parsed.azimuth_rad = (float)remainder(p.number, 360.0 * DEGREE); /* 390deg is 30deg, to the bit */
        else if (i == 1 && p.number >= 0.0 && p.number <= 180.0 * DEGREE)
            parsed.polar_rad = (float)p.number;
        else if (i == 1 || !set_radius(&p, &parsed))
            return false;
    }
    if (text[strspn(text, " \t")])
        return false;
    *orbit = parsed;
    return true;
}

bool target_parse(const char *text, double target[3], bool is_given[3])
{
    if (strcasecmp(text, "auto") == 0) {
        is_given[0] = is_given[1] = is_given[2] = false;
        return true;
    }
    part parts[3];
    for (int i = 0; i < 3; i++)
        if (!scan_part(&text, &parts[i]) || (parts[i].kind == PART_NUMBER && !to_metres(&parts[i])))
            return false;
    if (*text)
        return false;
    for (int i = 0; i < 3; i++) {
        is_given[i] = parts[i].kind == PART_NUMBER;
        if (is_given[i])
            target[i] = parts[i].number;
    }
    return true;
}
