/* astc_shim.cc - see astc_shim.h. Only built where libastcenc is. */
#include "image/astc_shim.h"

#include <new>

#include <astcenc.h>

extern "C" int astc_shim_decode(const unsigned char *blocks, size_t size, unsigned block_width,
                                unsigned block_height, bool is_srgb, unsigned width, unsigned height,
                                unsigned char *rgba)
{
    astcenc_context *context = nullptr;
    astcenc_error error = ASTCENC_ERR_OUT_OF_MEM;
    try {
        astcenc_config config;
        error =
            astcenc_config_init(is_srgb ? ASTCENC_PRF_LDR_SRGB : ASTCENC_PRF_LDR, block_width, block_height,
                                1, ASTCENC_PRE_FASTEST, ASTCENC_FLG_DECOMPRESS_ONLY, &config);
        if (error == ASTCENC_SUCCESS)
            error = astcenc_context_alloc(&config, 1, &context);
        if (error == ASTCENC_SUCCESS) {
            void *slice = rgba;
            astcenc_image image = {width, height, 1, ASTCENC_TYPE_U8, &slice};
            const astcenc_swizzle swizzle = {ASTCENC_SWZ_R, ASTCENC_SWZ_G, ASTCENC_SWZ_B, ASTCENC_SWZ_A};
            error = astcenc_decompress_image(context, blocks, size, &image, &swizzle, 0);
        }
    } catch (const std::bad_alloc &) {
        error = ASTCENC_ERR_OUT_OF_MEM;
    }
    if (context)
        astcenc_context_free(context);
    return error == ASTCENC_SUCCESS          ? ASTC_SHIM_OK
           : error == ASTCENC_ERR_OUT_OF_MEM ? ASTC_SHIM_MEMORY
                                             : ASTC_SHIM_FAILED;
}
