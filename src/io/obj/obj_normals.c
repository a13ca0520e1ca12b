/* obj_normals.c - normals for files without them: where faces are smooth, corners at one position share
 * the sum of their triangles' normals, weighted by the angle at the corner (Thuermer and Wuethrich 1998,
 * "Computing vertex normals from polygonal facets"), which does not depend on how a face is triangulated.
 *
 * A smoothing group smooths across edges, between triangles that continue each other's surface. Sheets are
 * often modeled twice, with opposite windings, in one group: front and back share positions and edges, and
 * their normals would cancel out. */
#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "io/obj/obj_reader.h"
#include "scene/unit.h"

/* Cosine of the angle across which AUTO smooths, 45 degrees. */
static const double CREASE_COSINE = 0.70710678118654752;
/* Cosine of the sharpest fold within a smoothing group, 150 degrees: beyond are the two sides of a sheet,
 * which need not be exactly opposite where their polygons are cut along different diagonals. */
static const double FOLD_COSINE = -0.86602540378443865;
/* Maximum numbers of triangles along one edge that are compared with each other (more than 2 are rare),
 * and of fans at one position. */
enum { MAX_ALONG_EDGE = 8, MAX_FANS = 16 };
enum { BLOCK_GRAIN = 4, FEW_KEYS = 64 };

/* Results of one block of positions. */
typedef struct block {
    float *normals; /* 3 per class */
    size_t count, capacity, base;
} block;

typedef struct making {
    obj_reader *r;
    bool has_angles; /* by angle; otherwise by group, or everything is smooth */
    obj_partition partition;
    block *blocks;
} making;

/* A corner at the current position. */
typedef struct spoke {
    uint32_t corner; /* of the reader */
    uint32_t next;   /* a spoke of the same class; the first refers to itself */
    uint32_t number; /* of the class, in the block */
    float normal[3]; /* unit normal of the triangle; 0: it has no area */
    float angle;     /* rad */
    float fan[3];    /* in the first spoke of a class: the sum of its normals weighted by angle */
} spoke;

/* Scratch arrays of a block. */
typedef struct workspace {
    uint32_t *begins;  /* per position of the block: its spokes */
    uint32_t *corners; /* sorted by position */
    spoke *spokes;     /* of one position */
    uint64_t *keys;    /* two sort keys with indices per spoke, and as many again as scratch space */
    size_t begin_room, corner_room, spoke_room, key_room;
} workspace;

/* ---- triangles ---- */

/* The angle of a sine >= 0 and a cosine, both scaled alike, to 1e-5 (Abramowitz and Stegun 4.4.47): enough
 * for a weight, where atan2() would take most of the time. */
static double angle_of(double sine, double cosine)
{
    double c = fabs(cosine);
    double t = sine < c ? sine / c : c / sine;
    double t2 = t * t;
    double angle =
        t * (0.9998660 + t2 * (-0.3302995 + t2 * (0.1801410 + t2 * (-0.0851330 + t2 * 0.0208351))));
    angle = sine < c ? angle : 1.57079632679490 - angle;
    return cosine < 0.0 ? 3.14159265358979 - angle : angle;
}

