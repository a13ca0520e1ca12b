/* light_tree.c - see light_tree.h. light_tree_build.c builds the tree. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/simd.h"

#include "path/light_distribution.h"
#include "path/light_tree_nodes.h"

/* The weights of eight children at P; returns their sum. With d to the center of a child and its radius r:
 * intensity f(theta) g(theta_N) / max(d, r)^2, where theta is the angle from its axis, theta_N that from
 * N. The bounds of f and g (Conty Estevez and Kulla 2018, equation 3) reduce the angles by the spread of
 * its normals and by the angle that its sphere subtends, to at least 0. They are exact where they are 0,
 * but far too large for clusters beside P, which would take all samples from those in front of it. So they
 * count for BOUND_SHARE only, and the means for the rest: of g the cosine to the center; of f that of
 * normals whose mean has the length R and which therefore spread by about (1 - R^2) / 3: the mean of a
 * clamped normal distribution, (m + sqrt(m^2 + (1 - R^2) / 4)) / 2 within 10 %. Where P is inside the
 * sphere the center says nothing, and the bounds count alone. */
DISPATCH_AVX2 static float weigh(const light_tree_node *restrict n, const float *restrict P,
                                 const float *restrict N, float facing, float *restrict weights)
{
    const float px = P[0];
    const float py = P[1];
    const float pz = P[2];
    const float nx = N[0];
    const float ny = N[1];
    const float nz = N[2];
    for (int i = 0; i < WIDTH; i++) { /* no branches: it vectorises */
        float x = n->x[i] - px;
        float y = n->y[i] - py;
        float z = n->z[i] - pz;
        float d2 = x * x + y * y + z * z + 1e-30f;
        float per_d2 = 1.0f / d2;
        float per_d = sqrtf(per_d2);
        float sin_u = n->radius[i] * per_d;
        float outside = 1.0f - sin_u * sin_u;
        float cos_outside = sqrtf(outside > 0.0f ? outside : 0.0f);
        float cos_u = outside > 0.0f ? cos_outside : -1.0f; /* inside: it surrounds P */

        float front = -(n->axis_x[i] * x + n->axis_y[i] * y + n->axis_z[i] * z);
        float ahead = front * per_d;
        float back = ahead * n->back[i];
        float nearer = ahead > back ? ahead : back;
        float cos_a = nearer < 1.0f ? nearer : 1.0f;
        float sin2_a = 1.0f - cos_a * cos_a;
        float sin_a = sqrtf(sin2_a);
        float cos_less = cos_a * n->cos_spread[i] + sin_a * n->sin_spread[i];
        float sin_less = sin_a * n->cos_spread[i] - cos_a * n->sin_spread[i];
        float cos_b = cos_a >= n->cos_spread[i] ? 1.0f : cos_less;
        float sin_b = cos_a >= n->cos_spread[i] ? 0.0f : sin_less;
        float cos_still_less = cos_b * cos_u + sin_b * sin_u;
        float cos_c = cos_b >= cos_u ? 1.0f : cos_still_less;
        float ramp = (cos_c - n->dark[i]) * n->per_ramp[i];
        float most = ramp < 1.0f ? ramp : 1.0f;
        float emission_most = most > 0.0f ? most : 0.0f;
        float R = n->mean_normal[i];
        float mean = R * cos_a;
        float clamped = 0.5f * (mean + sqrtf(mean * mean + 0.25f * (1.0f - R * R)));
        float known = outside > 0.0f ? emission_most : 0.0f;
        float emission_mean = known > 0.0f ? clamped : emission_most;
        float emission = emission_mean + (emission_most - emission_mean) * n->bound_share[i];
        float shown = front > -n->slack[i] ? n->intensity[i] : 0.0f;

        float cos_n = (nx * x + ny * y + nz * z) * per_d;
        float sin2_n = 1.0f - cos_n * cos_n;
        float sin_n = sqrtf(sin2_n > 0.0f ? sin2_n : 0.0f);
        float cos_n_less = cos_n * cos_u + sin_n * sin_u;
        float bound = cos_n >= cos_u ? 1.0f : cos_n_less;
        float above = cos_n > 0.0f ? cos_n : 0.0f;
        float cosine_mean = outside > 0.0f ? above : bound;
        float part = cosine_mean + (bound - cosine_mean) * BOUND_SHARE;
        float cosine = part > facing ? part : facing;

        float q2 = d2 * n->per_reach2[i];
        float inside = 1.0f - q2 * q2;
        float window = inside > 0.0f ? inside : 0.0f;
        float falloff = per_d2 < n->per_radius2[i] ? per_d2 : n->per_radius2[i];
        weights[i] = shown * emission * cosine * window * falloff;
    }
    float sum = 0.0f;
    for (int i = 0; i < WIDTH; i++)
        sum += weights[i];
    return sum;
}

/* For a view; returns the sum. */
static float weigh_for(const light_tree_view *view, const light_tree_node *node, float weights[WIDTH])
{
    const float P[3] = {view->P[0], view->P[1], view->P[2]};
    const float N[3] = {view->N[0], view->N[1], view->N[2]};
    return weigh(node, P, N, dot(view->N, view->N) > 0.0f ? 0.0f : 1.0f, weights);
}

void light_tree_see(const light_tree *tree, vec3 P, vec3 N, light_tree_view *view)
{
    view->P = P;
    view->N = N;
    view->irradiance = weigh_for(view, &tree->nodes[0], view->root);
}

uint32_t light_tree_sample(const light_tree *tree, const light_tree_view *view, double u, float *probability,
                           double *rest)
{
    const light_tree_node *node = &tree->nodes[0];
    float own[WIDTH];
    const float *weights = view->root;
    float sum = view->irradiance;
    *probability = 1.0f;
    for (;;) {
        if (!(sum > 0.0f))
            return LIGHT_TREE_NONE;
        int found = light_choose(weights, WIDTH, &u);
        *probability *= weights[found] / sum;
        uint32_t child = node->child[found];
        if (child & LEAF) {
            *rest = u;
            return *probability > 0.0f ? child & ~LEAF : LIGHT_TREE_NONE;
        }
        node = &tree->nodes[child];
        sum = weigh_for(view, node, own);
        weights = own;
    }
}

float light_tree_probability(const light_tree *tree, const light_tree_view *view, uint32_t light)
{
    uint32_t trail[MAX_DEPTH];
    int depth = 0;
    for (uint32_t place = tree->places[light]; place != LIGHT_TREE_NONE;
         place = tree->nodes[place / WIDTH].place)
        trail[depth++] = place;
    float probability = 1.0f;
    for (int i = depth - 1; i >= 0; i--) {
        float own[WIDTH];
        const float *weights = view->root;
        float sum = view->irradiance;
        if (i < depth - 1) {
            sum = weigh_for(view, &tree->nodes[trail[i] / WIDTH], own);
            weights = own;
        }
        float weight = weights[trail[i] % WIDTH];
        if (!(weight > 0.0f))
            return 0.0f;
        probability *= weight / sum;
    }
    return probability;
}

void light_tree_destroy(light_tree *tree)
{
    if (!tree)
        return;
    mem_free(tree->nodes);
    mem_free(tree->places);
    mem_free(tree);
}
