/* astc_shim.cc - see astc_shim.h. Built only with libastcenc. */
#include "image/astc_shim.h"

#include <new>

#include <astcenc.h>

static int get_result(astcenc_error error)
{
    return error == ASTCENC_SUCCESS          ? ASTC_SHIM_OK
           : error == ASTCENC_ERR_OUT_OF_MEM ? ASTC_SHIM_MEMORY
                                             : ASTC_SHIM_FAILED;
}

extern "C" int astc_shim_create(unsigned block_width, unsigned block_height, bool is_srgb,
                                unsigned thread_count, astc_shim **out)
{
    astcenc_context *context = nullptr;
    astcenc_error error = ASTCENC_ERR_OUT_OF_MEM;
    try {
        astcenc_config config;
        error =
            astcenc_config_init(is_srgb ? ASTCENC_PRF_LDR_SRGB : ASTCENC_PRF_LDR, block_width, block_height,
                                1, ASTCENC_PRE_FASTEST, ASTCENC_FLG_DECOMPRESS_ONLY, &config);
        if (error == ASTCENC_SUCCESS)
            error = astcenc_context_alloc(&config, thread_count, &context);
    } catch (const std::bad_alloc &) {
        error = ASTCENC_ERR_OUT_OF_MEM;
    }
    *out = reinterpret_cast<astc_shim *>(context);
    return get_result(error);
}

extern "C" void astc_shim_destroy(astc_shim *s)
{
    if (s)
        astcenc_context_free(reinterpret_cast<astcenc_context *>(s));
}

extern "C" int astc_shim_decode(astc_shim *s, const unsigned char *blocks, size_t size, unsigned width,
                                unsigned height, unsigned char *rgba, unsigned thread)
{
    void *slice = rgba;
    astcenc_image image = {width, height, 1, ASTCENC_TYPE_U8, &slice};
    const astcenc_swizzle swizzle = {ASTCENC_SWZ_R, ASTCENC_SWZ_G, ASTCENC_SWZ_B, ASTCENC_SWZ_A};
    try {
        return get_result(astcenc_decompress_image(reinterpret_cast<astcenc_context *>(s), blocks, size,
                                                   &image, &swizzle, thread));
    } catch (const std::bad_alloc &) {
        return ASTC_SHIM_MEMORY;
    }
}
