# Compile options that every target shares, and the functions that declare modules and tests.

add_library(facet_flags INTERFACE)
target_compile_options(facet_flags INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wdouble-promotion $<$<COMPILE_LANGUAGE:C>:-Wstrict-prototypes>
    -fno-math-errno -fno-trapping-math -ffp-contract=off)
if(FACET_WERROR)
    target_compile_options(facet_flags INTERFACE -Werror)
endif()
if(FACET_SANITIZE)
    target_compile_options(facet_flags INTERFACE -fsanitize=${FACET_SANITIZE} -fno-sanitize-recover=all
        -fno-omit-frame-pointer)
    # C programs link the one C++ file as well, so run-time type checks are off.
    target_compile_options(facet_flags INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-fno-sanitize=vptr>)
    target_link_options(facet_flags INTERFACE -fsanitize=${FACET_SANITIZE})
endif()
if(FACET_FUZZ AND FACET_FUZZ_GUIDED)
    target_compile_options(facet_flags INTERFACE -fsanitize=fuzzer-no-link)
    target_link_options(facet_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()
# facet's own C files are written in the dialect of shade/, whose names have no prefix.
target_compile_definitions(facet_flags INTERFACE FACET_SHADE_DIALECT)
target_include_directories(facet_flags INTERFACE
    ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}
    ${PROJECT_BINARY_DIR}/generated)

set_property(GLOBAL PROPERTY FACET_MODULES "")
set_property(GLOBAL PROPERTY FACET_EXTERNALS "")

# facet_module(NAME SOURCES a.c b.c LINK facet_base PkgConfig::x): one folder of src/ as the static library
# facet_NAME, all of which become libfacet.
function(facet_module name)
    cmake_parse_arguments(M "" "" "SOURCES;LINK" ${ARGN})
    add_library(facet_${name} STATIC ${M_SOURCES})
    target_link_libraries(facet_${name} PUBLIC ${M_LINK} PRIVATE $<BUILD_INTERFACE:facet_flags>)
    set_property(GLOBAL APPEND PROPERTY FACET_MODULES facet_${name})
    foreach(item ${M_LINK})
        if(NOT item MATCHES "^facet_")
            set_property(GLOBAL APPEND PROPERTY FACET_EXTERNALS ${item})
        endif()
    endforeach()
endfunction()

set(FACET_TEST_PREFIX "" CACHE STRING "Stands before the names of tests: several builds in one ctest")
set(FACET_TEST_LABEL "" CACHE STRING "Declare only the tests with this label; empty: all")

# The folder of real models, environments and images for some tests.
if(DEFINED ENV{FACET_TEST_DATA})
    set(data $ENV{FACET_TEST_DATA})
else()
    set(data ${PROJECT_SOURCE_DIR}/../shared/data)
endif()
set(FACET_TEST_DATA ${data} CACHE PATH "Test data; tests that need it skip where it is not there")

# Tests check only whether the variable is set.
if(FACET_TEST_DATA AND IS_DIRECTORY ${FACET_TEST_DATA})
    set(data_setting "set:${FACET_TEST_DATA}")
else()
    set(data_setting "unset:")
    message(STATUS "There is no folder \"${FACET_TEST_DATA}\": tests on real models are skipped")
endif()

# Tests with the label quick, for packagers: seconds, no display, no network, no shared models; -DFACET_TEST_LABEL=quick builds
# and runs only these.
set(FACET_QUICK_NAMES
    "base_.*|codec_.*|gltf_(accessors|meshes|materials|textures|nodes|animations|write)|obj_(read|files|write)|stl|ply|scene"
    "ibl_(sh|cube|dfg|environment)|film|compare|compare_flip|shade_(brdf|fresnel|color|sampling|surface|light|ibl|layers|tonemap)"
    "api|api_compare|api_thumbnail|golden|cli_(command_line|value|usage|documents|render|convert|compare)|package|package_thumbnail")
