/* environment_share.c - see environment_share.h. */
#define _DEFAULT_SOURCE
#include "cli/shared/environment_share.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { MAX_SHARED = 8, FACES = 6 };

/* A file as it was when it was read. */
typedef struct file_state {
    bool is_there;
    dev_t device;
    ino_t number;
    off_t size;
    struct timespec modified;
} file_state;

typedef struct shared {
    environment_input input; /* with its own path */
    file_state files[FACES];
    facet_environment *environment; /* NULL: taken */
} shared;

/* Written before children are forked; a child changes its own copy. */
static shared table[MAX_SHARED];
static size_t table_count;

static void read_state(const environment_input *input, file_state states[FACES])
{
    for (int i = 0; i < FACES; i++) {
        char path[ENVIRONMENT_PATH_SIZE];
        struct stat info;
        states[i] = (file_state){.is_there = false};
        if (environment_input_get_file(input, i, path) && stat(path, &info) == 0)
            states[i] = (file_state){true, info.st_dev, info.st_ino, info.st_size, info.st_mtim};
    }
}

static bool is_same_state(const file_state *a, const file_state *b)
{
    return a->is_there == b->is_there && a->device == b->device && a->number == b->number &&
           a->size == b->size && a->modified.tv_sec == b->modified.tv_sec &&
           a->modified.tv_nsec == b->modified.tv_nsec;
}

static bool is_same_input(const environment_input *a, const environment_input *b)
{
    if (a->kind != b->kind || !a->path != !b->path || (a->path && strcmp(a->path, b->path) != 0))
        return false;
    return memcmp(a->radiance, b->radiance, sizeof a->radiance) == 0 &&
           memcmp(&a->sky, &b->sky, sizeof a->sky) == 0;
}

static shared *find(const environment_input *input)
{
    file_state now[FACES];
    bool has_state = false;
    for (size_t i = 0; i < table_count; i++) {
        shared *s = &table[i];
        if (!s->environment || !is_same_input(&s->input, input))
            continue;
        if (!has_state)
            read_state(input, now);
        has_state = true;
        bool is_same = true;
        for (int f = 0; f < FACES; f++)
            is_same = is_same && is_same_state(&s->files[f], &now[f]);
        if (is_same)
            return s;
    }
    return NULL;
}

bool environment_share(const environment_input *input, facet_environment *environment)
{
    char *path = input->path ? strdup(input->path) : NULL;
    if (table_count == MAX_SHARED || (input->path && !path)) {
        free(path);
        return false;
    }
    shared *s = &table[table_count++];
    *s = (shared){.input = *input, .environment = environment};
    s->input.path = path;
    read_state(&s->input, s->files);
    return true;
}

facet_environment *environment_share_take(const environment_input *input)
{
    shared *s = find(input);
    facet_environment *environment = s ? s->environment : NULL;
    if (s)
        s->environment = NULL;
    return environment;
}

bool environment_share_has(const environment_input *input)
{
    return find(input) != NULL;
}
