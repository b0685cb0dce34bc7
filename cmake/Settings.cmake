# Language, warnings, sanitizers, compiler cache.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

option(PELLETLAB_TESTS "Build the tests" ON)
option(PELLETLAB_BENCHMARKS "Build the benchmarks" OFF)
option(PELLETLAB_WARNINGS_AS_ERRORS "Strict warnings, all of them errors" OFF)
option(PELLETLAB_COVERAGE "Instrument for gcov" OFF)
set(PELLETLAB_SANITIZE "" CACHE STRING "Sanitizers for -fsanitize=, for instance address,undefined")
set(PELLETLAB_THREADS tbb CACHE STRING "Thread back end: tbb, or jthread for ThreadSanitizer")
set_property(CACHE PELLETLAB_THREADS PROPERTY STRINGS tbb jthread)

find_program(CCACHE ccache)
if(CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE})
endif()

# One rounding per operation: the same bits whether or not the compiler fuses multiply and add. Kernels that want FMA call it by name.
add_compile_options(-ffp-contract=off)
if(PELLETLAB_SANITIZE)
  add_compile_options(-fsanitize=${PELLETLAB_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${PELLETLAB_SANITIZE})
endif()
if(PELLETLAB_COVERAGE)
  add_compile_options(--coverage)
  add_link_options(--coverage)
endif()

# Warnings for our own rooms only (pelletlab_room), not for what they include.
set(PELLETLAB_WARNINGS -Wall -Wextra $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)  # gcc 12 warns falsely about std::string (bug 105651)
if(PELLETLAB_WARNINGS_AS_ERRORS)
  list(APPEND PELLETLAB_WARNINGS -Wconversion -Wshadow -Werror)
endif()
