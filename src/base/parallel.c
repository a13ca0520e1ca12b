/* parallel.c - see parallel.h. Threads are POSIX threads that live for one loop: starting one takes about
 * 20 us, there is no pool to maintain, and ThreadSanitizer sees every hand-over. */
#define _GNU_SOURCE
#include "base/parallel.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdio.h>
#include <unistd.h>

enum { MAX_THREADS = 256 };

typedef struct loop {
    _Atomic size_t next;
    size_t count, grain;
    void (*body)(void *context, size_t begin, size_t end);
    void *context;
} loop;

static void *run_loop(void *argument)
{
    loop *l = argument;
    for (;;) {
        size_t begin = atomic_fetch_add(&l->next, l->grain);
        if (begin >= l->count)
            return NULL;
        size_t end = l->count - begin > l->grain ? begin + l->grain : l->count;
        l->body(l->context, begin, end);
    }
}

void parallel_for(uint32_t thread_count, size_t count, size_t grain,
                  void (*body)(void *context, size_t begin, size_t end), void *context)
{
    if (count == 0)
        return;
    if (grain == 0)
        grain = 1;
    size_t ranges = (count + grain - 1) / grain;
    if (ranges == 1) {
        body(context, 0, count);
        return;
    }
    size_t threads = thread_count ? thread_count : facet_thread_count();
    if (threads > ranges)
        threads = ranges;
    if (threads > MAX_THREADS)
        threads = MAX_THREADS;

    loop l = {.count = count, .grain = grain, .body = body, .context = context};
    pthread_t started[MAX_THREADS];
    size_t started_count = 0;
    while (started_count + 1 < threads && pthread_create(&started[started_count], NULL, run_loop, &l) == 0)
        started_count++;
    run_loop(&l);
    for (size_t i = 0; i < started_count; i++)
        pthread_join(started[i], NULL);
}

/* Threads wait here until all of them have been started. */
typedef struct gate {
    pthread_mutex_t lock;
} gate;

static void *wait_at_gate(void *argument)
{
    gate *g = argument;
    pthread_mutex_lock(&g->lock);
    pthread_mutex_unlock(&g->lock);
    return NULL;
}

uint32_t parallel_startable(uint32_t wanted)
{
    pthread_t started[MAX_THREADS];
    uint32_t count = 0;
    gate g = {.lock = PTHREAD_MUTEX_INITIALIZER};
    if (wanted > MAX_THREADS)
        wanted = MAX_THREADS;
    pthread_mutex_lock(&g.lock);
    while (count < wanted && pthread_create(&started[count], NULL, wait_at_gate, &g) == 0)
        count++;
    pthread_mutex_unlock(&g.lock);
    for (uint32_t i = 0; i < count; i++)
        pthread_join(started[i], NULL);
    pthread_mutex_destroy(&g.lock);
    return count;
}

#ifdef __EMSCRIPTEN__

uint32_t facet_thread_count(void)
{
    return 1; /* threads in a browser need HTTP headers that few servers send */
}

#else

/* The CPU quota of the cgroup (version 2, then 1), rounded up; 0: no limit. */
static uint32_t cgroup_cpus(void)
{
    double quota = 0.0;
    double period = 0.0;
    FILE *file = fopen("/sys/fs/cgroup/cpu.max", "r");
    if (file) {
        if (fscanf(file, "%lf %lf", &quota, &period) != 2)
            quota = 0.0;
        fclose(file);
    } else {
        file = fopen("/sys/fs/cgroup/cpu/cpu.cfs_quota_us", "r");
        if (file) {
            if (fscanf(file, "%lf", &quota) != 1)
                quota = 0.0;
            fclose(file);
        }
        file = fopen("/sys/fs/cgroup/cpu/cpu.cfs_period_us", "r");
        if (file) {
            if (fscanf(file, "%lf", &period) != 1)
                period = 0.0;
            fclose(file);
        }
    }
    if (quota <= 0.0 || period <= 0.0)
        return 0;
    double cpus = quota / period;
    return cpus < 1.0 ? 1 : cpus > MAX_THREADS ? MAX_THREADS : (uint32_t)(cpus + 0.999);
}

uint32_t facet_thread_count(void)
{
    uint32_t count = 0;
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) == 0)
        count = (uint32_t)CPU_COUNT(&set);
    if (count == 0) {
        long online = sysconf(_SC_NPROCESSORS_ONLN);
        count = online > 0 ? (uint32_t)online : 1;
    }
    uint32_t quota = cgroup_cpus();
    if (quota && quota < count)
        count = quota;
    return count < MAX_THREADS ? count : MAX_THREADS;
}

#endif
