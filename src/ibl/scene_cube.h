/* scene_cube.h - the cube map of an image-based light of a model (EXT_lights_image_based), decoded.
 *
 * What the file holds: six images of mip 0, +X -X +Y -Y +Z -Z, "standard orientations", "each saved image must be
 * flipped about its vertical axis". Taken by the letter, texel (x, y) of face i is the radiance from the direction of
 * (n - 1 - x, y) on face i of cube.h. Babylon.js, for which the extension was made, looks the images up as they are
 * with the model's X mirrored: but for +X and -X, which change places, the same. Only one of the two is without seams
 * along the edges of a given file's cube, which tells them apart.
 *
 * Texels: JPEG and PNG without alpha carry the sRGB transfer function, as all colors that glTF keeps in such files.
 * PNG with alpha is RGBD: linear color is the decoded one (same transfer function) over alpha. Formats that hold
 * floats are linear as they are. */
#ifndef IBL_SCENE_CUBE_H
#define IBL_SCENE_CUBE_H

#include "ibl/cube_faces.h"
#include "scene/scene.h"

typedef struct scene_cube {
    cube texels;                 /* faces of cube.h, in the frame of the file's light, intensity not in it */
    environment_repairs repairs; /* places as in the files */
    bool is_mirrored;            /* its X is the model's -X: Babylon.js' reading */
} scene_cube;

/* Mip 0 of scene->image_lights[index]. The lower mips are not looked at. FACET_ERROR_READ: an image that is not there;
 * FACET_ERROR_INVALID: faces that are not square or not of one size; and how image_decode() fails. */
facet_result scene_cube_decode(const facet_scene *scene, uint32_t index, const facet_environment_desc *desc,
                               scene_cube *out, facet_error *error);
void scene_cube_destroy(scene_cube *c); /* {0} is allowed; leaves {0} */

/* How badly faces meet: the mean over the texels along edges of |a - b| / (a + b), b across the edge; in [0, 1]. */
double scene_cube_seams(const cube *c);

#endif
