/* codec_client.c - see codec_client.h. Module.codecs is an instance of Codecs (element/codecs.js); without one there are no codecs. */
#include "codec_client.h"

#include <emscripten/emscripten.h>

/* clang-format off */
EM_JS(int, codec_open, (const char *name), {
    return Module["codecs"] ? Module["codecs"].open(UTF8ToString(name)) : 0;
})

EM_JS(void, codec_close, (int instance), { Module["codecs"].close(instance); })

EM_JS(void, codec_set, (int instance, codec_address to, const void *from, size_t size), {
    Module["codecs"].memoryOf(instance).set(HEAPU8.subarray(from, from + size), to);
})

EM_JS(void, codec_get, (int instance, codec_address from, void *to, size_t size), {
    HEAPU8.set(Module["codecs"].memoryOf(instance).subarray(from, from + size), to);
})

EM_JS(bool, codec_call, (int instance, const char *name, const uint32_t *values, int count,
                         uint32_t *result), {
    const list = Array.from(HEAPU32.subarray(values >> 2, (values >> 2) + count));
    const returned = Module["codecs"].call(instance, UTF8ToString(name), list);
    if (returned === null) return false;
    HEAPU32[result >> 2] = returned;
    return true;
})

EM_JS(void, codec_explain, (const char *name, int instance, char *text, size_t size), {
    const none = "this page has no decoders";
    stringToUTF8(Module["codecs"] ? Module["codecs"].explain(UTF8ToString(name), instance) : none, text, size);
})

EM_JS(bool, codec_find_picture, (const void *bytes, size_t size, uint32_t *extent), {
    const found = Module["codecs"] ? Module["codecs"].findPicture(HEAPU8.subarray(bytes, bytes + size)) : null;
    if (!found) return false;
    HEAPU32[extent >> 2] = found.width;
    HEAPU32[(extent >> 2) + 1] = found.height;
    return true;
})

EM_JS(void, codec_get_picture, (const void *bytes, size_t size, void *rgba), {
    HEAPU8.set(Module["codecs"].findPicture(HEAPU8.subarray(bytes, bytes + size)).texels, rgba);
})

EM_JS(void, codec_offer_picture, (const void *bytes, size_t size), {
    if (Module["codecs"]) Module["codecs"].offerPicture(HEAPU8.slice(bytes, bytes + size));
})
/* clang-format on */

codec_address codec_reserve(int instance, size_t size)
{
    const uint32_t wanted = (uint32_t)size;
    codec_address block;
    return codec_call(instance, "malloc", &wanted, 1, &block) ? block : 0;
}

codec_address codec_put(int instance, const void *bytes, size_t size)
{
    const codec_address block = codec_reserve(instance, size);
    if (block)
        codec_set(instance, block, bytes, size);
    return block;
}

void codec_release(int instance, codec_address block)
{
    uint32_t nothing;
    if (block)
        codec_call(instance, "free", &block, 1, &nothing);
}
