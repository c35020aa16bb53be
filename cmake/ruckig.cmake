# ruckig::ruckig: the installed library, if any; else built from the source archive on PyPI, with pinned version and
# hash. PyPI is the only place with packaged C++ sources. Only the eleven solver files are compiled: no cloud client
# (nothing can open a connection), examples or Python module.
find_package(ruckig QUIET)
if(TARGET ruckig::ruckig)
  message(STATUS "ruckig: installed one")
  return()
endif()

set(RUCKIG_VERSION 0.19.4)
set(RUCKIG_SHA256 71d003bf0ff9aa0031d4520b0290a5ffa6458149f5afce8be3ed6d6fba49ea64)
set(LIGATURE_DEPS_DIR ${PROJECT_SOURCE_DIR}/build/deps CACHE PATH "Where fetched sources are kept")
set(ruckig_dir ${LIGATURE_DEPS_DIR}/ruckig-${RUCKIG_VERSION})

if(NOT EXISTS ${ruckig_dir}/CMakeLists.txt)
  find_program(PYTHON3 NAMES python3 REQUIRED)
  file(MAKE_DIRECTORY ${LIGATURE_DEPS_DIR})
  file(WRITE ${LIGATURE_DEPS_DIR}/ruckig.txt "ruckig==${RUCKIG_VERSION} --hash=sha256:${RUCKIG_SHA256}\n")
  message(STATUS "ruckig: fetching the source of ${RUCKIG_VERSION} with pip")
  # only ruckig from source: with ":all:" pip would also compile its build tools, CMake among them, for half an hour
  execute_process(
    COMMAND ${PYTHON3} -m pip download --quiet --disable-pip-version-check --no-deps --no-binary ruckig
            --require-hashes -r ${LIGATURE_DEPS_DIR}/ruckig.txt -d ${LIGATURE_DEPS_DIR}
    RESULT_VARIABLE failed ERROR_VARIABLE why)
  if(failed)
    message(FATAL_ERROR "ruckig: pip could not fetch the source (${why}). "
                        "Remedy: python3-pip and access to PyPI, or install ruckig and set ruckig_DIR.")
  endif()
  file(ARCHIVE_EXTRACT INPUT ${LIGATURE_DEPS_DIR}/ruckig-${RUCKIG_VERSION}.tar.gz DESTINATION ${LIGATURE_DEPS_DIR})
endif()

file(GLOB ruckig_sources ${ruckig_dir}/src/ruckig/position_*.cpp ${ruckig_dir}/src/ruckig/velocity_*.cpp)
add_library(ligature_ruckig STATIC ${ruckig_sources} ${ruckig_dir}/src/ruckig/brake.cpp)
target_include_directories(ligature_ruckig SYSTEM PUBLIC ${ruckig_dir}/include)
target_compile_features(ligature_ruckig PUBLIC cxx_std_20)
add_library(ruckig::ruckig ALIAS ligature_ruckig)
