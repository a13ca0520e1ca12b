/* replay.c - runs a fuzz target on each file of the given folders, in the order of their names: the corpus
 * as a test, without libFuzzer. */
#define _POSIX_C_SOURCE 200809L
#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static int is_file_name(const struct dirent *entry)
{
    return entry->d_name[0] != '.';
}

/* 0: the file could not be read. */
static int replay(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return 0;
    uint8_t *data = NULL;
    size_t size = 0;
    size_t capacity = 0;
    for (size_t got = 1; got; size += got) {
        if (capacity - size < 4096) {
            capacity = capacity * 2 + 8192;
            uint8_t *larger = realloc(data, capacity);
            if (!larger)
                abort();
            data = larger;
        }
        got = fread(data + size, 1, capacity - size, file);
    }
    fclose(file);
    /* a block of the exact size, so that sanitizers detect reads beyond it */
    uint8_t *exact = malloc(size ? size : 1);
    if (!exact)
        abort();
    memcpy(exact, data, size);
    free(data);
    LLVMFuzzerTestOneInput(exact, size);
    free(exact);
    return 1;
}

int main(int argument_count, char **arguments)
{
    int count = 0;
    for (int i = 1; i < argument_count; i++) {
        struct dirent **entries = NULL;
        int entry_count = scandir(arguments[i], &entries, is_file_name, alphasort);
        if (entry_count < 0) {
            fprintf(stderr, "%s: cannot be listed\n", arguments[i]);
            return 1;
        }
        for (int k = 0; k < entry_count; k++) {
            char path[4096];
            snprintf(path, sizeof path, "%s/%s", arguments[i], entries[k]->d_name);
            count += replay(path);
            free(entries[k]);
        }
        free(entries);
    }
    printf("%d files\n", count);
    return count == 0;
}
