/* bake.c - time of baking environments: cube maps by each method, LUTs, spherical harmonics, files.
 *
 *     bake [-n RUNS] [-e] [-b] [ENVIRONMENT]        5 runs; default: a clear sky with its sun, 1024 x 512
 *       -e   error of each cube map against the reference, which takes a while
 *       -b   without the baseline, which takes 10 seconds
 *
 * Wall and CPU seconds are medians, and so is the peak memory of the call's own allocator. Runs alternate
 * between one thread and two. The baseline is the code in the notes on Karis 2013 ("Real Shading in Unreal
 * Engine 4"), in C: for each texel 1024 GGX directions, each looked up in the unfiltered environment, on one
 * thread. Texels of a few rows are computed, and the time is scaled to all. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/clock.h"
#include "facet/facet.h"
#include "median.h"

enum { MAX_RUNS = 101, SAMPLES = 1024 };

static const double pi = 3.14159265358979323846;

static void check(facet_result result, const facet_error *error)
{
    if (result == FACET_OK)
        return;
    fprintf(stderr, "bake: %s\n", error->message);
    exit(1);
}

/* ---- runs ---- */

typedef struct timing {
    double wall[MAX_RUNS], cpu[MAX_RUNS], bytes[MAX_RUNS];
    int count;
} timing;

/* A timed operation; it allocates from allocator. */
typedef struct job {
    void (*run)(const struct job *job, uint32_t thread_count, facet_allocator allocator);
    const char *path; /* of the environment */
    facet_environment *environment;
    facet_bake_desc bake;
    facet_dfg_desc dfg;
    facet_ktx2_desc ktx2;
    const facet_cube *cube;
    uint64_t *samples; /* number drawn; NULL: unknown */
    size_t *bytes;     /* of a file */
} job;

static void time_once(const job *j, uint32_t thread_count, timing *t)
{
    facet_budget *budget = NULL;
    facet_error error;
    check(facet_budget_create(0, &budget, &error), &error);
    double wall = clock_seconds();
    double cpu = cpu_seconds();
    j->run(j, thread_count, facet_budget_allocator(budget));
    t->wall[t->count] = clock_seconds() - wall;
    t->cpu[t->count] = cpu_seconds() - cpu;
    t->bytes[t->count++] = (double)facet_budget_peak_bytes(budget);
    facet_budget_destroy(budget);
}

/* Prints a line; returns CPU seconds of one thread. */
static double time_job(const char *name, const job *j, int runs)
{
    static timing one, two;
    one.count = two.count = 0;
    for (int i = 0; i < runs; i++) {
        time_once(j, 1, &one);
        time_once(j, 2, &two);
    }
    double wall = median(one.wall, runs);
    double cpu = median(one.cpu, runs);
    double wall_two = median(two.wall, runs);
    printf("%-34s %8.3f %8.3f %8.3f %8.3f %7.1f", name, wall, cpu, wall_two, median(two.cpu, runs),
           median(two.bytes, runs) / 1e6);
    if (j->samples && *j->samples)
        printf(" %9.1f %9.1f", (double)*j->samples / cpu * 1e-6, (double)*j->samples / wall_two * 1e-6);
    if (j->bytes)
        printf("   %.2f MB", (double)*j->bytes * 1e-6);
    printf("\n");
    fflush(stdout);
    return cpu;
}

static void print_head(const char *what, bool has_samples)
{
    printf("\n%-34s %8s %8s %8s %8s %7s%s\n", what, "1 wall", "1 cpu", "2 wall", "2 cpu", "MB",
           has_samples ? "    1 cpu    2 wall  M samples/s" : "");
}

/* ---- timed operations ---- */

static void run_bake(const job *j, uint32_t thread_count, facet_allocator allocator)
{
    facet_bake_desc desc = j->bake;
    facet_cube *cube = NULL;
    facet_error error;
    desc.allocator = allocator;
    desc.thread_count = thread_count;
    check(facet_cube_bake(j->environment, &desc, &cube, &error), &error);
    *j->samples = facet_cube_get_stats(cube).samples;
    facet_cube_destroy(cube);
}

static void run_dfg(const job *j, uint32_t thread_count, facet_allocator allocator)
{
    facet_dfg_desc desc = j->dfg;
    facet_image *table = NULL;
    facet_error error;
    desc.allocator = allocator;
    desc.thread_count = thread_count;
    check(facet_dfg_bake(&desc, &table, &error), &error);
    facet_image_destroy(table);
}

