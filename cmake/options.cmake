# ligature_options: compile options of all targets of this project.
add_library(ligature_options INTERFACE)
target_compile_features(ligature_options INTERFACE cxx_std_20)
target_include_directories(ligature_options INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_definitions(ligature_options INTERFACE LIGATURE_VERSION="${PROJECT_VERSION}")
target_compile_options(ligature_options INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wnon-virtual-dtor
  $<$<CXX_COMPILER_ID:Clang>:-Wno-sign-conversion>  # GCC's -Wconversion does not include it for C++ either
  $<$<BOOL:${LIGATURE_WERROR}>:-Werror>
  -fno-math-errno -ffp-contract=fast)

# Portable code: one binary runs on every x86-64 CPU since 2013, and under valgrind. Eigen's alignment depends on these
# flags, so they are set for the whole build, not per target.
if(NOT LIGATURE_ARCH STREQUAL "default")
  add_compile_options(-march=${LIGATURE_ARCH})
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  add_compile_options(-march=x86-64-v3)
endif()

# cpu_check.cpp must run before the first instruction that a CPU may lack. An object library, because the linker would
# drop an unreferenced member of a static library.
add_library(ligature_cpu_check OBJECT ${CMAKE_CURRENT_LIST_DIR}/cpu_check.cpp)
if(LIGATURE_ARCH STREQUAL "default" OR LIGATURE_ARCH STREQUAL "x86-64-v3")
  target_compile_definitions(ligature_cpu_check PRIVATE LIGATURE_X86_64_LEVEL=3)
elseif(LIGATURE_ARCH STREQUAL "x86-64-v2")
  target_compile_definitions(ligature_cpu_check PRIVATE LIGATURE_X86_64_LEVEL=2)
else()
  target_compile_definitions(ligature_cpu_check PRIVATE LIGATURE_X86_64_LEVEL=1)
endif()
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  target_compile_options(ligature_cpu_check PRIVATE -march=x86-64)  # the last of two -march options applies
endif()
function(ligature_check_cpu target)
  target_sources(${target} PRIVATE $<TARGET_OBJECTS:ligature_cpu_check>)
endfunction()

# Compiles eight sources as one unit, for targets whose headers (toml++, JSON, Boost, CLI11) take longer to compile than
# their own code: host/view and test_platform take half the time. Names in anonymous namespaces must then differ within a
# target. Not for the physics and the control law: an object there should not depend on which files are its neighbours.
function(ligature_compile_together)
  set_target_properties(${ARGV} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
endfunction()

# For code that waits more than it computes: Boost.Beast takes twice as long to compile with -O2. GCC warns falsely about
# std::optional with -O1.
function(ligature_compile_quickly target)
  target_compile_options(${target} PRIVATE -O1 $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
endfunction()

if(LIGATURE_SANITIZE)
  add_compile_options(-fsanitize=${LIGATURE_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${LIGATURE_SANITIZE})
  if(LIGATURE_SANITIZE MATCHES "undefined")
    add_compile_options(-fno-sanitize-recover=undefined)
  endif()
endif()