static spoke make_spoke(const obj_reader *r, uint32_t corner, uint32_t number)
{
    static const uint32_t others[3][2] = {{1, 2}, {2, 0}, {0, 1}};
    spoke s = {.corner = corner, .next = number};
    uint32_t place = corner % 3;
    const uint32_t *v = r->v + (corner - place);
    const float *p = r->positions + 3 * (size_t)v[place];
    const float *q = r->positions + 3 * (size_t)v[others[place][0]];
    const float *w = r->positions + 3 * (size_t)v[others[place][1]];
    double a[3];
    double b[3];
    for (int k = 0; k < 3; k++) {
        a[k] = (double)q[k] - (double)p[k];
        b[k] = (double)w[k] - (double)p[k];
    }
    const double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (length > 0.0) {
        double scale = 1.0 / length;
        for (int k = 0; k < 3; k++)
            s.normal[k] = (float)(n[k] * scale);
        s.angle = (float)angle_of(length, a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
    }
    return s;
}

/* ---- classes of spokes ---- */

static uint32_t find_first(spoke *spokes, uint32_t i)
{
    while (spokes[i].next != i) {
        spokes[i].next = spokes[spokes[i].next].next;
        i = spokes[i].next;
    }
    return i;
}

/* The smaller index stays the first, so that classes are in the order of the file. */
static void unite(spoke *spokes, uint32_t a, uint32_t b)
{
    a = find_first(spokes, a);
    b = find_first(spokes, b);
    if (a < b)
        spokes[b].next = a;
    else
        spokes[a].next = b;
}

/* Sorts by the upper halves of the keys, stably. spare: scratch space of the same size for more than
 * FEW_KEYS. */
static void sort_keys(uint64_t *keys, uint64_t *spare, size_t count)
{
    if (count <= FEW_KEYS) { /* the common case: a position has six triangles */
        for (size_t i = 1; i < count; i++) {
            uint64_t key = keys[i];
            size_t k = i;
            for (; k > 0 && keys[k - 1] >> 32 > key >> 32; k--)
                keys[k] = keys[k - 1];
            keys[k] = key;
        }
        return;
    }
    for (int shift = 32; shift < 64; shift += 8) { /* four passes, after which the data is back in place */
        size_t places[256] = {0};
        for (size_t i = 0; i < count; i++)
            places[keys[i] >> shift & 0xffu]++;
        for (size_t digit = 0, sum = 0; digit < 256; digit++) {
            size_t in_digit = places[digit];
            places[digit] = sum;
            sum += in_digit;
        }
        for (size_t i = 0; i < count; i++)
            spare[places[keys[i] >> shift & 0xffu]++] = keys[i];
        uint64_t *swapped = keys;
        keys = spare;
        spare = swapped;
    }
}

static double cosine_between(const spoke *a, const spoke *b)
{
    double cosine = 0.0;
    for (int k = 0; k < 3; k++)
        cosine += (double)a->normal[k] * (double)b->normal[k];
    return cosine;
}

/* Keys of the edges at the position, two per spoke: the position at the other end, then the spoke and the
 * edge's direction. Sorting groups the keys of an edge. */
static void sort_edges(const obj_reader *r, workspace *w, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t corner = w->spokes[i].corner;
        uint32_t first = corner - corner % 3;
        w->keys[2 * i] = (uint64_t)r->v[first + (corner + 1 - first) % 3] << 32 | i << 1;
        w->keys[2 * i + 1] = (uint64_t)r->v[first + (corner + 2 - first) % 3] << 32 | i << 1 | 1u;
    }
    sort_keys(w->keys, w->keys + 2 * (size_t)count, 2 * (size_t)count);
}

static uint32_t spoke_of(uint64_t key)
{
    return (uint32_t)key >> 1;
}

/* Unites spokes whose triangles share an edge at the position and fold little there. */
static void unite_smooth_edges(const obj_reader *r, workspace *w, uint32_t count)
{
    sort_edges(r, w, count);
    for (size_t i = 1; i < 2 * (size_t)count; i++)
        for (size_t k = i; k-- > 0 && i - k < MAX_ALONG_EDGE && w->keys[k] >> 32 == w->keys[i] >> 32;) {
            uint32_t a = spoke_of(w->keys[k]);
            uint32_t b = spoke_of(w->keys[i]);
            if (a != b && cosine_between(&w->spokes[a], &w->spokes[b]) > CREASE_COSINE)
                unite(w->spokes, a, b);
        }
}

/* ---- smoothing groups ---- */

static uint32_t group_of(const obj_reader *r, const spoke *s)
{
    return r->groups ? r->groups[s->corner / 3] : 0;
}

/* The cosine of the fold between the triangles of two keys, if they continue each other: the edge leads to
 * the position in one and away from it in the other, so that they face the same side. Otherwise -1. */
