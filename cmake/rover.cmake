# How the project builds: flags, and one function each for a core library, a node and a test.

find_package(Eigen3 REQUIRED NO_MODULE)
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(GTest REQUIRED)
find_package(benchmark REQUIRED)
find_package(OpenCV REQUIRED COMPONENTS core imgproc imgcodecs calib3d video features2d)
pkg_check_modules(LCM REQUIRED IMPORTED_TARGET lcm)
pkg_check_modules(YAML_CPP REQUIRED IMPORTED_TARGET yaml-cpp)
pkg_check_modules(NLOPT REQUIRED IMPORTED_TARGET nlopt)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  # Without this leave ccache does not keep what was compiled with a precompiled header.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
endif()
find_program(MOLD_PROGRAM mold)
if(MOLD_PROGRAM)
  add_link_options(-fuse-ld=mold)
endif()

# -O3 only where the work is (rover_core's HOT): on Eigen's fixed matrices it multiplies the compile time for nothing.
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O2 -g1")
if(ROVER_SANITIZE)
  set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1")
endif()
add_library(rover_flags INTERFACE)
# -Wrestrict is wrong about std::string on GCC 12 (PR 105651); members left out of an initializer have defaults.
# No -ffast-math and no contraction: the same inputs give the same bytes on every run.
target_compile_options(rover_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wno-restrict
  -Wno-missing-field-initializers -Werror
  -ffp-contract=off)
# A baseline of the processor, never the builder's own: the same program gives the same bytes on each machine.
if(CMAKE_SYSTEM_PROCESSOR STREQUAL x86_64)
  target_compile_options(rover_flags INTERFACE -march=x86-64-v2)
elseif(CMAKE_SYSTEM_PROCESSOR STREQUAL aarch64)
  # Eigen then multiplies and adds in two roundings, as on x86-64.
  # -Wno-psabi: notes on how GCC 10 passed pairs, on each file.
  target_compile_options(rover_flags INTERFACE -U__ARM_FEATURE_FMA -Wno-psabi)
endif()
if(ROVER_SANITIZE STREQUAL address)
  # UBSan without the checks that ASan's own cover (null, object-size) or that x86 has no need of: 30 % of the build time.
  # Under the sanitizers GCC 12 takes parts of std::regex for uninitialized (PR 105562).
  target_compile_options(rover_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all
    -fno-sanitize=null,object-size,vptr,alignment -fno-omit-frame-pointer -Wno-maybe-uninitialized)
  target_link_options(rover_flags INTERFACE -fsanitize=address,undefined)
  # Under the sanitizer Eigen would pad what it allocates, and PCL's library, which is not sanitized, would free it without.
  target_compile_definitions(rover_flags INTERFACE EIGEN_INITIALIZE_MATRICES_BY_NAN EIGEN_MALLOC_ALREADY_ALIGNED=1)
elseif(ROVER_SANITIZE STREQUAL thread)
  target_compile_options(rover_flags INTERFACE -fsanitize=thread -Wno-maybe-uninitialized)
  target_link_options(rover_flags INTERFACE -fsanitize=thread)
elseif(ROVER_SANITIZE)
  message(FATAL_ERROR "ROVER_SANITIZE=${ROVER_SANITIZE}: address or thread")
endif()

# What most files read, compiled once: a quarter less to build. Targets take it with rover_precompiled; those with flags
# of their own (HOT) cannot.
# -pthread: LCM's users have it, and all must be the same.
target_compile_options(rover_flags INTERFACE -fpch-preprocess -pthread)
function(rover_precompiled name)
  target_precompile_headers(${name} REUSE_FROM rover_precompiled_headers)
endfunction()
add_library(rover_precompiled_headers OBJECT ${CMAKE_SOURCE_DIR}/cmake/precompiled.cpp)
target_link_libraries(rover_precompiled_headers PRIVATE rover_flags Eigen3::Eigen)
target_precompile_headers(rover_precompiled_headers PRIVATE <Eigen/Cholesky> <Eigen/Core> <Eigen/Geometry> <algorithm>
  <array> <chrono> <cmath> <cstdint> <cstdio> <deque> <filesystem> <fstream> <functional> <limits> <map> <memory>
  <optional> <set> <sstream> <stdexcept> <string> <string_view> <variant> <vector>)

# OpenCV's and other packages' headers are not ours to warn about.
add_library(rover_opencv INTERFACE)
target_include_directories(rover_opencv SYSTEM INTERFACE ${OpenCV_INCLUDE_DIRS})
target_link_libraries(rover_opencv INTERFACE ${OpenCV_LIBS})

# runtime: what ./rover run needs. full: that, and the services of the Full level. tools: runtime, and what the other
# commands use. unit_tests: the programs of the unit tests. thread_tests: those of them that start threads. benchmarks:
# those of ./rover bench micro.
add_custom_target(runtime)
add_custom_target(full)
add_dependencies(full runtime)
add_custom_target(tools)
add_dependencies(tools runtime)
add_custom_target(unit_tests)
add_custom_target(thread_tests)
add_custom_target(benchmarks)

