# Tests of the program: its helpers, its messages on wrong input, and the order of the house.
set(TRACKBED_PYTHON /usr/bin/python3)

add_test(NAME unit/forbidden_includes
         COMMAND ${TRACKBED_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/forbidden_includes.py
                 ${PROJECT_SOURCE_DIR})
set_tests_properties(unit/forbidden_includes PROPERTIES LABELS unit)

trackbed_test(apps_parameters unit trackbed_program)
trackbed_test(apps_output unit trackbed_program)
target_compile_definitions(apps_parameters_test PRIVATE
                           SCENES="${PROJECT_SOURCE_DIR}/apps/scenes")

# Each folder of failures/ is one wrong input: the command, its exit code, its one line.
file(GLOB failure_cases CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/failures/*/case.txt)
foreach(case ${failure_cases})
  get_filename_component(folder ${case} DIRECTORY)
  get_filename_component(name ${folder} NAME)
  add_test(NAME failures/${name}
           COMMAND ${TRACKBED_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/failures/run.py
                   $<TARGET_FILE:trackbed> ${folder})
  set_tests_properties(failures/${name} PROPERTIES LABELS failures)
endforeach()
