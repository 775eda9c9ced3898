# How everything here is compiled: C++20, warnings as errors, optional sanitizers.
include(GNUInstallDirs)
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")  # contracts are checked by Require, never by assert

# As many compilers as cores: the two more that Ninja starts compete for the cache.
cmake_host_system_information(RESULT cores QUERY NUMBER_OF_LOGICAL_CORES)
set_property(GLOBAL PROPERTY JOB_POOLS compile=${cores})
set(CMAKE_JOB_POOL_COMPILE compile)

# One compilation serves the programs and the Python module. It costs the programs nothing: within them calls
# are bound directly, as no other definition can take the place of ours.
add_compile_options(-fPIC -fno-semantic-interposition)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

if(TELLTALE_SANITIZE)
  # What a report needs, built in two thirds of the time.
  set(CMAKE_C_FLAGS_RELWITHDEBINFO "-O1 -g1")
  set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1")
  add_compile_options(-fsanitize=${TELLTALE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${TELLTALE_SANITIZE})
endif()

add_library(telltale_compile INTERFACE)
# GCC spends a tenth of its time on garbage collection while it instantiates templates. It collects only above
# a gigabyte.
target_compile_options(telltale_compile
                       INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:--param=ggc-min-heapsize=1000000>)
target_compile_options(
  telltale_compile INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wpedantic -Wshadow -Wconversion
                             -Wno-sign-conversion -Wnon-virtual-dtor -Woverloaded-virtual -Werror>)

# GCC 12 reports writes out of bounds in correct assignments to std::string. Under a sanitizer, which limits
# inlining, it also reports correct variables as uninitialised and correct pointers as used after free.
target_compile_options(
  telltale_compile INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-array-bounds -Wno-restrict
                             -Wno-stringop-overflow>)
if(TELLTALE_SANITIZE)
  target_compile_options(telltale_compile
                         INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-maybe-uninitialized
                                                                        -Wno-use-after-free>)
endif()

# The thread sanitizer follows no fences, so GCC refuses those of Boost.Asio.
if(TELLTALE_SANITIZE STREQUAL "thread")
  target_compile_definitions(telltale_compile INTERFACE BOOST_ASIO_DISABLE_FENCED_BLOCK)
  # The headers of protobuf would lay out their maps otherwise than Debian's library does.
  add_compile_options(-U__SANITIZE_THREAD__)
endif()

# telltale_layer(NAME core LINKS ...): a static library of every .cpp below this folder. Its headers are
# included as "telltale/NAME/folder/file.hpp" through an include directory that holds this layer alone, so
# that a layer can include nothing it does not link.
function(telltale_layer name)
  cmake_parse_arguments(ARG "" "" "LINKS;EXCLUDE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS *.cpp *.hpp)
  foreach(pattern IN LISTS ARG_EXCLUDE)
    list(FILTER sources EXCLUDE REGEX ${pattern})
  endforeach()
  add_library(telltale_${name} STATIC ${sources})
  set(root ${PROJECT_BINARY_DIR}/include/${name})
  file(MAKE_DIRECTORY ${root}/telltale)
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${root}/telltale/${name} SYMBOLIC)
  target_include_directories(telltale_${name} PUBLIC $<BUILD_INTERFACE:${root}>)
  target_link_libraries(telltale_${name} PUBLIC ${ARG_LINKS}
                                         PRIVATE $<BUILD_INTERFACE:telltale_compile>)
endfunction()

# Parsing what most files include takes longer than compiling them. It is read once for core and idl,
# once for the programs and once for the tests, which differ in their optimisation or in what
# they include and so cannot share.
set(telltale_linear_algebra ${PROJECT_BINARY_DIR}/include/core/telltale/core/base/linear_algebra)
function(telltale_precompile target)
  if(target STREQUAL telltale_core)
    target_precompile_headers(telltale_core PRIVATE ${telltale_linear_algebra}/eigen_products.hpp <optional>
                              <string> <vector> <tl/expected.hpp>)
  else()
    target_precompile_headers(${target} REUSE_FROM telltale_core)
  endif()
endfunction()

# Code around the arithmetic, and tests, run no faster with full optimisation and compile more slowly.
function(telltale_optimise_lightly target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-Og>)
endfunction()

# telltale_fully_optimised(LAYER FOLDER LINKS ...): what lies below this folder, in a layer that is lightly optimised
# else: where every sample of a fleet, or of gigabytes, costs time. A library of objects, telltale_FOLDER.
function(telltale_fully_optimised layer folder)
  cmake_parse_arguments(ARG "" "" "LINKS" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${folder}/*.cpp ${folder}/*.hpp)
  add_library(telltale_${folder} OBJECT ${sources})
  target_include_directories(telltale_${folder} PRIVATE ${PROJECT_BINARY_DIR}/include/${layer})
  target_link_libraries(telltale_${folder} PRIVATE ${ARG_LINKS} telltale_compile)
  telltale_precompile(telltale_${folder})
  telltale_compile_in_groups(telltale_${folder} target 25)
  target_sources(telltale_${layer} PRIVATE $<TARGET_OBJECTS:telltale_${folder}>)
endfunction()

# telltale_precompiled(NAME HEADERS ... LINKS ...): headers of the libraries linked, read once for all
# targets that are lightly optimised and reuse them from NAME.
function(telltale_precompiled name)
  cmake_parse_arguments(ARG "" "" "HEADERS;LINKS" ${ARGN})
  set(empty ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  file(CONFIGURE OUTPUT ${empty} CONTENT "")
  add_library(${name} OBJECT ${empty})
  target_link_libraries(${name} PRIVATE telltale_compile ${ARG_LINKS})
  target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
  telltale_optimise_lightly(${name})
endfunction()

# telltale_program(TARGET): a program or what only programs are made of, around the arithmetic;
# telltale_check(TARGET): tests.
function(telltale_program target)
  if(NOT TARGET telltale_program_headers)
    find_package(CLI11 REQUIRED)
    find_package(Eigen3 3.4 REQUIRED)
    telltale_precompiled(
      telltale_program_headers
      HEADERS <CLI/CLI.hpp> <Eigen/Dense> <filesystem> <functional> <iostream> <map> <memory>
              <optional> <string> <vector>
      LINKS CLI11::CLI11 Eigen3::Eigen)
  endif()
  telltale_optimise_lightly(${target})
  target_precompile_headers(${target} REUSE_FROM telltale_program_headers)
endfunction()

function(telltale_check target)
  if(NOT TARGET telltale_check_headers)
    find_package(Eigen3 3.4 REQUIRED)
    find_package(GTest REQUIRED)
    telltale_precompiled(
      telltale_check_headers
      HEADERS ${telltale_linear_algebra}/eigen_products.hpp ${telltale_linear_algebra}/eigen_decompositions.hpp
              <gmock/gmock.h> <gtest/gtest.h> <filesystem> <functional> <map> <optional> <string>
              <vector>
      LINKS Eigen3::Eigen GTest::gmock GTest::gtest)
  endif()
  telltale_optimise_lightly(${target})
  target_precompile_headers(${target} REUSE_FROM telltale_check_headers)
endfunction()

# telltale_compile_in_groups(TARGET folder|target FILES): up to so many files of a folder, or of the target, become
# one compilation. What they all include is read and instantiated once, which takes half of the time. By folder
# where touching or adding one file should cost seconds. Names do not matter: files that would meet come into
# different groups, anew whenever a source changes.
function(telltale_compile_in_groups target within files)
  if(NOT TELLTALE_COMPILE_TOGETHER)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "[.]cpp$")
  list(SORT sources)
  set(script ${PROJECT_SOURCE_DIR}/cmake/compile-groups)
  execute_process(COMMAND ${Python_EXECUTABLE} ${script} ${within} ${files} ${sources}
                  WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}
                  OUTPUT_VARIABLE placed COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "[^ \n]+" placed "${placed}")
  while(placed)
    list(POP_FRONT placed group source)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group})
  endwhile()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${sources} ${script})
endfunction()
