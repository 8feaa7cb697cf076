# Finite elements.
trackbed_test(fem_body unit trackbed_fem)
trackbed_test(fem_subgrades unit trackbed_fem)
target_compile_definitions(fem_subgrades_test PRIVATE TRACKBED_SUBGRADES="${PROJECT_SOURCE_DIR}/fem/subgrades")
trackbed_test(fem_meshes unit trackbed_fem)
target_compile_definitions(fem_meshes_test PRIVATE TRACKBED_MESHES="${PROJECT_SOURCE_DIR}/meshes")
trackbed_test(fem_statics verification trackbed_fem)
trackbed_test(fem_dynamics verification trackbed_fem)
trackbed_test(fem_plasticity verification trackbed_fem)
trackbed_test(fem_reduction verification trackbed_fem Eigen3::Eigen)
trackbed_test(fem_beam verification trackbed_fem)
trackbed_test(fem_rail_pad verification trackbed_fem)
trackbed_test(fem_schemes verification trackbed_fem)
trackbed_test(fem_contact_bound verification trackbed_fem)
# These look at the library's inner parts, and so at deal.II.
trackbed_test(fem_convergence verification trackbed_fem trackbed_dealii)
trackbed_test(fem_modes verification trackbed_fem trackbed_dealii Eigen3::Eigen)

add_executable(fem_step_benchmark ${CMAKE_CURRENT_LIST_DIR}/benchmarks/fem_step_benchmark.cc)
target_link_libraries(fem_step_benchmark PRIVATE trackbed_fem)

# The model and the test of fem/subgrades/README.md, exactly as printed there.
set(tutorial ${CMAKE_CURRENT_BINARY_DIR}/tutorial)
set(page ${PROJECT_SOURCE_DIR}/fem/subgrades/README.md)
add_custom_command(
  OUTPUT ${tutorial}/undrained_clay.cc ${tutorial}/undrained_clay_test.cc
  COMMAND ${CMAKE_COMMAND} -DPAGE=${page} -DMODEL=${tutorial}/undrained_clay.cc
          -DTEST=${tutorial}/undrained_clay_test.cc -P ${CMAKE_CURRENT_SOURCE_DIR}/tutorial.cmake
  DEPENDS ${page} ${CMAKE_CURRENT_SOURCE_DIR}/tutorial.cmake)
add_executable(tutorial_test ${tutorial}/undrained_clay.cc ${tutorial}/undrained_clay_test.cc
               ${CMAKE_CURRENT_SOURCE_DIR}/verification/fem_plasticity_test.cc)
target_link_libraries(tutorial_test PRIVATE trackbed_fem GTest::gtest GTest::gtest_main)
gtest_discover_tests(tutorial_test TEST_PREFIX "verification/tutorial/" TEST_FILTER
                     "UndrainedClay*:StressModels*" PROPERTIES LABELS verification DISCOVERY_TIMEOUT 60)

# Bodies shared by ranks: the same tests on one, two and four.
add_executable(fem_distributed_test ${CMAKE_CURRENT_SOURCE_DIR}/verification/fem_distributed_test.cc)
target_link_libraries(fem_distributed_test PRIVATE trackbed_fem GTest::gtest)
add_executable(distributed_benchmark ${CMAKE_CURRENT_SOURCE_DIR}/benchmarks/distributed_benchmark.cc)
target_link_libraries(distributed_benchmark PRIVATE trackbed_fem)
find_program(MPIRUN mpirun REQUIRED)
set(mpirun ${MPIRUN} --oversubscribe --bind-to none --mca mpi_yield_when_idle 1)
foreach(ranks 1 2 4)
  add_test(NAME verification/distributed_${ranks}
           COMMAND ${mpirun} -n ${ranks} $<TARGET_FILE:fem_distributed_test>)
  set_tests_properties(
    verification/distributed_${ranks}
    PROPERTIES LABELS verification ENVIRONMENT
               "OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1;OMP_NUM_THREADS=1" TIMEOUT 200)
endforeach()
# An error of a user's model on one rank ends the run, it does not hang.
foreach(faulty 0 1)
  add_test(NAME verification/distributed_fault_${faulty}
           COMMAND ${mpirun} -n 2 $<TARGET_FILE:fem_distributed_test> fault ${faulty})
  set_tests_properties(
    verification/distributed_fault_${faulty}
    PROPERTIES LABELS verification PASS_REGULAR_EXPRESSION "trackbed: .*my mistake" ENVIRONMENT
               "OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1;OMP_NUM_THREADS=1" TIMEOUT 60)
endforeach()
