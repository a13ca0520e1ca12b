/* skinning.c - morph targets (glTF 2.0 section 3.7.2.2: attributes plus the weighted sum of displacements)
 * and linear blend skinning (section 3.7.3; the transform of the node that has the mesh is ignored). */
#include "scene/deform.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/simd.h"
#include "scene/unit.h"

/* ---- morph targets ---- */

enum { BLOCK = 512 /* vertices whose sums stay in the L1 cache */ };

static uint32_t used_targets(const scene_primitive *primitive, uint32_t weight_count)
{
    return primitive->target_count < weight_count ? primitive->target_count : weight_count;
}

morph_use morph_get_use(const scene_primitive *primitive, const float *weights, uint32_t weight_count)
{
    morph_use use = {false, false, false};
    for (uint32_t i = 0; i < used_targets(primitive, weight_count); i++) {
        const scene_morph_target *target = &primitive->targets[i];
        if (weights[i] == 0.0f)
            continue;
        use.positions |= target->positions != NULL;
        use.normals |= target->normals && primitive->normals;
        use.tangents |= target->tangents && primitive->tangents;
    }
    return use;
}

DISPATCH_AVX2 static void add_scaled(float *restrict out, const float *restrict change, float weight,
                                     size_t count)
{
    for (size_t i = 0; i < count; i++)
        out[i] += weight * change[i];
}

/* Tangents have a fourth number, their displacements do not. */
static void add_scaled_tangents(float *restrict out, const float *restrict change, float weight, size_t count)
{
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < 3; k++)
            out[4 * i + k] += weight * change[3 * i + k];
}

static void morph_block(const scene_primitive *primitive, const float *weights, uint32_t target_count,
                        size_t first, size_t count, const vertex_arrays *out)
{
    if (out->positions)
        memcpy(out->positions + 3 * first, primitive->positions + 3 * first, 3 * count * sizeof(float));
    if (out->normals)
        memcpy(out->normals + 3 * first, primitive->normals + 3 * first, 3 * count * sizeof(float));
    if (out->tangents)
        memcpy(out->tangents + 4 * first, primitive->tangents + 4 * first, 4 * count * sizeof(float));
    for (uint32_t i = 0; i < target_count; i++) {
        const scene_morph_target *target = &primitive->targets[i];
        if (weights[i] == 0.0f)
            continue;
        if (out->positions && target->positions)
            add_scaled(out->positions + 3 * first, target->positions + 3 * first, weights[i], 3 * count);
        if (out->normals && target->normals)
            add_scaled(out->normals + 3 * first, target->normals + 3 * first, weights[i], 3 * count);
        if (out->tangents && target->tangents)
            add_scaled_tangents(out->tangents + 4 * first, target->tangents + 3 * first, weights[i], count);
    }
}

void morph_vertices(const scene_primitive *primitive, const float *weights, uint32_t weight_count,
                    size_t begin, size_t end, const vertex_arrays *out)
{
    uint32_t target_count = used_targets(primitive, weight_count);
    for (size_t first = begin; first < end; first += BLOCK)
        morph_block(primitive, weights, target_count, first, end - first < BLOCK ? end - first : BLOCK, out);
}

/* ---- joints ---- */

/* The product a b; components that are not finite become the largest float, which moves vertices with that
 * joint out of the scene, and times a weight of 0 is 0. */
static mat4 multiply_finite(const dmat4 *a, const mat4 *b)
{
    const dmat4 wide = dmat4_from_float(b);
    const dmat4 product = dmat4_multiply(a, &wide);
    mat4 out = mat4_from_double(&product);
    bool is_finite = true;
    for (int i = 0; i < 16; i++)
        is_finite = is_finite && fabs(product.m[i]) <= (double)FLT_MAX;
    for (int i = 0; i < 16 && !is_finite; i++)
        out.m[i] = FLT_MAX;
    return out;
}

/* Sign of the determinant of the upper left 3x3, in double: -1, 0, 1. */
static int handedness(const mat4 *a)
{
    double m[16];
    for (int i = 0; i < 16; i++)
        m[i] = (double)a->m[i];
    double determinant = m[0] * (m[5] * m[10] - m[9] * m[6]) - m[4] * (m[1] * m[10] - m[9] * m[2]) +
                         m[8] * (m[1] * m[6] - m[5] * m[2]);
    return (determinant > 0.0) - (determinant < 0.0);
}

bool skin_pose_create(const scene_skin *skin, hierarchy *h, const facet_allocator *allocator, skin_pose *out)
{
    *out = (skin_pose){.joint_count = skin->joint_count};
    out->matrices = mem_alloc(allocator, (size_t)skin->joint_count + 1, sizeof *out->matrices);
    if (!out->matrices)
        return false;
    const mat4 identity = mat4_identity();
    long balance = 0;
    for (uint32_t i = 0; i < skin->joint_count; i++) {
        const mat4 *bind = skin->inverse_bind ? &skin->inverse_bind[i] : &identity;
        const dmat4 world = hierarchy_world(h, skin->joints[i]);
        out->matrices[i] = multiply_finite(&world, bind);
        balance += handedness(&out->matrices[i]);
    }
    out->matrices[skin->joint_count] = identity;
    out->is_mirrored = balance < 0;
    for (size_t i = 0; i <= skin->joint_count && out->is_mirrored; i++)
        for (int column = 0; column < 4; column++)
            out->matrices[i].m[4 * column] = -out->matrices[i].m[4 * column];
    return true;
}

