# The renderer's tests as a module for browsers, tests/gl_tests.js in the build folder; no part of what is served. tests/web/gl.sh
# builds the target gl_tests.
set(gl_tests ${root}/tests/web/gl)
set(parity ${FACET_GENERATED}/../tests/parity) # of the native build: the shader library and the cases as GLSL, the list of cases
set(files ${gl_tests}/gl_tests.c ${gl_tests}/preview_none.c ${gl_tests}/parity_context_web.c ${root}/tests/support/support.c
    ${root}/src/cpu/preview_fixture.c ${root}/src/cpu/ogl1_fixture.c ${root}/src/gl/scene/gl_fixture_test.c)
file(STRINGS ${gl_tests}/gl_tests.def lines REGEX "^GL_TEST")
foreach(line ${lines})
    string(REGEX REPLACE "GL_TEST\\((.*)\\)" "\\1" name "${line}")
    file(GLOB source ${root}/src/*/*/${name}_test.c ${root}/src/*/${name}_test.c ${root}/tests/parity/${name}_test.c ${gl_tests}/${name}_test.c)
    if(name MATCHES "^gl_(material|opaque|program)$") # a part of their cases: browsers take minutes for all
        set_source_files_properties(${source} PROPERTIES COMPILE_DEFINITIONS "main=${name}_tests;FACET_QUICK_TESTS")
    elseif(source)
        set_source_files_properties(${source} PROPERTIES COMPILE_DEFINITIONS main=${name}_tests)
    else()
        message(FATAL_ERROR "gl_tests.def: there is no ${name}_test.c")
    endif()
    list(APPEND files ${source})
endforeach()
list(REMOVE_DUPLICATES files)
# it has arguments
set_source_files_properties(${root}/tests/parity/parity_test.c PROPERTIES COMPILE_DEFINITIONS main=parity_with_arguments)
# with comments, by which gl_light_test.c finds files
file(COPY ${FACET_GENERATED}/gl_text.h ${FACET_GENERATED}/glsl_text.h DESTINATION ${CMAKE_BINARY_DIR}/generated/whole)
add_library(gl_tests_text STATIC EXCLUDE_FROM_ALL ${root}/src/glsl/glsl.c ${root}/src/gl/core/gl_program_text.c)
target_include_directories(gl_tests_text BEFORE PRIVATE ${CMAKE_BINARY_DIR}/generated/whole)
target_link_libraries(gl_tests_text PRIVATE facet)
add_library(gl_tests_objects OBJECT EXCLUDE_FROM_ALL ${files})
target_include_directories(gl_tests_objects BEFORE PRIVATE ${gl_tests}/shim ${gl_tests} ${parity})
target_compile_options(gl_tests_objects PRIVATE -O1 -Wall -Wextra -fno-math-errno -fno-trapping-math -ffp-contract=off)
target_link_libraries(gl_tests_objects PRIVATE sea facet_tools facet libraries)
add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/tests/gl_tests.js BYPRODUCTS ${CMAKE_BINARY_DIR}/tests/gl_tests.wasm VERBATIM
    COMMAND_EXPAND_LISTS
    DEPENDS gl_tests_objects $<TARGET_OBJECTS:gl_tests_objects> gl_tests_text sea facet_tools facet libraries
    COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_BINARY_DIR}/tests
    COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs emcc -O1 -o ${CMAKE_BINARY_DIR}/tests/gl_tests.js
        $<TARGET_OBJECTS:gl_tests_objects> $<TARGET_FILE:gl_tests_text> $<TARGET_FILE:sea> $<TARGET_FILE:facet_tools> $<TARGET_FILE:facet> $<TARGET_FILE:libraries>
        ${FACET_JPEG}/libturbojpeg.a
        -sMODULARIZE -sEXPORT_ES6 -sUSE_ES6_IMPORT_META=1 -sENVIRONMENT=web -sALLOW_MEMORY_GROWTH -sTOTAL_STACK=1048576
        -sMIN_WEBGL_VERSION=2 -sMAX_WEBGL_VERSION=2 -sINVOKE_RUN=0 -sFORCE_FILESYSTEM -sEXPORTED_RUNTIME_METHODS=[FS,UTF8ToString]
    COMMENT "Linking gl_tests.wasm")
add_custom_target(gl_tests DEPENDS ${CMAKE_BINARY_DIR}/tests/gl_tests.js)
