# Finite elements.
trackbed_test(fem_body unit trackbed_fem)
trackbed_test(fem_subgrades unit trackbed_fem)
target_compile_definitions(fem_subgrades_test PRIVATE TRACKBED_SUBGRADES="${PROJECT_SOURCE_DIR}/fem/subgrades")
trackbed_test(fem_meshes unit trackbed_fem)
target_compile_definitions(fem_meshes_test PRIVATE TRACKBED_MESHES="${PROJECT_SOURCE_DIR}/meshes")
trackbed_test(fem_statics verification trackbed_fem)
trackbed_test(fem_dynamics verification trackbed_fem)
trackbed_test(fem_reduction verification trackbed_fem)
trackbed_test(fem_beam verification trackbed_fem)
trackbed_test(fem_schemes verification trackbed_fem)
# Looks at the library's inner parts, and so at deal.II.
trackbed_test(fem_convergence verification trackbed_fem trackbed_dealii)

add_executable(fem_step_benchmark ${CMAKE_CURRENT_LIST_DIR}/benchmarks/fem_step_benchmark.cc)
target_link_libraries(fem_step_benchmark PRIVATE trackbed_fem)
