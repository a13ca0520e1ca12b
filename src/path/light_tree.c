/* light_tree.c - see light_tree.h. Making the tree: light_tree_build.c. */
#include <math.h>
#include <string.h>

#include "base/memory.h"

#include "path/light_tree_nodes.h"

/* The bounds of eight children on the irradiance at P; returns their sum. With d to the middle of a child:
 *     intensity f(theta') cos(theta_N') / max(d, radius)^2
 * where theta' is the angle from the axis less the spread and less the angle that the child's sphere is seen under,
 * theta_N' that from N less the latter, both at least 0. Conty Estevez and Kulla 2018, equation 3. */
static float weigh(const light_tree_node *n, vec3 P, vec3 N, bool has_normal, float weights[WIDTH])
{
    float px = P[0];
    float py = P[1];
    float pz = P[2];
    float nx = N[0];
    float ny = N[1];
    float nz = N[2];
    float facing = has_normal ? 0.0f : 1.0f;
    for (int i = 0; i < WIDTH; i++) {
        float x = n->x[i] - px;
        float y = n->y[i] - py;
        float z = n->z[i] - pz;
        float d2 = x * x + y * y + z * z + 1e-30f;
        float r2 = n->radius[i] * n->radius[i];
        float per_d = 1.0f / sqrtf(d2);
        float d = d2 * per_d;
        float sin2_u = r2 < d2 ? r2 / d2 : 1.0f;
        float sin_u = sqrtf(sin2_u);
        float cos_u = r2 < d2 ? sqrtf(1.0f - sin2_u) : -1.0f; /* inside: it is seen all around */

        float front = -(n->axis_x[i] * x + n->axis_y[i] * y + n->axis_z[i] * z);
        float cos_a = front * per_d;
        float back = cos_a * n->back[i];
        cos_a = cos_a > back ? cos_a : back;
        cos_a = cos_a < 1.0f ? cos_a : 1.0f;
        float sin2_a = 1.0f - cos_a * cos_a;
        float sin_a = sqrtf(sin2_a > 0.0f ? sin2_a : 0.0f);
        bool is_in_spread = cos_a >= n->cos_spread[i];
        float cos_b = is_in_spread ? 1.0f : cos_a * n->cos_spread[i] + sin_a * n->sin_spread[i];
        float sin_b = is_in_spread ? 0.0f : sin_a * n->cos_spread[i] - cos_a * n->sin_spread[i];
        float cos_c = cos_b >= cos_u ? 1.0f : cos_b * cos_u + sin_b * sin_u;
        float emission = (cos_c - n->dark[i]) * n->per_ramp[i];
        emission = emission < 1.0f ? emission : 1.0f;
        emission = emission > 0.0f && front > -n->slack[i] ? emission : 0.0f;

        float cos_n = (nx * x + ny * y + nz * z) * per_d;
        float sin2_n = 1.0f - cos_n * cos_n;
        float sin_n = sqrtf(sin2_n > 0.0f ? sin2_n : 0.0f);
        float cosine = cos_n >= cos_u ? 1.0f : cos_n * cos_u + sin_n * sin_u;
        cosine = cosine > facing ? cosine : facing;

        float q = d / n->reach[i];
        float window = 1.0f - q * q * (q * q);
        window = window > 0.0f ? window : 0.0f;
        weights[i] = n->intensity[i] * emission * cosine * window / (d2 > r2 ? d2 : r2);
    }
    float sum = 0.0f;
    for (int i = 0; i < WIDTH; i++)
        sum += weights[i];
    return sum;
}

void light_tree_see(const light_tree *tree, vec3 P, vec3 N, light_tree_view *view)
{
    view->P = P;
    view->N = N;
    view->irradiance = weigh(&tree->nodes[0], P, N, dot(N, N) > 0.0f, view->root);
}

uint32_t light_tree_sample(const light_tree *tree, const light_tree_view *view, double u, float *probability,
                           double *rest)
{
    bool has_normal = dot(view->N, view->N) > 0.0f;
    const light_tree_node *node = &tree->nodes[0];
    float own[WIDTH];
    const float *weights = view->root;
    float sum = view->irradiance;
    *probability = 1.0f;
    for (;;) {
        if (!(sum > 0.0f))
            return LIGHT_TREE_NONE;
        double target = u * (double)sum;
        int found = -1;
        for (int i = 0; i < WIDTH; i++) {
            if (!(weights[i] > 0.0f))
                continue;
            if (found >= 0)
                target -= (double)weights[found];
            found = i;
            if (target < (double)weights[i])
                break;
        }
        u = target / (double)weights[found];
        u = u < 1.0 - 0x1p-53 ? u : 1.0 - 0x1p-53; /* the sum of floats was rounded */
        *probability *= weights[found] / sum;
        uint32_t child = node->child[found];
        if (child & LEAF) {
            *rest = u;
            return child & ~LEAF;
        }
        node = &tree->nodes[child];
        sum = weigh(node, view->P, view->N, has_normal, own);
        weights = own;
    }
}

float light_tree_probability(const light_tree *tree, const light_tree_view *view, uint32_t light)
{
    bool has_normal = dot(view->N, view->N) > 0.0f;
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
            sum = weigh(&tree->nodes[trail[i] / WIDTH], view->P, view->N, has_normal, own);
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