# rover_core(NAME [HOT] SOURCES ... LINK ...): a library without middleware: it links neither LCM nor YAML nor the bus.
# HOT: images or grids go through it, -O3 pays.
function(rover_core name)
  cmake_parse_arguments(ARG "HOT" "" "SOURCES;LINK" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_include_directories(${name} PUBLIC ${CMAKE_SOURCE_DIR}/services ${CMAKE_SOURCE_DIR})
  set_property(GLOBAL APPEND PROPERTY ROVER_CORES ${name})
  target_link_libraries(${name} PUBLIC rover_flags Eigen3::Eigen ${ARG_LINK})
  if(ARG_HOT AND NOT ROVER_SANITIZE)
    target_compile_options(${name} PRIVATE -O3)
  else()
    rover_precompiled(${name})
  endif()
endfunction()

# rover_library(NAME SOURCES...): a library that may link anything.
function(rover_library name)
  add_library(${name} STATIC ${ARGN})
  rover_precompiled(${name})
endfunction()

# rover_node(SERVICE [CORE core] SOURCES ... LINK ...): library <service>_node over its core (<service>_core, if not
# given), and its executable from main.cpp.
function(rover_node service)
  cmake_parse_arguments(ARG "" "CORE" "SOURCES;LINK" ${ARGN})
  if(NOT ARG_CORE)
    set(ARG_CORE ${service}_core)
  endif()
  rover_library(${service}_node ${ARG_SOURCES})
  target_link_libraries(${service}_node PUBLIC ${ARG_CORE} rover_bus ${ARG_LINK})
  set_property(GLOBAL APPEND PROPERTY ROVER_NODES ${service}_node)
  add_executable(${service} main.cpp)
  target_link_libraries(${service} PRIVATE ${service}_node)
  rover_program(${service})
endfunction()

# rover_program(NAME), rover_tool(NAME): an executable in build/bin that ./rover run needs, at the Full level alone for its
# services, or that other commands use.
function(rover_program name)
  set(users runtime)
  if(name IN_LIST ROVER_FULL_SERVICES)
    set(users full)
  endif()
  rover_executable(${name} ${users})
endfunction()
function(rover_tool name)
  rover_executable(${name} tools)
endfunction()
function(rover_executable name users)
  set_property(GLOBAL APPEND PROPERTY ROVER_PROGRAMS ${name})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
  rover_precompiled(${name})
  add_dependencies(${users} ${name} check_includes)
endfunction()

# rover_benchmark(NAME SOURCES ... LINK ...): a Google Benchmark program, in build/bench.
function(rover_benchmark name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} EXCLUDE_FROM_ALL ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LINK} benchmark::benchmark)
  target_compile_definitions(${name} PRIVATE ROVER_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bench)
  add_dependencies(benchmarks ${name})
endfunction()

# rover_test(NAME [THREADS] [WILD] SOURCES ... LINK ... [LABEL unit|integration]): builds and registers a GoogleTest
# program. THREADS: it starts some, and also runs under ThreadSanitizer. WILD: it has rows of test/results/wild.md.
function(rover_test name)
  cmake_parse_arguments(ARG "THREADS;WILD" "LABEL;TIMEOUT" "SOURCES;LINK" ${ARGN})
  if(NOT ARG_LABEL)
    set(ARG_LABEL unit)
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  if(ROVER_SANITIZE OR CMAKE_CROSSCOMPILING)
    math(EXPR ARG_TIMEOUT "${ARG_TIMEOUT} * 5")
  endif()
  set(when)
  if(ARG_LABEL STREQUAL unit)
    set(when EXCLUDE_FROM_ALL)
  endif()
  add_executable(${name} ${when} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LINK} GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE
    ROVER_SOURCE_DIR="${CMAKE_SOURCE_DIR}" ROVER_BINARY_DIR="${CMAKE_BINARY_DIR}")
  rover_precompiled(${name})
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES LABELS ${ARG_LABEL} TIMEOUT ${ARG_TIMEOUT} ENVIRONMENT
    "LSAN_OPTIONS=suppressions=${CMAKE_SOURCE_DIR}/test/lsan.supp;TSAN_OPTIONS=suppressions=${CMAKE_SOURCE_DIR}/test/tsan.supp")
  if(ARG_LABEL STREQUAL unit)
    add_dependencies(unit_tests ${name})
  endif()
  if(ARG_THREADS)
    add_dependencies(thread_tests ${name})
    set_property(TEST ${name} APPEND PROPERTY LABELS threads)
  endif()
  if(ARG_WILD)
    target_link_libraries(${name} PRIVATE wild_rows)
    set_property(TEST ${name} APPEND PROPERTY LABELS wild)
  endif()
endfunction()