static double continues(const obj_reader *r, const workspace *w, uint64_t a, uint64_t b)
{
    const spoke *s = &w->spokes[spoke_of(a)];
    const spoke *t = &w->spokes[spoke_of(b)];
    bool is_opposite = ((a ^ b) & 1u) != 0 && s != t;
    return is_opposite && group_of(r, s) == group_of(r, t) ? cosine_between(s, t) : -1.0;
}

/* Unites the pair of triangles along one edge that folds least, and removes it from the list. False: there
 * is none. */
static bool unite_best_pair(const obj_reader *r, workspace *w, uint64_t *keys, size_t *count)
{
    double best = FOLD_COSINE;
    size_t first = 0;
    size_t second = 0;
    for (size_t i = 0; i < *count; i++)
        for (size_t k = i + 1; k < *count; k++) {
            double cosine = continues(r, w, keys[i], keys[k]);
            if (cosine > best) {
                best = cosine;
                first = i;
                second = k;
            }
        }
    if (second == 0)
        return false;
    unite(w->spokes, spoke_of(keys[first]), spoke_of(keys[second]));
    size_t left = 0;
    for (size_t i = 0; i < *count; i++)
        if (i != first && i != second)
            keys[left++] = keys[i];
    *count = left;
    return true;
}

/* Whether two fans of a group bend less than AUTO smooths. */
static bool are_alike(const obj_reader *r, const spoke *a, const spoke *b)
{
    double dot = 0.0;
    double lengths[2] = {0.0, 0.0};
    for (int k = 0; k < 3; k++) {
        dot += (double)a->fan[k] * (double)b->fan[k];
        lengths[0] += (double)a->fan[k] * (double)a->fan[k];
        lengths[1] += (double)b->fan[k] * (double)b->fan[k];
    }
    return group_of(r, a) == group_of(r, b) && dot > CREASE_COSINE * sqrt(lengths[0] * lengths[1]);
}

/* Smooths fans that share no edge, as at T-junctions, if they bend little. */
static void unite_fans(const obj_reader *r, spoke *spokes, uint32_t count)
{
    uint32_t leaders[MAX_FANS];
    size_t leader_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        spoke *first = &spokes[find_first(spokes, i)];
        for (size_t k = 0; k < 3; k++)
            first->fan[k] += spokes[i].angle * spokes[i].normal[k];
    }
    for (uint32_t i = 0; i < count; i++) {
        size_t k = 0;
        if (spokes[i].next != i)
            continue;
        while (k < leader_count && !are_alike(r, &spokes[leaders[k]], &spokes[i]))
            k++;
        if (k < leader_count)
            unite(spokes, leaders[k], i);
        else if (leader_count < MAX_FANS)
            leaders[leader_count++] = i;
    }
}

/* Pairs the triangles along each edge, so that two sheets that cross there stay separate. */
static void unite_groups(const obj_reader *r, workspace *w, uint32_t count)
{
    size_t end;
    sort_edges(r, w, count);
    for (size_t begin = 0; begin < 2 * (size_t)count; begin = end) {
        end = begin + 1;
        while (end < 2 * (size_t)count && end - begin < MAX_ALONG_EDGE &&
               w->keys[end] >> 32 == w->keys[begin] >> 32)
            end++;
        size_t left = end - begin;
        while (left > 1 && unite_best_pair(r, w, w->keys + begin, &left))
            continue;
    }
    unite_fans(r, w->spokes, count);
}

/* ---- sums ---- */

/* The unit normals of all classes at one position. A class without direction (its triangles have no area,
 * or cancel out) gets the normal of the others, or +Y if they have none. */
