/* codec_client.h - calls of codec modules: WebAssembly modules with a memory of their own, which JavaScript has fetched
 * (element/codecs.js). Structs have the same layout there, since the same compiler made them. A module that fails, by an exception
 * of its library or for want of memory, is dropped alone. */
#ifndef WEB_CODEC_CLIENT_H
#define WEB_CODEC_CLIENT_H

#include "facet/facet.h"

/* A pointer in the memory of a module; 0: none. */
typedef uint32_t codec_address;

/* An instance of the module "webp", "draco", ..; 0: codec_explain() has the reason. Closed by codec_close(). */
int codec_open(const char *name);
void codec_close(int instance);

/* A block, and one with a copy of bytes; 0: no memory. Released by codec_release() or with the instance. */
codec_address codec_reserve(int instance, size_t size);
codec_address codec_put(int instance, const void *bytes, size_t size);
void codec_release(int instance, codec_address block);
/* Copy bytes to and from a block. */
void codec_set(int instance, codec_address to, const void *from, size_t size);
void codec_get(int instance, codec_address from, void *to, size_t size);

/* Calls an exported function with count values of 32 bits. *result is 0 for void. False: the instance failed, now or before;
 * codec_explain() has the reason. */
bool codec_call(int instance, const char *name, const uint32_t *values, int count, uint32_t *result);

/* Why the module is missing (instance 0), or has failed. */
void codec_explain(const char *name, int instance, char *text, size_t size);

/* AVIF, which the browser has decoded beforehand. extent: width and height. False: it has not. */
bool codec_find_picture(const void *bytes, size_t size, uint32_t extent[2]);
/* Texels of such an image: 8-bit RGBA, straight alpha. */
void codec_get_picture(const void *bytes, size_t size, void *rgba);
/* Hands an AVIF image to JavaScript, which decodes it when it loads the codec "avif". */
void codec_offer_picture(const void *bytes, size_t size);

#endif
