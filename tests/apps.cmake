# Tests of the program: its helpers, its messages on wrong input, and the order of the house.
set(TRACKBED_PYTHON /usr/bin/python3)

add_test(NAME unit/forbidden_includes
         COMMAND ${TRACKBED_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/forbidden_includes.py
                 ${PROJECT_SOURCE_DIR})
set_tests_properties(unit/forbidden_includes PROPERTIES LABELS unit)

trackbed_test(apps_parameters unit trackbed_program)
trackbed_test(apps_output unit trackbed_program)
trackbed_test(apps_grain_tests unit trackbed_program)
trackbed_test(apps_cost unit trackbed_program)
trackbed_test(apps_stage unit trackbed_program)
trackbed_test(apps_effects unit trackbed_program)
trackbed_test(apps_effects_off unit trackbed_program)
target_compile_definitions(apps_effects_off_test PRIVATE TESTS="${CMAKE_CURRENT_SOURCE_DIR}")
foreach(name apps_cost apps_stage apps_effects apps_effects_off)
  target_compile_definitions(${name}_test PRIVATE
                             TINY="${CMAKE_CURRENT_SOURCE_DIR}/scenes/tiny.prm")
endforeach()
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

# Each test of scenes/program_test.py is one of ctest's.
file(STRINGS ${CMAKE_CURRENT_SOURCE_DIR}/scenes/program_test.py scene_lines
     REGEX "^class [A-Z][A-Za-z]+\\(|^    def test_")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
             ${CMAKE_CURRENT_SOURCE_DIR}/scenes/program_test.py)
foreach(line ${scene_lines})
  if(line MATCHES "^class ([A-Za-z]+)")
    set(scene_class ${CMAKE_MATCH_1})
  elseif(line MATCHES "def (test_([a-z_]+))")
    set(name scenes/${CMAKE_MATCH_2})
    add_test(NAME ${name}
             COMMAND ${TRACKBED_PYTHON} -B -m unittest program_test.${scene_class}.${CMAKE_MATCH_1}
             WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/scenes)
    set_tests_properties(${name} PROPERTIES LABELS scenes TIMEOUT 300 ENVIRONMENT
                         "TRACKBED=$<TARGET_FILE:trackbed>;FUZZERS=$<TARGET_FILE_DIR:fuzz_pairs>;OMP_NUM_THREADS=2;OMP_WAIT_POLICY=passive")
  endif()
endforeach()
