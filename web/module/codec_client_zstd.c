/* codec_client_zstd.c - ktx2_inflate_zstd() by a call of the function of the same name in the module "zstd". */
#include <stdio.h>

#include "codec_client.h"
#include "image/ktx2.h"

/* in and out are blocks in the module's memory. */
static facet_result inflate(int instance, codec_address in, size_t in_size, codec_address out,
                            size_t out_size, char reason[KTX2_REASON])
{
    const uint32_t arguments[] = {in, (uint32_t)in_size, out, (uint32_t)out_size, 0};
    uint32_t result = FACET_ERROR_INVALID;
    if (!codec_call(instance, "ktx2_inflate_zstd", arguments, 5, &result))
        codec_explain("zstd", instance, reason, KTX2_REASON);
    return (facet_result)result;
}

facet_result ktx2_inflate_zstd(const unsigned char *in, size_t in_size, unsigned char *out, size_t out_size,
                               char reason[KTX2_REASON])
{
    const int instance = codec_open("zstd");
    if (!instance) {
        codec_explain("zstd", 0, reason, KTX2_REASON);
        return FACET_ERROR_UNSUPPORTED;
    }
    const codec_address input = codec_put(instance, in, in_size),
                        output = input ? codec_reserve(instance, out_size) : 0;
    facet_result result = FACET_ERROR_MEMORY;
    if (output)
        result = inflate(instance, input, in_size, output, out_size, reason);
    else
        snprintf(reason, KTX2_REASON, "out of memory for %zu bytes", out_size);
    if (result == FACET_OK)
        codec_get(instance, output, out, out_size);
    codec_release(instance, output);
    codec_release(instance, input);
    codec_close(instance);
    return result;
}
