/* cpu_report.c - see cpu_report.h. */
#include "cpu/cpu_report.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

const char *cpu_embree_version(void)
{
    return RTC_VERSION_STRING;
}
