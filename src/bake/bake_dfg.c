/* bake_dfg.c - LUTs of directional albedo over N.V and roughness: a row of quadratures (ibl/dfg_integrate.h)
 * for each roughness. */
#include "bake/bake.h"

#include <assert.h>
#include <stdatomic.h>

#include "base/parallel.h"
#include "base/result.h"
#include "ibl/dfg_integrate.h"

enum { DEFAULT_SIZE = 128, MIN_SIZE = 16, MAX_SIZE = 1024, MAX_CHANNELS = 3 };

/* Properties of each kind. */
static const struct kind {
    uint32_t channel_count;
    bool has_split_sum, has_sheen;
    dfg_masking masking;
} kinds[] = {[FACET_DFG_KIND_SCHLICK] = {2, true, false, DFG_SCHLICK_IBL},
             [FACET_DFG_KIND_CORRELATED] = {2, true, false, DFG_SMITH_CORRELATED},
             [FACET_DFG_KIND_MULTISCATTER] = {2, true, false, DFG_SMITH_CORRELATED},
             [FACET_DFG_KIND_CHARLIE] = {1, false, true, DFG_SMITH_CORRELATED},
             [FACET_DFG_KIND_CHARLIE_NEUBELT] = {1, false, true, DFG_SMITH_CORRELATED},
             [FACET_DFG_KIND_GGX_AVERAGE] = {1, false, false, DFG_SMITH_CORRELATED},
             [FACET_DFG_KIND_FILAMENT] = {3, true, true, DFG_SMITH_CORRELATED}};
enum { KIND_COUNT = sizeof kinds / sizeof *kinds };

uint32_t facet_dfg_get_channel_count(facet_dfg_kind kind)
{
    assert((uint32_t)kind < KIND_COUNT);
    return kinds[kind].channel_count;
}

/* Shared by the threads. */
typedef struct table_job {
    const image *table;
    facet_dfg_kind kind;
    facet_progress progress;
    _Atomic uint32_t done; /* rows */
    atomic_flag is_reporting;
    atomic_bool is_cancelled;
} table_job;

/* One thread reports at a time; the others do not wait. */
static void report_row(table_job *job)
{
    uint32_t done = atomic_fetch_add(&job->done, 1) + 1;
    if (!job->progress.report || atomic_flag_test_and_set(&job->is_reporting))
        return;
    if (!job->progress.report(job->progress.user, "table", (double)done / job->table->height))
        atomic_store(&job->is_cancelled, true);
    atomic_flag_clear(&job->is_reporting);
}

/* Channels of one texel. */
static void fill_node(facet_dfg_kind kind, float roughness, const sheen_nodes *nodes, double NdotV,
                      float out[MAX_CHANNELS])
{
    dfg_terms split = {0.0, 0.0};
    sheen_albedos sheen = {0.0, 0.0};
    if (kinds[kind].has_split_sum)
        split = dfg_integrate(kinds[kind].masking, roughness, NdotV);
    if (kinds[kind].has_sheen)
        sheen = sheen_integrate(nodes, NdotV);
    switch (kind) {
    case FACET_DFG_KIND_SCHLICK:
    case FACET_DFG_KIND_CORRELATED:
        out[0] = (float)split.scale;
        out[1] = (float)split.bias;
        break;
    case FACET_DFG_KIND_FILAMENT:
        out[2] = (float)sheen.neubelt;
        __attribute__((fallthrough));
    case FACET_DFG_KIND_MULTISCATTER:
        out[0] = (float)split.bias;
        out[1] = (float)(split.scale + split.bias);
        break;
    case FACET_DFG_KIND_CHARLIE:
        out[0] = (float)sheen.charlie;
        break;
    case FACET_DFG_KIND_CHARLIE_NEUBELT:
        out[0] = (float)sheen.neubelt;
        break;
    case FACET_DFG_KIND_GGX_AVERAGE: /* fill_rows() */
        break;
    }
}

static void fill_rows(void *context, size_t begin, size_t end)
{
    table_job *job = context;
    uint32_t size = job->table->width;
    uint32_t channels = job->table->channel_count;
    for (size_t y = begin; y < end && !atomic_load_explicit(&job->is_cancelled, memory_order_relaxed); y++) {
        float *row = (float *)job->table->pixels + y * size * channels;
        float roughness = ((float)y + 0.5f) / (float)size;
        float average = 0.0f;
        if (job->kind == FACET_DFG_KIND_GGX_AVERAGE)
            average = (float)dfg_integrate_average(kinds[job->kind].masking, roughness);
        sheen_nodes nodes;
        if (kinds[job->kind].has_sheen)
            sheen_prepare(roughness, &nodes);
        for (uint32_t x = 0; x < size; x++) {
            float node[MAX_CHANNELS] = {average};
            if (job->kind != FACET_DFG_KIND_GGX_AVERAGE)
                fill_node(job->kind, roughness, &nodes, (x + 0.5) / size, node);
            for (uint32_t c = 0; c < channels; c++)
                row[channels * x + c] = node[c];
        }
        report_row(job);
    }
}

facet_result bake_dfg(const facet_dfg_desc *desc, image *out, facet_error *error)
{
    uint32_t size = desc->size ? desc->size : DEFAULT_SIZE;
    if ((uint32_t)desc->kind >= KIND_COUNT)
        return fail(error, FACET_ERROR_ARGUMENT, "dfg: kind %u: 0 to %d were expected", (uint32_t)desc->kind,
                    KIND_COUNT - 1);
    if (size < MIN_SIZE || size > MAX_SIZE)
        return fail(error, FACET_ERROR_ARGUMENT, "dfg: size %u: %d to %d texels were expected", size,
                    MIN_SIZE, MAX_SIZE);
    image table = {0};
    TRY(image_create(&desc->allocator, size, size, kinds[desc->kind].channel_count, IMAGE_F32, &table,
                     error));
    table_job job = {
        .table = &table, .kind = desc->kind, .progress = desc->progress, .is_reporting = ATOMIC_FLAG_INIT};
    parallel_for(desc->thread_count, size, 1, fill_rows, &job);
    if (atomic_load(&job.is_cancelled)) {
        image_destroy(&table);
        return fail(error, FACET_ERROR_CANCELLED, "dfg: cancelled after %u of %u rows", job.done, size);
    }
    *out = table;
    return FACET_OK;
}
