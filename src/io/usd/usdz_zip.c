/* usdz_zip.c - see usdz_zip.h. PKWARE, "APPNOTE.TXT - .ZIP File Format Specification", sections 4.3.7, 4.3.12, 4.3.16. */
#include "io/usd/usdz_zip.h"

#include <stdint.h>
#include <string.h>

#include "image/deflate.h"

static void put(text *t, uint32_t value, int bytes)
{
    unsigned char little[4];
    for (int i = 0; i < bytes; i++)
        little[i] = (unsigned char)(value >> 8 * i);
    text_add_bytes(t, little, (size_t)bytes);
}

/* What the header of a local file and its entry in the directory have in common. */
static void put_common(text *t, uint32_t crc, uint32_t size, uint32_t name_size, uint32_t extra_size)
{
    put(t, 10, 2);         /* version needed */
    put(t, 0, 2);          /* flags */
    put(t, 0, 2);          /* stored */
    put(t, 0x00210000, 4); /* 1980-01-01 0:00, so that the same scene gives the same bytes */
    put(t, crc, 4);
    put(t, size, 4);
    put(t, size, 4);
    put(t, name_size, 2);
    put(t, extra_size, 2);
}

void usdz_zip_add(usdz_zip *zip, const char *name, const void *bytes, size_t size)
{
    enum { HEADER = 30, EXTRA_HEADER = 4 };
    static const char zeros[USDZ_ALIGNMENT + EXTRA_HEADER] = {0};
    const size_t begin = zip->files.length, name_size = strlen(name);
    const size_t data = begin + HEADER + name_size + EXTRA_HEADER;
    const size_t padding = (USDZ_ALIGNMENT - data % USDZ_ALIGNMENT) % USDZ_ALIGNMENT;
    const uint32_t crc = crc32_checksum(bytes, size);
    put(&zip->files, 0x04034b50, 4);
    put_common(&zip->files, crc, (uint32_t)size, (uint32_t)name_size, (uint32_t)(EXTRA_HEADER + padding));
    text_add(&zip->files, name);
    put(&zip->files, 0x1986, 2); /* an extra field that no reader knows, for the alignment */
    put(&zip->files, (uint32_t)padding, 2);
    text_add_bytes(&zip->files, zeros, padding);
    text_add_bytes(&zip->files, bytes, size);
    put(&zip->directory, 0x02014b50, 4);
    put(&zip->directory, 10, 2); /* version made by */
    put_common(&zip->directory, crc, (uint32_t)size, (uint32_t)name_size, 0);
    put(&zip->directory, 0, 4); /* comment, disk */
    put(&zip->directory, 0, 2); /* internal attributes */
    put(&zip->directory, 0, 4); /* external attributes */
    put(&zip->directory, (uint32_t)begin, 4);
    text_add(&zip->directory, name);
    zip->count++;
}

bool usdz_zip_finish(usdz_zip *zip)
{
    const size_t begin = zip->files.length, size = zip->directory.length;
    text_add_bytes(&zip->files, zip->directory.data, size);
    put(&zip->files, 0x06054b50, 4);
    put(&zip->files, 0, 4); /* disks */
    put(&zip->files, zip->count, 2);
    put(&zip->files, zip->count, 2);
    put(&zip->files, (uint32_t)size, 4);
    put(&zip->files, (uint32_t)begin, 4);
    put(&zip->files, 0, 2); /* comment */
    return !zip->files.has_failed && !zip->directory.has_failed && zip->files.length <= UINT32_MAX;
}
