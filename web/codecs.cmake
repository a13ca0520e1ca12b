# Codec modules: decoders that a page fetches when a file needs them (element/codecs.js). Each is a wasm file without JavaScript
# of its own: facet's codec with its library, whose functions module/codec_client.c calls. A library whose source
# web/sources.sh could not have is left out; without its module such files are refused by name.
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG -fignore-exceptions -D_LIBCPP_ABI_VERSION=2 -Xclang -iwithsysroot/include/compat")

# facet_web_codec(NAME SOURCES file... LIBRARIES target... FUNCTIONS name...): codec_NAME.wasm with these functions.
function(facet_web_codec name)
    cmake_parse_arguments(PARSE_ARGV 1 codec "" "" "SOURCES;LIBRARIES;FUNCTIONS")
    set(target codec_${name})
    add_library(${target}_entry OBJECT ${codec_SOURCES})
    target_link_libraries(${target}_entry PRIVATE codec_base ${codec_LIBRARIES})
    target_compile_definitions(${target}_entry PRIVATE FACET_WITHOUT_EMBREE)
    set(files)
    foreach(library ${codec_LIBRARIES} codec_base libraries)
        list(APPEND files $<TARGET_FILE:${library}>)
    endforeach()
    set(exports)
    foreach(function malloc free ${codec_FUNCTIONS})
        list(APPEND exports "\"_${function}\"")
    endforeach()
    string(REPLACE ";" "," exports "${exports}")
    add_custom_command(OUTPUT ${package}/${target}.wasm VERBATIM COMMAND_EXPAND_LISTS
        DEPENDS ${target}_entry $<TARGET_OBJECTS:${target}_entry> ${codec_LIBRARIES} codec_base libraries
        COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs emcc -O2 -o ${package}/${target}.wasm
            $<TARGET_OBJECTS:${target}_entry> ${files} --no-entry -sSTANDALONE_WASM -sALLOW_MEMORY_GROWTH
            -sTOTAL_STACK=262144 -sINITIAL_MEMORY=4194304 -sMAXIMUM_MEMORY=1073741824 "-sEXPORTED_FUNCTIONS=[${exports}]"
            --js-library ${CMAKE_CURRENT_SOURCE_DIR}/module/codec_throw.js
        COMMENT "Linking ${target}.wasm")
    add_custom_target(${target}_module ALL DEPENDS ${package}/${target}.wasm)
endfunction()

# A library of a source, compiled without warnings.
function(facet_web_library name)
    cmake_parse_arguments(PARSE_ARGV 1 library "" "" "SOURCES;INCLUDES;DEFINITIONS")
    add_library(${name} STATIC EXCLUDE_FROM_ALL ${library_SOURCES})
    target_compile_options(${name} PRIVATE -w)
    target_compile_definitions(${name} PUBLIC ${library_DEFINITIONS})
    target_include_directories(${name} SYSTEM PUBLIC ${library_INCLUDES})
endfunction()

# What facet's codecs use of base and image.
add_library(codec_base STATIC EXCLUDE_FROM_ALL ${root}/src/base/memory.c ${root}/src/base/result.c ${root}/src/base/parallel.c ${root}/src/image/image.c ${root}/src/image/codec_shared.c ${root}/src/image/primaries.c
    ${root}/src/image/srgb.c module/codec_throw.cc)
target_include_directories(codec_base PUBLIC ${root}/include ${root}/src ${root})

# ---- WebP ----

