/* usdz_zip.h - the container of .usdz files: a zip archive without compression whose files begin at multiples of 64
 * bytes (Pixar, "Usdz File Format Specification"). */
#ifndef IO_USDZ_ZIP_H
#define IO_USDZ_ZIP_H

#include "base/text.h"

enum { USDZ_ALIGNMENT = 64 };

/* Local files, and the directory that follows them. {.files.allocator, .directory.allocator} starts it. */
typedef struct usdz_zip {
    text files, directory;
    unsigned count;
} usdz_zip;

/* Files are below 4 GiB in sum, and names below 64 KiB. */
void usdz_zip_add(usdz_zip *zip, const char *name, const void *bytes, size_t size);
/* Appends the directory to zip->files. False: no memory, or more than 4 GiB. */
bool usdz_zip_finish(usdz_zip *zip);

#endif