static bool sum_classes(const making *m, block *b, spoke *spokes, uint32_t count)
{
    size_t first_class = b->count;
    double total[3] = {0.0, 0.0, 0.0};
    for (uint32_t i = 0; i < count; i++) {
        uint32_t first = find_first(spokes, i);
        if (first == i)
            spokes[i].number = (uint32_t)b->count++;
        else
            spokes[i].number = spokes[first].number;
        m->r->n[spokes[i].corner] = spokes[i].number;
        for (int k = 0; k < 3; k++)
            total[k] += (double)spokes[i].angle * (double)spokes[i].normal[k];
    }
    if (!mem_reserve(m->r->allocator, (void **)&b->normals, &b->capacity, b->count, 3 * sizeof *b->normals))
        return false;
    float *sums = b->normals + 3 * first_class;
    memset(sums, 0, (b->count - first_class) * 3 * sizeof *sums);
    for (uint32_t i = 0; i < count; i++)
        for (size_t k = 0; k < 3; k++)
            b->normals[3 * (size_t)spokes[i].number + k] += spokes[i].angle * spokes[i].normal[k];
    float otherwise[3] = {0.0f, 1.0f, 0.0f};
    unit_from_double(total, otherwise);
    for (size_t i = first_class; i < b->count; i++) {
        float *n = b->normals + 3 * i;
        const float sum[3] = {n[0], n[1], n[2]};
        const double wide[3] = {(double)sum[0], (double)sum[1], (double)sum[2]};
        /* Residue of float sums that cancel out. */
        bool has_direction = fabs(wide[0]) + fabs(wide[1]) + fabs(wide[2]) > 1e-5;
        if (!has_direction || !unit_from_double(wide, n))
            memcpy(n, otherwise, sizeof otherwise);
    }
    return true;
}

static bool do_position(const making *m, block *b, workspace *w, const uint32_t *corners, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        w->spokes[i] = make_spoke(m->r, corners[i], i);
    if (m->has_angles)
        unite_smooth_edges(m->r, w, count);
    else
        unite_groups(m->r, w, count);
    return sum_classes(m, b, w->spokes, count);
}

/* ---- blocks ---- */

/* Sorts the corners of a block by position. Returns the largest number at one position. */
static uint32_t sort_corners(const making *m, const workspace *w, size_t begin, size_t end, uint32_t first_v)
{
    const obj_partition *p = &m->partition;
    size_t width = (size_t)1 << p->shift;
    uint32_t most = 0;
    memset(w->begins, 0, (width + 1) * sizeof *w->begins);
    for (size_t i = begin; i < end; i++)
        w->begins[p->v[p->order[i]] - first_v]++;
    for (size_t v = 0, sum = 0; v <= width; v++) {
        uint32_t count = w->begins[v];
        most = count > most ? count : most;
        w->begins[v] = (uint32_t)sum;
        sum += count;
    }
    for (size_t i = begin; i < end; i++)
        w->corners[w->begins[p->v[p->order[i]] - first_v]++] = p->order[i];
    for (size_t v = width; v > 0; v--) /* from ends back to begins */
        w->begins[v] = w->begins[v - 1];
    w->begins[0] = 0;
    return most;
}

static bool reserve(workspace *w, const facet_allocator *allocator, size_t width, size_t corners)
{
    return mem_reserve(allocator, (void **)&w->begins, &w->begin_room, width + 1, sizeof *w->begins) &&
           mem_reserve(allocator, (void **)&w->corners, &w->corner_room, corners, sizeof *w->corners);
}

static bool do_block(const making *m, workspace *w, uint32_t number)
{
    const obj_partition *p = &m->partition;
    const facet_allocator *allocator = m->r->allocator;
    size_t begin = p->block_begins[number];
    size_t end = p->block_begins[number + 1];
    size_t width = (size_t)1 << p->shift;
    if (begin == end)
        return true;
    if (!reserve(w, allocator, width, end - begin))
        return false;
    uint32_t most = sort_corners(m, w, begin, end, p->v_minimum + (number << p->shift));
    if (!mem_reserve(allocator, (void **)&w->spokes, &w->spoke_room, most, sizeof *w->spokes) ||
        !mem_reserve(allocator, (void **)&w->keys, &w->key_room, most, 4 * sizeof *w->keys))
        return false;
    for (size_t v = 0; v < width; v++) {
        uint32_t count = w->begins[v + 1] - w->begins[v];
        if (count && !do_position(m, &m->blocks[number], w, w->corners + w->begins[v], count))
            return false;
    }
    return true;
}

