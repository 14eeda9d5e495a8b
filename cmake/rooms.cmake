# room(NAME SOURCES ... [SHADERS ...] [USES ...] [LIBS ...] [DEFINES ...])
#   one static library for one room; USES are other rooms, LIBS outside libraries, both linked PRIVATE.
#   Shaders (GLSL beside the C) become <file>.h in the build tree: a uint32_t array named after the file.
#   "shade.comp:EMISSIVE:REDRAW" compiles shade.comp with those macros defined, as shade.comp_emissive_redraw.h.
# program(NAME SOURCES ... USES ... LIBS ...)
# room_test(NAME SOURCES ... USES ... LIBS ... [GPU] [TIMEOUT seconds])
#   a cmocka program registered with ctest; exit 77 means skipped; GPU tests run one at a time.

find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_program(GLSLC glslc REQUIRED)

add_library(build_flags INTERFACE)
target_compile_options(build_flags INTERFACE -Wall -Wextra -Wshadow -Wconversion
  $<$<COMPILE_LANGUAGE:C>:-Wmissing-prototypes -Wstrict-prototypes>
  $<$<BOOL:${FOVSTUDY_WERROR}>:-Werror>)
# -ffp-contract=off: the same numbers from every compiler; trial order and statistics rely on it.
target_compile_options(build_flags INTERFACE -ffp-contract=off)
target_compile_definitions(build_flags INTERFACE _POSIX_C_SOURCE=200809L _DEFAULT_SOURCE FOVSTUDY_VERSION="${PROJECT_VERSION}")
target_include_directories(build_flags INTERFACE ${CMAKE_SOURCE_DIR})
if(FOVSTUDY_SANITIZE)
  target_compile_options(build_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  target_link_options(build_flags INTERFACE -fsanitize=address,undefined)
endif()

function(compile_shaders target)
  foreach(variant ${ARGN})
    string(REPLACE ":" ";" defines ${variant})
    list(POP_FRONT defines shader)
    get_filename_component(name ${shader} NAME)
    set(macros)
    foreach(define ${defines})
      list(APPEND macros -D${define})
      string(TOLOWER ${define} define)
      string(APPEND name _${define})
    endforeach()
    string(REPLACE "." "_" symbol ${name})
    set(spv ${CMAKE_CURRENT_BINARY_DIR}/${name}.spv)
    set(header ${CMAKE_CURRENT_BINARY_DIR}/${name}.h)
    add_custom_command(OUTPUT ${header}
      COMMAND ${GLSLC} --target-env=vulkan1.3 -O -I ${CMAKE_SOURCE_DIR} ${macros} -MD -MF ${spv}.d -o ${spv}
              ${CMAKE_CURRENT_SOURCE_DIR}/${shader}
      COMMAND spirv-val --target-env vulkan1.3 --scalar-block-layout ${spv}
      COMMAND ${CMAKE_COMMAND} -DINPUT=${spv} -DOUTPUT=${header} -DSYMBOL=${symbol} -DTYPE=uint32_t
              -P ${CMAKE_SOURCE_DIR}/cmake/embed.cmake
      DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${shader} ${CMAKE_SOURCE_DIR}/cmake/embed.cmake
      DEPFILE ${spv}.d COMMENT "shader ${name}" VERBATIM)
    target_sources(${target} PRIVATE ${header})
  endforeach()
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR})
endfunction()

# embed(TARGET file symbol): a file's bytes as <symbol>.h with a const uint8_t array and its size
function(embed target file symbol)
  set(header ${CMAKE_CURRENT_BINARY_DIR}/${symbol}.h)
  add_custom_command(OUTPUT ${header}
    COMMAND ${CMAKE_COMMAND} -DINPUT=${file} -DOUTPUT=${header} -DSYMBOL=${symbol} -DTYPE=uint8_t
            -P ${CMAKE_SOURCE_DIR}/cmake/embed.cmake
    DEPENDS ${file} ${CMAKE_SOURCE_DIR}/cmake/embed.cmake VERBATIM)
  target_sources(${target} PRIVATE ${header})
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR})
endfunction()

function(room name)
  cmake_parse_arguments(R "" "" "SOURCES;SHADERS;USES;LIBS;DEFINES" ${ARGN})
  add_library(${name} STATIC ${R_SOURCES})
  target_link_libraries(${name} PRIVATE build_flags ${R_USES} ${R_LIBS})
  target_compile_definitions(${name} PRIVATE ${R_DEFINES})
  compile_shaders(${name} ${R_SHADERS})
endfunction()

# Sanitizer builds: see tests/keep_loaded.c.
function(keep_loaded target)
  if(FOVSTUDY_SANITIZE)
    target_sources(${target} PRIVATE ${CMAKE_SOURCE_DIR}/tests/keep_loaded.c)
    set_target_properties(${target} PROPERTIES ENABLE_EXPORTS ON)
  endif()
endfunction()

function(program name)
  cmake_parse_arguments(R "" "" "SOURCES;USES;LIBS;DEFINES" ${ARGN})
  add_executable(${name} ${R_SOURCES})
  keep_loaded(${name})
  target_link_libraries(${name} PRIVATE build_flags ${R_USES} ${R_LIBS})
  target_compile_definitions(${name} PRIVATE ${R_DEFINES})
endfunction()

function(room_test name)
  cmake_parse_arguments(R "GPU" "TIMEOUT" "SOURCES;USES;LIBS;DEFINES" ${ARGN})
  pkg_check_modules(CMOCKA REQUIRED IMPORTED_TARGET cmocka)
  add_executable(test_${name} ${R_SOURCES})
  keep_loaded(test_${name})
  target_link_libraries(test_${name} PRIVATE build_flags ${R_USES} ${R_LIBS} PkgConfig::CMOCKA)
  target_compile_definitions(test_${name} PRIVATE ${R_DEFINES} SOURCE_DIR="${CMAKE_SOURCE_DIR}"
    BUILD_DIR="${CMAKE_BINARY_DIR}")
  set_target_properties(test_${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  add_test(NAME ${name} COMMAND test_${name})
  if(NOT R_TIMEOUT)
    set(R_TIMEOUT 300)
  endif()
  set_tests_properties(${name} PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT ${R_TIMEOUT})
  if(R_GPU)
    set_tests_properties(${name} PROPERTIES LABELS gpu RESOURCE_LOCK gpu)
  endif()
endfunction()
