# Textures need no ray tracer: a library of their own, which tests and benchmarks link alone.
facet_module(texture
    SOURCES texture_pyramid.c texture_reduce.c texture_set.c texture_store.c texture_sample.c
    LINK facet_scene facet_image facet_base m) # of scene, only the names in messages
facet_test(texture_pyramid SOURCES texture_pyramid_test.c LINK facet_texture)
facet_test(texture_sample SOURCES texture_sample_test.c LINK facet_texture)
facet_test(texture_set SOURCES texture_set_test.c LINK facet_texture)
facet_test(texture_store SOURCES texture_store_test.c LINK facet_texture)
