# A room is a folder with a library of its own, lull_<folder>. Nothing but the rooms that it links, and
# those that they link, can be included in it: the folder of the project is on nobody's include path.
# Instead each room has a folder in the build tree with nothing in it but a link to its own.

# lull_room_headers(TARGET FOLDER [PRIVATE]): lets those who link the target include FOLDER/..., which
# is given relative to the project; or the target alone.
function(lull_room_headers target folder)
  set(visibility PUBLIC ${ARGN})
  list(GET visibility -1 visibility)
  set(view ${PROJECT_BINARY_DIR}/rooms/${target})
  if(visibility STREQUAL PRIVATE)
    string(APPEND view _private)
  endif()
  get_filename_component(parent ${view}/${folder} DIRECTORY)
  file(MAKE_DIRECTORY ${parent})
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${folder} ${view}/${folder} SYMBOLIC)
  target_include_directories(${target} ${visibility} ${view})
endfunction()

# lull_room(TARGET FOLDER LINKED...): makes a library of all that is in FOLDER, seen from the calling
# CMakeLists.txt, on top of other targets. Headers in folders within it, unless a header beside
# these folders includes them, and headers named *_internal.h are for the room alone
# (tests/rooms_test.cpp checks that). The target `includes` compiles each header by itself, as each
# source is where builds are not united.
add_custom_target(includes)
function(lull_room target folder)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cpp)
  add_library(${target} STATIC ${sources})
  file(RELATIVE_PATH path ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/${folder})
  lull_room_headers(${target} ${path})
  target_link_libraries(${target} PUBLIC lull_options ${ARGN})

  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.h)
  foreach(header IN LISTS headers)
    file(RELATIVE_PATH name ${PROJECT_SOURCE_DIR} ${header})
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/alone/${name}.cpp CONTENT "#include \"${name}\"\n")
    list(APPEND alone ${PROJECT_BINARY_DIR}/alone/${name}.cpp)
  endforeach()
  add_library(${target}_headers OBJECT EXCLUDE_FROM_ALL ${alone})
  set_target_properties(${target}_headers PROPERTIES UNITY_BUILD OFF)
  target_link_libraries(${target}_headers PRIVATE ${target})
  add_dependencies(includes ${target}_headers)
endfunction()