list(JOIN FACET_QUICK_NAMES "|" FACET_QUICK_NAMES)

# Sets LABELS of a test: those given, and quick.
macro(facet_label name labels)
    set(test_labels ${labels})
    if("${name}" MATCHES "^(${FACET_QUICK_NAMES})$")
        list(APPEND test_labels quick)
    endif()
endmacro()

# Whether tests run all of their cases: only the optimised build of a run does (tests/support/support.h).
set(FACET_QUICK_TESTS OFF)
if(FACET_SANITIZE OR NOT FACET_TRUTH)
    set(FACET_QUICK_TESTS ON)
endif()

# Builds what tests run. Tests of the command add it themselves.
add_custom_target(facet_tested)

# facet_add_test(NAME [LONG] [LABELS threads] [TIMEOUT s] COMMAND ...): declares a test. LONG: it checks computed values, not
# memory or threads, and takes long: only the build that runs all cases has it. The environment variable FACET_TEST_DATA
# names the test data; tests that need it skip without (exit code 77).
function(facet_add_test name)
    cmake_parse_arguments(T "LONG" "TIMEOUT" "COMMAND;LABELS" ${ARGN})
    if(T_UNPARSED_ARGUMENTS)
        message(FATAL_ERROR "facet_add_test(${name}): unknown arguments: ${T_UNPARSED_ARGUMENTS}")
    endif()
    if(T_LONG AND FACET_QUICK_TESTS)
        return()
    endif()
    facet_label(${name} "${T_LABELS}")
    if(FACET_TEST_LABEL AND NOT FACET_TEST_LABEL IN_LIST test_labels)
        return()
    endif()
    if(NOT T_TIMEOUT)
        set(T_TIMEOUT 300)
    endif()
    add_test(NAME ${FACET_TEST_PREFIX}${name} COMMAND ${T_COMMAND} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
    set_tests_properties(${FACET_TEST_PREFIX}${name} PROPERTIES TIMEOUT ${T_TIMEOUT} SKIP_RETURN_CODE 77
        ENVIRONMENT "FACET_QUICK_TESTS=$<BOOL:${FACET_QUICK_TESTS}>;TSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/tsan.supp;LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/lsan.supp:print_suppressions=0"
        ENVIRONMENT_MODIFICATION "FACET_TEST_DATA=${data_setting}")
    if(test_labels)
        set_tests_properties(${FACET_TEST_PREFIX}${name} PROPERTIES LABELS "${test_labels}")
    endif()
endfunction()

# facet_test(NAME [LONG] SOURCES a_test.c LINK facet_x [LABELS threads] [TIMEOUT s]): a cmocka program as a test, with
# tests/support.
function(facet_test name)
    if(NOT BUILD_TESTING)
        return()
    endif()
    cmake_parse_arguments(T "LONG" "TIMEOUT" "SOURCES;LINK;LABELS" ${ARGN})
    if(T_UNPARSED_ARGUMENTS)
        message(FATAL_ERROR "facet_test(${name}): unknown arguments: ${T_UNPARSED_ARGUMENTS}")
    endif()
    facet_label(${name} "${T_LABELS}")
    if((FACET_TEST_LABEL AND NOT FACET_TEST_LABEL IN_LIST test_labels) OR (T_LONG AND FACET_QUICK_TESTS))
        return()
    endif()
    add_executable(${name}_test ${T_SOURCES})
    target_link_libraries(${name}_test PRIVATE ${T_LINK} facet_test_support PkgConfig::CMOCKA m facet_flags)
    if(FACET_QUICK_TESTS)
        target_compile_definitions(${name}_test PRIVATE FACET_QUICK_TESTS)
    endif()
    add_dependencies(facet_tested ${name}_test)
    facet_add_test(${name} COMMAND ${name}_test TIMEOUT ${T_TIMEOUT} LABELS ${T_LABELS})
endfunction()
