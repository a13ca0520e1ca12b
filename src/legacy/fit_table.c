/* fit_table.c - see fit_table.h. */
#include "legacy/fit_table.h"

static const fit_table table = {
#include "legacy_fit_table.h"
};

const fit_table *fit_table_get(void)
{
    return &table;
}
