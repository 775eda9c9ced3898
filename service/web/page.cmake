# The page of service/web/page: npm makes it, and it is compiled into the daemon. Without npm, or with
# TELLTALE_PAGE=OFF, the daemon has /api/v1 and /metrics but no page.
find_program(NPM npm)
if(NPM)
  set(has_npm ON)
else()
  set(has_npm OFF)
endif()
option(TELLTALE_PAGE "Build the page with npm" ${has_npm})

set(page_code ${CMAKE_CURRENT_BINARY_DIR}/page_assets.cpp)
if(TELLTALE_PAGE)
  if(NOT NPM)
    message(FATAL_ERROR "TELLTALE_PAGE is ON, but there is no npm: deploy/install-deps")
  endif()
  set(page ${CMAKE_CURRENT_LIST_DIR}/page)
  set(page_work ${CMAKE_CURRENT_BINARY_DIR}/page)
  file(GLOB_RECURSE page_sources CONFIGURE_DEPENDS ${page}/src/*)
  # npm works in the build folder, so that the source folder stays as it is.
  add_custom_command(
    OUTPUT ${page_work}/node_modules/.package-lock.json
    COMMAND ${CMAKE_COMMAND} -E make_directory ${page_work}
    COMMAND ${CMAKE_COMMAND} -E copy ${page}/package.json ${page}/package-lock.json ${page_work}
    COMMAND ${NPM} ci --no-audit --no-fund --loglevel=error
    DEPENDS ${page}/package.json ${page}/package-lock.json
    WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/page
    COMMENT "Fetching what the page is built from"
    VERBATIM)
  file(MAKE_DIRECTORY ${page_work})
  add_custom_command(
    OUTPUT ${page_code}
    COMMAND ${CMAKE_COMMAND} -E copy_directory ${page}/src ${page_work}/src
    COMMAND ${CMAKE_COMMAND} -E copy ${page}/build.mjs ${page}/tsconfig.json ${page_work}
    COMMAND ${NPM} run --silent build -- ${PROJECT_SOURCE_DIR}/docs/reference/openapi.json ${page_code}
    DEPENDS ${page_work}/node_modules/.package-lock.json ${page}/build.mjs ${page}/tsconfig.json
            ${page_sources} ${PROJECT_SOURCE_DIR}/docs/reference/openapi.json
    WORKING_DIRECTORY ${page_work}
    COMMENT "Building the page"
    VERBATIM)
else()
  message(STATUS "The daemon is built without its page")
  file(CONFIGURE OUTPUT ${page_code} CONTENT [[
#include "telltale/service/web/page_assets.hpp"

namespace telltale {

std::span<const PageAsset> PageAssets() {
  return {};
}

}  // namespace telltale
]] @ONLY)
endif()
# Apart from the layer, so that no check of the sources needs it.
add_library(telltale_page STATIC ${page_code})
target_include_directories(telltale_page PRIVATE ${PROJECT_BINARY_DIR}/include/service)
target_link_libraries(telltale_service PUBLIC telltale_page)
