/* ground.h - the shadow on an invisible ground. */
#ifndef SHADE_GROUND_H
#define SHADE_GROUND_H

/* Share of the shadow that is drawn at a place of the image (x and y in [0, 1], in any direction): 0 at the border, so
 * that the image joins a page of its background without a seam, and 1 from a fifth of the image on.
 * C2: no edge of the fade is visible. */
FN float ground_fade(vec2 place)
{
    vec2 inside = clamp(min(place, 1.0f - place) * 5.0f, 0.0f, 1.0f);
    vec2 fade = inside * inside * inside * (10.0f + inside * (6.0f * inside - 15.0f));
    return fade[0] * fade[1];
}

#endif
