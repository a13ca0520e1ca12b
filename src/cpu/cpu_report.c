/* cpu_report.c - see cpu_report.h. */
#include "cpu/cpu_report.h"

#include "cpu/embree.h"

const char *cpu_embree_version(void)
{
    return RTC_VERSION_STRING;
}