static void run_harmonics(const job *j, uint32_t thread_count, facet_allocator allocator)
{
    float coefficients[9][3];
    facet_error error;
    check(facet_environment_project_sh(
              j->environment,
              &(facet_sh_desc){.allocator = allocator, .thread_count = thread_count, .is_windowed = true},
              coefficients, &error),
          &error);
}

static void run_encode(const job *j, uint32_t thread_count, facet_allocator allocator)
{
    facet_ktx2_desc desc = j->ktx2;
    unsigned char *bytes = NULL;
    facet_error error;
    desc.allocator = allocator;
    desc.thread_count = thread_count;
    check(facet_cube_encode_ktx2(j->cube, &desc, &bytes, j->bytes, &error), &error);
    facet_bytes_destroy(bytes);
}

/* From an input file to the bytes of an output file, as in the command. */
static void run_all(const job *j, uint32_t thread_count, facet_allocator allocator)
{
    facet_environment *environment = NULL;
    facet_cube *cube = NULL;
    facet_error error;
    facet_bake_desc bake = j->bake;
    check(facet_environment_load(
              j->path, &(facet_environment_desc){.allocator = allocator, .thread_count = thread_count},
              &environment, &error),
          &error);
    bake.allocator = allocator;
    bake.thread_count = thread_count;
    check(facet_cube_bake(environment, &bake, &cube, &error), &error);
    job encode = *j;
    encode.cube = cube;
    run_encode(&encode, thread_count, allocator);
    facet_cube_destroy(cube);
    facet_environment_destroy(environment);
}

/* ---- the baseline ---- */

typedef struct unfiltered {
    facet_image_view faces[6];
} unfiltered;

static void look_up(const unfiltered *p, const float d[3], float out[3])
{
    float ax = fabsf(d[0]);
    float ay = fabsf(d[1]);
    float az = fabsf(d[2]);
    uint32_t face;
    float s, t, m;
    if (ax >= ay && ax >= az) {
        face = d[0] < 0.0f;
        m = ax;
        s = d[0] < 0.0f ? d[2] : -d[2];
        t = -d[1];
    } else if (ay >= az) {
        face = 2 + (d[1] < 0.0f);
        m = ay;
        s = d[0];
        t = d[1] < 0.0f ? -d[2] : d[2];
    } else {
        face = 4 + (d[2] < 0.0f);
        m = az;
        s = d[2] < 0.0f ? -d[0] : d[0];
        t = -d[1];
    }
    const facet_image_view *f = &p->faces[face];
    float last = (float)f->width - 1.001f;
    float x = fminf(fmaxf((s / m * 0.5f + 0.5f) * (float)f->width - 0.5f, 0.0f), last);
    float y = fminf(fmaxf((t / m * 0.5f + 0.5f) * (float)f->width - 0.5f, 0.0f), last);
    uint32_t x0 = (uint32_t)x;
    uint32_t y0 = (uint32_t)y;
    float wx = x - (float)x0;
    float wy = y - (float)y0;
    const float *a = f->pixels + y0 * (f->row_stride_bytes / sizeof(float)) + 4 * (size_t)x0;
    const float *b = a + f->row_stride_bytes / sizeof(float);
    for (int c = 0; c < 3; c++) {
        float top = a[c] + (a[c + 4] - a[c]) * wx;
        float bottom = b[c] + (b[c + 4] - b[c]) * wx;
        out[c] = top + (bottom - top) * wy;
    }
}

static uint32_t reverse(uint32_t bits)
{
    bits = bits << 16 | bits >> 16;
    bits = (bits & 0x00ff00ffu) << 8 | (bits >> 8 & 0x00ff00ffu);
    bits = (bits & 0x0f0f0f0fu) << 4 | (bits >> 4 & 0x0f0f0f0fu);
    bits = (bits & 0x33333333u) << 2 | (bits >> 2 & 0x33333333u);
    return (bits & 0x55555555u) << 1 | (bits >> 1 & 0x55555555u);
}

static void cross_product(const float a[3], const float b[3], float out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void normalise(float v[3])
{
    float scale = 1.0f / sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++)
        v[i] *= scale;
}