if(EXISTS ${sources}/libwebp)
    file(GLOB webp ${sources}/libwebp/src/dec/*.c ${sources}/libwebp/src/dsp/*.c ${sources}/libwebp/src/utils/*.c)
    facet_web_library(webp SOURCES ${webp} INCLUDES ${sources}/libwebp ${sources}/libwebp/src)
    facet_web_codec(webp SOURCES ${root}/src/image/codec_webp.c LIBRARIES webp FUNCTIONS webp_probe webp_decode image_destroy)
endif()

# ---- Zstandard: the compression of KTX2 files ----

file(GLOB zstd ${sources}/libzstd/lib/common/*.c ${sources}/libzstd/lib/decompress/*.c)
facet_web_library(zstd SOURCES ${zstd} INCLUDES ${sources}/libzstd/lib DEFINITIONS HAVE_ZSTD ZSTD_DISABLE_ASM ZSTD_LEGACY_SUPPORT=0)
facet_web_codec(zstd SOURCES ${root}/src/image/ktx2_zstd.c LIBRARIES zstd FUNCTIONS ktx2_inflate_zstd)

# ---- Draco ----

if(EXISTS ${sources}/draco)
    set(folder ${sources}/draco/src/draco)
    file(GLOB draco ${folder}/attributes/*.cc ${folder}/compression/*.cc ${folder}/compression/*/*.cc
        ${folder}/compression/*/*/*.cc ${folder}/core/*.cc ${folder}/mesh/*.cc ${folder}/metadata/*.cc ${folder}/point_cloud/*.cc)
    list(FILTER draco EXCLUDE REGEX "_test|encod|encode\\.cc|mesh_cleanup|stripifier|draco_test|builder|splitter|scene|texture")
    set(features)
    foreach(feature POINT_CLOUD_COMPRESSION MESH_COMPRESSION NORMAL_ENCODING STANDARD_EDGEBREAKER PREDICTIVE_EDGEBREAKER
            BACKWARDS_COMPATIBILITY)
        string(APPEND features "#define DRACO_${feature}_SUPPORTED\n")
    endforeach()
    file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/config/draco/draco_features.h CONTENT "${features}")
    facet_web_library(draco SOURCES ${draco} INCLUDES ${CMAKE_BINARY_DIR}/config ${sources}/draco/src)
    facet_web_codec(draco SOURCES ${root}/src/io/gltf/draco_shim.cc LIBRARIES draco FUNCTIONS draco_shim_decode draco_shim_destroy
        draco_shim_face_count draco_shim_point_count draco_shim_component_count draco_shim_copy_faces draco_shim_copy_attribute)
endif()

# ---- OpenEXR: the C++ library, since its C core 3.1 does not decode DWA ----

if(EXISTS ${sources}/openexr AND EXISTS ${sources}/imath)
    set(config ${CMAKE_BINARY_DIR}/config/openexr)
    foreach(library IEX ILMTHREAD IMATH OPENEXR)
        set(${library}_NAMESPACE_CUSTOM 0)
    endforeach()
    set(IEX_NAMESPACE Iex)
    set(IEX_INTERNAL_NAMESPACE Iex)
    set(ILMTHREAD_NAMESPACE IlmThread)
    set(ILMTHREAD_INTERNAL_NAMESPACE IlmThread)
    set(IMATH_NAMESPACE Imath)
    set(IMATH_INTERNAL_NAMESPACE Imath)
    set(OPENEXR_IMF_NAMESPACE Imf)
    set(OPENEXR_INTERNAL_IMF_NAMESPACE Imf)
    foreach(library OpenEXR Imath)
        set(${library}_VERSION_MAJOR 3)
        set(${library}_VERSION_MINOR 1)
        set(${library}_VERSION_PATCH 0)
    endforeach()
    set(ILMTHREAD_THREADING_ENABLED 0)
    set(IMATH_USE_NOEXCEPT 1)
    foreach(file IexConfig IexConfigInternal IlmThreadConfig OpenEXRConfig OpenEXRConfigInternal)
        configure_file(${sources}/openexr/cmake/${file}.h.in ${config}/${file}.h)
    endforeach()
    configure_file(${sources}/imath/config/ImathConfig.h.in ${config}/ImathConfig.h)
    set(folder ${sources}/openexr/src/lib)
    file(GLOB openexr ${folder}/OpenEXR/*.cpp)
    list(FILTER openexr EXCLUDE REGEX "/Imf(Aces|CRgba|Rgba|Lut|TestFile|Envmap\\.|DwaC|B44C)|/(b44|dwa)[A-Za-z]+\\.cpp$")
    foreach(file ImfDwaCompressor.cpp ImfB44Compressor.cpp) # copied beside other tables, which the compiler finds first
        configure_file(${folder}/OpenEXR/${file} ${config}/${file} COPYONLY)
        set_source_files_properties(${config}/${file} PROPERTIES COMPILE_OPTIONS "-include;${config}/half_table.h")
        list(APPEND openexr ${config}/${file})
    endforeach()
    file(COPY config/openexr/ DESTINATION ${config})
    facet_web_library(openexr SOURCES ${openexr} ${folder}/Iex/IexBaseExc.cpp ${folder}/Iex/IexThrowErrnoExc.cpp
        ${folder}/IlmThread/IlmThread.cpp ${folder}/IlmThread/IlmThreadPool.cpp ${folder}/IlmThread/IlmThreadSemaphore.cpp
        ${folder}/IlmThread/IlmThreadSemaphorePosixCompat.cpp
        INCLUDES ${config} ${folder}/OpenEXR ${folder}/Iex ${folder}/IlmThread ${sources}/imath/src/Imath
        DEFINITIONS IMATH_HALF_NO_LOOKUP_TABLE)
    target_link_libraries(openexr PRIVATE libraries)
    facet_web_codec(exr SOURCES ${root}/src/image/codec_exr.c ${root}/src/image/exr_check.c ${root}/src/image/exr_shim.cc
        LIBRARIES openexr FUNCTIONS exr_probe exr_decode exr_get_envmap image_destroy)
endif()
