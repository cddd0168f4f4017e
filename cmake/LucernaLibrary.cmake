# The headers that most sources include, compiled once for all rooms and once for all tests.
set(LUCERNA_PRECOMPILED <Eigen/Core> <Eigen/Geometry> <algorithm> <cmath> <functional> <numeric> <optional> <random>
                        <string> <variant> <vector> <fmt/format.h>)

# lucerna_precompiled(NAME HEADERS ... LIBRARIES ...): the headers, for targets with the same options.
function(lucerna_precompiled name)
    cmake_parse_arguments(ARG "" "" "HEADERS;LIBRARIES" ${ARGN})
    set(source ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT "// Only for the precompiled headers.\n")
    add_library(${name} OBJECT ${source})
    target_link_libraries(${name} PRIVATE lucerna_options ${ARG_LIBRARIES})
    target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
endfunction()

# lucerna_library(NAME SOURCES ... [PUBLIC libs] [PRIVATE libs]): one room of the house as a static library.
function(lucerna_library name)
    cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
    add_library(${name} STATIC ${ARG_SOURCES})
    target_link_libraries(${name} PUBLIC lucerna_options ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
    target_precompile_headers(${name} REUSE_FROM lucerna_precompiled)
endfunction()

# lucerna_test(NAME SOURCES ... LIBRARIES ...): one Catch2 program per room; each TEST_CASE is a ctest.
function(lucerna_test name)
    cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
    add_executable(${name} ${ARG_SOURCES})
    target_link_libraries(${name} PRIVATE lucerna_options ${ARG_LIBRARIES} Catch2::Catch2 lucerna_catch_main)
    target_precompile_headers(${name} REUSE_FROM lucerna_test_precompiled)
    catch_discover_tests(${name} ADD_TAGS_AS_LABELS PROPERTIES TIMEOUT 300)
endfunction()