/* ImportanceSampleGGX() of the notes. */
static void sample_GGX(uint32_t i, float a, const float N[3], float H[3])
{
    float phi = 2.0f * (float)pi * (float)i / (float)SAMPLES;
    float v = (float)reverse(i) * 0x1p-32f;
    float cos_theta = sqrtf((1.0f - v) / (1.0f + (a * a - 1.0f) * v));
    float sin_theta = sqrtf(fmaxf(1.0f - cos_theta * cos_theta, 0.0f));
    const float up[3] = {fabsf(N[2]) < 0.999f ? 0.0f : 1.0f, 0.0f, fabsf(N[2]) < 0.999f ? 1.0f : 0.0f};
    float X[3], Y[3];
    cross_product(up, N, X);
    normalise(X);
    cross_product(N, X, Y);
    for (int k = 0; k < 3; k++)
        H[k] = X[k] * sin_theta * cosf(phi) + Y[k] * sin_theta * sinf(phi) + N[k] * cos_theta;
}

/* PrefilterEnvMap() of the notes. */
static void prefilter(const unfiltered *p, float roughness, const float R[3], float out[3])
{
    float total = 0.0f;
    out[0] = out[1] = out[2] = 0.0f;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        float H[3], L[3], light[3];
        sample_GGX(i, roughness * roughness, R, H);
        float VdotH = R[0] * H[0] + R[1] * H[1] + R[2] * H[2];
        for (int k = 0; k < 3; k++)
            L[k] = 2.0f * VdotH * H[k] - R[k];
        float NdotL = R[0] * L[0] + R[1] * L[1] + R[2] * L[2];
        if (NdotL <= 0.0f)
            continue;
        look_up(p, L, light);
        for (int k = 0; k < 3; k++)
            out[k] += light[k] * NdotL;
        total += NdotL;
    }
    for (int k = 0; k < 3; k++)
        out[k] /= total;
}

static void face_direction(uint32_t face, float s, float t, float d[3])
{
    const float directions[6][3] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t},
                                    {s, -1, -t}, {s, -t, 1},  {-s, -t, -1}};
    memcpy(d, directions[face], sizeof directions[face]);
    normalise(d);
}

/* CPU seconds of all levels but the first, which is a copy, extrapolated from every step-th row. */
static double time_baseline(facet_environment *environment, uint32_t size, float *sink)
{
    enum { STEP = 16 };
    facet_bake_desc desc = {.size = size};
    facet_cube *cube = NULL;
    unfiltered p;
    facet_error error;
    check(facet_cube_bake(environment, &desc, &cube, &error), &error);
    for (uint32_t face = 0; face < 6; face++)
        p.faces[face] = facet_cube_get_face(cube, 0, face);
    double all = 0.0;
    for (uint32_t level = 1; level < facet_cube_get_level_count(cube); level++) {
        uint32_t edge = facet_cube_get_size(cube, level);
        uint32_t rows = 0;
        double start = cpu_seconds();
        for (uint32_t face = 0; face < 6; face++)
            for (uint32_t y = face; y < edge; y += STEP, rows++)
                for (uint32_t x = 0; x < edge; x++) {
                    float d[3], out[3];
                    face_direction(face, (2.0f * (float)x + 1.0f) / (float)edge - 1.0f,
                                   (2.0f * (float)y + 1.0f) / (float)edge - 1.0f, d);
                    prefilter(&p, facet_cube_get_roughness(cube, level), d, out);
                    *sink += out[0] + out[1] + out[2];
                }
        all += (cpu_seconds() - start) * 6.0 * edge / rows;
    }
    facet_cube_destroy(cube);
    return all;
}

/* ---- parts ---- */

static void print_errors(facet_environment *environment, const facet_bake_desc *desc)
{
    facet_cube *cube = NULL;
    facet_cube_error errors[FACET_CUBE_MAX_LEVELS];
    facet_error error;
    check(facet_cube_bake(environment, desc, &cube, &error), &error);
    check(facet_cube_verify(cube, environment, desc, errors, &error), &error);
    printf("    RMS error, %% of RMS, from level 0:");
    for (uint32_t level = 0; level < facet_cube_get_level_count(cube); level++)
        printf(" %.3f", 100.0 * errors[level].rms);
    printf("\n");
    facet_cube_destroy(cube);
}

