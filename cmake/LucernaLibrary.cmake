# lucerna_library(NAME SOURCES ... [PUBLIC libs] [PRIVATE libs]): one room of the house as a static library.
function(lucerna_library name)
    cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
    add_library(${name} STATIC ${ARG_SOURCES})
    target_link_libraries(${name} PUBLIC lucerna_options ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
    target_precompile_headers(${name} PRIVATE <Eigen/Core> <string> <vector> <variant> <optional> <fmt/format.h>)
endfunction()

# lucerna_test(NAME SOURCES ... LIBRARIES ...): one Catch2 program per room; each TEST_CASE is a ctest.
function(lucerna_test name)
    cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
    add_executable(${name} ${ARG_SOURCES})
    target_link_libraries(${name} PRIVATE lucerna_options ${ARG_LIBRARIES} Catch2::Catch2 lucerna_catch_main)
    target_precompile_headers(${name} PRIVATE <catch2/catch.hpp> <Eigen/Core> <fmt/format.h>)
    target_compile_definitions(${name} PRIVATE LUCERNA_TEST_DATA="${CMAKE_SOURCE_DIR}/tests/data"
                               LUCERNA_EXAMPLES="${CMAKE_SOURCE_DIR}/examples")
    catch_discover_tests(${name} ADD_TAGS_AS_LABELS PROPERTIES TIMEOUT 300)
endfunction()
