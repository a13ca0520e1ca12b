/* fit_table_packed.c - fit_table.c for browsers, where bytes to download cost more than unpacking. For programs of one thread. */
#include <stdbool.h>

#include "legacy/fit_table.h"

static const unsigned char packed[] = {
#include "legacy_fit_packed.h"
};

const fit_table *fit_table_get(void)
{
    static fit_table table;
    static bool is_unpacked;
    if (!is_unpacked)
        fit_table_read(packed, &table);
    is_unpacked = true;
    return &table;
}