static void time_cubes(facet_environment *environment, int runs, bool has_errors, bool has_baseline)
{
    static const struct {
        uint32_t size, levels;
    } cubes[] = {{256, 0}, {256, 7}, {128, 0}};
    static const struct {
        facet_bake_method method;
        const char *name;
    } methods[] = {{FACET_BAKE_METHOD_AUTO, "auto"}, {FACET_BAKE_METHOD_SAMPLING, "sampling"}};
    double cpu[2][2] = {{0.0}};
    uint64_t samples = 0;
    print_head("GGX cube maps, 1024 samples", true);
    for (int c = 0; c < 3; c++)
        for (int m = 0; m < 2; m++) {
            job j = {.run = run_bake,
                     .environment = environment,
                     .bake = {.size = cubes[c].size,
                              .level_count = cubes[c].levels,
                              .method = methods[m].method,
                              .samples = SAMPLES},
                     .samples = &samples};
            char name[64];
            snprintf(name, sizeof name, "%u, %s levels, %s", cubes[c].size,
                     cubes[c].levels        ? "7"
                     : cubes[c].size == 256 ? "5"
                                            : "4",
                     methods[m].name);
            double one = time_job(name, &j, runs);
            if (!cubes[c].levels)
                cpu[cubes[c].size == 128][m] = one;
            if (has_errors)
                print_errors(environment, &j.bake);
        }
    if (!has_baseline)
        return;
    float sink = 0.0f;
    for (int c = 0; c < 2; c++) {
        double baseline = time_baseline(environment, c ? 128 : 256, &sink);
        printf("%-34s %8s %8.3f   %.1f times auto, %.1f times sampling\n",
               c ? "baseline: the notes' loop, 128" : "baseline: the notes' loop, 256", "", baseline,
               baseline / cpu[c][0], baseline / cpu[c][1]);
    }
    if (!(sink > 0.0f))
        printf("the baseline is black\n");
}

static void time_tables(int runs)
{
    static const struct {
        facet_dfg_kind kind;
        const char *name;
    } kinds[] = {{FACET_DFG_KIND_CORRELATED, "GGX, correlated"},
                 {FACET_DFG_KIND_CHARLIE, "Charlie"},
                 {FACET_DFG_KIND_FILAMENT, "Filament's three channels"}};
    static const uint32_t sizes[] = {128, 512, 1024};
    print_head("tables", false);
    for (int k = 0; k < 3; k++)
        for (int s = 0; s < 3; s++) {
            char name[64];
            snprintf(name, sizeof name, "%s, %u", kinds[k].name, sizes[s]);
            job j = {.run = run_dfg, .dfg = {.kind = kinds[k].kind, .size = sizes[s]}};
            time_job(name, &j, sizes[s] == 128 ? runs : 1);
        }
}

static void time_files(const char *path, facet_environment *environment, int runs)
{
    facet_cube *cube = NULL;
    facet_error error;
    size_t bytes = 0;
    check(facet_cube_bake(environment, NULL, &cube, &error), &error);
    job j = {.run = run_encode, .path = path, .cube = cube, .bytes = &bytes};
    print_head("files: 256, 5 levels, RGBA16F", false);
    time_job("KTX2", &j, runs);
    j.ktx2.zstd_level = 3;
    time_job("KTX2, zstd 3", &j, runs);
    j.ktx2.zstd_level = 19;
    time_job("KTX2, zstd 19", &j, runs);
    if (path) {
        j.run = run_all;
        j.ktx2.zstd_level = 0;
        time_job("from the environment's file", &j, runs);
    }
    facet_cube_destroy(cube);
}

int main(int argc, char **argv)
{
    int runs = 5;
    bool has_errors = false;
    bool has_baseline = true;
    int option = 0;
    while ((option = getopt(argc, argv, "n:eb")) != -1) {
        if (option == 'n')
            runs = atoi(optarg);
        else if (option == 'e')
            has_errors = true;
        else if (option == 'b')
            has_baseline = false;
        else
            return 2;
    }
    runs = runs < 1 ? 1 : runs < MAX_RUNS ? runs : MAX_RUNS;
    const char *path = optind < argc ? argv[optind] : NULL;
    facet_environment *environment = NULL;
    facet_error error;
    check(path ? facet_environment_load(path, NULL, &environment, &error)
               : facet_environment_create_sky(
                     &(facet_sky_desc){.sun_elevation_rad = 0.6f, .illuminance_lux = (float)pi}, NULL,
                     &environment, &error),
          &error);
    printf("%s; medians of %d run%s\n", path ? path : "a clear sky, 1024 x 512", runs, runs > 1 ? "s" : "");
    time_cubes(environment, runs, has_errors, has_baseline);
    time_tables(runs);
    job harmonics = {.run = run_harmonics, .environment = environment};
    print_head("harmonics", false);
    time_job("nine, windowed", &harmonics, runs);
    time_files(path, environment, runs);
    facet_environment_destroy(environment);
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    printf("\nlargest resident size of the process: %ld MB\n", usage.ru_maxrss / 1024);
    return 0;
}
