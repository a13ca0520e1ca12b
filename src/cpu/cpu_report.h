/* cpu_report.h - what the CPU renderers run on, for `facet version -v`. */
#ifndef CPU_CPU_REPORT_H
#define CPU_CPU_REPORT_H

/* "3.13.5": the ray tracing library's version. */
const char *cpu_embree_version(void);

#endif