void skin_pose_destroy(skin_pose *pose)
{
    mem_free(pose->matrices);
    *pose = (skin_pose){0};
}

/* ---- vertices ---- */

typedef float float4 __attribute__((vector_size(16), may_alias));

/* The columns of a matrix as vectors of four. */
typedef struct blended {
    float4 column[4];
} blended;

static inline float4 splat(float x)
{
    return (float4){x, x, x, x};
}

static inline float4 cross4(float4 a, float4 b)
{
    float4 a_yzx = __builtin_shufflevector(a, a, 1, 2, 0, 3);
    float4 a_zxy = __builtin_shufflevector(a, a, 2, 0, 1, 3);
    float4 b_yzx = __builtin_shufflevector(b, b, 1, 2, 0, 3);
    float4 b_zxy = __builtin_shufflevector(b, b, 2, 0, 1, 3);
    return a_yzx * b_zxy - a_zxy * b_yzx;
}

/* The weighted mean of the joints' matrices, divided by the sum of weights, which is 1 up to rounding, so
 * that joints with equal matrices yield that matrix. */
static inline blended blend_matrices(const skin_pose *pose, const uint16_t *joints, const float *weights,
                                     uint32_t influence_count)
{
    blended b = {{{0}, {0}, {0}, {0}}};
    float sum = 0.0f;
    for (uint32_t i = 0; i < influence_count; i++) {
        uint32_t joint = joints[i] < pose->joint_count ? joints[i] : pose->joint_count;
        const float4 *m = (const float4 *)(const void *)pose->matrices[joint].m;
        float4 weight = splat(weights[i]);
        sum += weights[i];
        for (int k = 0; k < 4; k++)
            b.column[k] += weight * m[k];
    }
    if (!(sum > 0.0f)) {
        const float4 *m = (const float4 *)(const void *)pose->matrices[pose->joint_count].m;
        for (int k = 0; k < 4; k++)
            b.column[k] = m[k];
        return b;
    }
    for (int k = 0; k < 4 && sum != 1.0f; k++)
        b.column[k] /= splat(sum);
    return b;
}

/* The cofactor matrix times n, in double, for matrices whose products overflow or underflow float. */
static void turn_normal_slowly(const blended *b, const float n[3], const float otherwise[3], float out[3])
{
    double sum[3] = {0, 0, 0};
    for (int i = 0; i < 3; i++) {
        const float4 u = b->column[(i + 1) % 3];
        const float4 v = b->column[(i + 2) % 3];
        for (int k = 0; k < 3; k++)
            sum[k] += (double)n[i] * ((double)u[(k + 1) % 3] * (double)v[(k + 2) % 3] -
                                      (double)u[(k + 2) % 3] * (double)v[(k + 1) % 3]);
    }
    const float fallback[3] = {otherwise[0], otherwise[1], otherwise[2]};
    if (!unit_from_double(sum, out))
        for (int k = 0; k < 3; k++)
            out[k] = fallback[k];
}

/* Normals are transformed by the cofactor matrix, the inverse transpose times the determinant, which
 * exists for singular matrices as well: its columns are the cross products of the matrix' columns. For a
 * negative determinant it follows the winding of the triangles, as the tangent's w does. */
static inline void turn_normal(const blended *b, const float n[3], const float otherwise[3], float out[3])
{
    float4 v = cross4(b->column[1], b->column[2]) * n[0] + cross4(b->column[2], b->column[0]) * n[1] +
               cross4(b->column[0], b->column[1]) * n[2];
    float length2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    if (!(length2 > 1e-30f && length2 < 1e30f)) {
        turn_normal_slowly(b, n, otherwise, out);
        return;
    }
    float scale = 1.0f / sqrtf(length2);
    for (int k = 0; k < 3; k++)
        out[k] = v[k] * scale;
}

static inline bool move_vertex(const blended *b, const scene_primitive *primitive, const vertex_source *in,
                               size_t i, const vertex_arrays *out)
{
    const float *p = in->positions + 3 * i;
    float4 moved = b->column[0] * p[0] + b->column[1] * p[1] + b->column[2] * p[2] + b->column[3];
    bool is_near = true;
    for (int k = 0; k < 3; k++) {
        out->positions[3 * i + (size_t)k] = moved[k];
        is_near &= fabsf(moved[k]) <= SCENE_FARTHEST;
    }
    if (out->normals)
        turn_normal(b, in->normals + 3 * i, primitive->normals + 3 * i, out->normals + 3 * i);
    if (out->tangents) {
        const float *t = in->tangents + 4 * i;
        float4 turned = b->column[0] * t[0] + b->column[1] * t[1] + b->column[2] * t[2];
        const float v[3] = {turned[0], turned[1], turned[2]};
        out->tangents[4 * i + 3] = t[3];
        unit_or(v, primitive->tangents + 4 * i, out->tangents + 4 * i);
    }
    return is_near;
}

bool skin_vertices(const skin_pose *pose, const scene_primitive *primitive, const vertex_source *in,
                   size_t begin, size_t end, const vertex_arrays *out)
{
    size_t count = primitive->influence_count;
    bool is_near = true;
    for (size_t i = begin; i < end; i++) {
        const uint16_t *joints = primitive->joints + count * i;
        const float *weights = primitive->weights + count * i;
        blended b = count == 4 ? blend_matrices(pose, joints, weights, 4)
                               : blend_matrices(pose, joints, weights, (uint32_t)count);
        is_near &= move_vertex(&b, primitive, in, i, out);
    }
    return is_near;
}
