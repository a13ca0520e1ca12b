/* codec_throw.cc - exceptions of the C++ libraries in codec modules. Nothing is unwound: the message goes to JavaScript, which
 * leaves the call by an exception of its own and drops the instance of the module with all of its memory. */
#include <cstdlib>
#include <exception>
#include <new>
#include <typeinfo>

extern "C" {

/* Does not return (web/element/codecs.js). */
__attribute__((import_module("env"), import_name("codec_throw"), noreturn)) void
codec_throw(const char *message);

void *__cxa_allocate_exception(size_t size)
{
    void *memory = std::malloc(size);
    if (!memory)
        codec_throw("out of memory");
    return memory;
}

/* All types that these libraries throw have std::exception as their first base. */
[[noreturn]] void __cxa_throw(void *thrown, std::type_info *type, void (*)(void *))
{
    const bool is_memory = *type == typeid(std::bad_alloc);
    codec_throw(is_memory ? "out of memory" : static_cast<std::exception *>(thrown)->what());
}
}
