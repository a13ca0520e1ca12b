/* fuzz_cache.c - damaged entries of the cache of prepared environments. */
#include "fuzz_support.h"

#include <string.h>

#include "base/file.h"
#include "ibl/cache.h"
#include "ibl/environment.h"

static char folder[] = "/tmp/facet-fuzz-XXXXXX";
static char entry[256];

static void remove_folder(void)
{
    unlink(entry);
    rmdir(folder);
}

/* The folder and the name of its one entry, found by writing it. */
static void prepare(const facet_environment *environment, uint64_t recipe, float values[16])
{
    static bool is_prepared;
    if (is_prepared)
        return;
    is_prepared = true;
    if (!mkdtemp(folder))
        abort();
    cache_write(environment, "part", recipe, values, 16 * sizeof *values);
    snprintf(entry, sizeof entry, "ls '%s'", folder);
    FILE *list = popen(entry, "r");
    char name[128] = "";
    if (!list || !fgets(name, sizeof name, list) || pclose(list) != 0)
        abort();
    name[strcspn(name, "\n")] = 0;
    snprintf(entry, sizeof entry, "%s/%s", folder, name);
    atexit(remove_folder);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    float values[16] = {0};
    facet_environment environment = {
        .cache_folder = folder, .cache_bytes = 1 << 20, .log = {.message = fuzz_ignore}};
    prepare(&environment, 7, values);
    FILE *file = fopen(entry, "wb");
    if (!file || fwrite(data, 1, size, file) != size || fclose(file) != 0)
        abort();
    cache_read(&environment, "part", 7, values, sizeof values);
    return 0;
}