static void do_blocks(void *context, size_t begin, size_t end)
{
    const making *m = context;
    workspace w = {0};
    for (size_t i = begin; i < end && !atomic_load(&m->r->has_failed); i++)
        if (!do_block(m, &w, (uint32_t)i))
            atomic_store(&m->r->has_failed, true);
    mem_free(w.begins);
    mem_free(w.corners);
    mem_free(w.spokes);
    mem_free(w.keys);
}

/* Indices in the block become indices behind the file's normals. */
static void join_blocks(void *context, size_t begin, size_t end)
{
    const making *m = context;
    const obj_partition *p = &m->partition;
    obj_reader *r = m->r;
    for (size_t i = begin; i < end; i++) {
        const block *b = &m->blocks[i];
        if (b->count)
            memcpy(r->more_normals + 3 * b->base, b->normals, 3 * b->count * sizeof *b->normals);
        for (size_t k = p->block_begins[i]; k < p->block_begins[i + 1]; k++)
            r->n[p->order[k]] += (uint32_t)(r->normal_count + b->base);
    }
}

static bool join(making *m)
{
    obj_reader *r = m->r;
    for (uint32_t i = 0; i < m->partition.block_count; i++) {
        m->blocks[i].base = r->more_normal_count;
        r->more_normal_count += m->blocks[i].count;
    }
    if (r->normal_count + r->more_normal_count >= OBJ_WRONG)
        return obj_fail_limit(r, "normals");
    r->more_normals = mem_alloc(r->allocator, r->more_normal_count, 3 * sizeof *r->more_normals);
    if (!r->more_normals)
        return obj_fail_memory(r, "normals", r->more_normal_count * 3 * sizeof *r->more_normals);
    parallel_for(r->thread_count, m->partition.block_count, 1, join_blocks, m);
    return true;
}

static void make(making *m)
{
    obj_reader *r = m->r;
    obj_partition *p = &m->partition;
    obj_partition_plan(p, 0, r->position_count ? (uint32_t)r->position_count - 1 : 0);
    p->block_begins = mem_zalloc(r->allocator, (size_t)p->block_count + 1, sizeof *p->block_begins);
    m->blocks = mem_zalloc(r->allocator, p->block_count, sizeof *m->blocks);
    if (p->block_begins && m->blocks && obj_partition_run(p, r->thread_count, r->allocator)) {
        parallel_for(r->thread_count, p->block_count, BLOCK_GRAIN, do_blocks, m);
        if (obj_check_memory(r, "normals"))
            join(m);
    } else {
        obj_fail_memory(r, "normals", p->block_count * sizeof *m->blocks);
    }
}

void obj_make_normals(obj_reader *r)
{
    if (!r->n || r->triangle_corner_count == 0 || r->desc->obj_normals == FACET_OBJ_NORMALS_FLAT)
        return;
    making m = {.r = r,
                .has_angles = !r->groups && r->desc->obj_normals != FACET_OBJ_NORMALS_SMOOTH,
                .partition = {.order = r->indices, /* which get their values later */
                              .v = r->v,
                              .end = r->triangle_corner_count,
                              .taken_n = r->n,
                              .groups = r->groups}};
    make(&m);
    for (uint32_t i = 0; m.blocks && i < m.partition.block_count; i++)
        mem_free(m.blocks[i].normals);
    mem_free(m.blocks);
    mem_free(m.partition.block_begins);
    mem_free(r->groups);
    r->groups = NULL;
    if (r->normal_count == 0 && r->more_normal_count == 0) {
        mem_free(r->n);
        r->n = NULL;
    }
}
